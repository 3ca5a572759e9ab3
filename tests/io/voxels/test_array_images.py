"""NPY and raw files, and folders of slices: accepted properties, and notes on them."""

import os
import re
import warnings

import numpy as np
import pytest
from helpers.voxel_files import VOXELS, save_metaimage, save_slices, voxels_of_type
from PIL import Image

from snowshed import InputError
from snowshed.base.notes import record_notes
from snowshed.io.voxels.open_voxels import open_voxels


@pytest.mark.parametrize("kind", ["<u8", "<i8", "<f2", ">u4", ">f8", "?"])
@pytest.mark.parametrize("order", "CF")
def test_npy_of_any_type_and_order(tmp_path, kind, order):
    voxels = VOXELS > 100 if kind == "?" else voxels_of_type(kind)
    np.save(tmp_path / "a.npy", np.asarray(voxels.astype(kind), order=order))
    opened = open_voxels(tmp_path / "a.npy")
    for low, high in ((0, 5), (1, 3), (4, 5)):
        assert (opened.layers(low, high) == voxels[low:high]).all()


def test_bytes_after_an_image_are_noted(tmp_path):
    with (tmp_path / "a.npy").open("wb") as file:
        np.save(file, VOXELS)
        np.save(file, VOXELS)
    with record_notes() as notes:
        open_voxels(tmp_path / "a.npy")
    assert re.search(r"338 bytes after the image are left out", notes[0])


@pytest.mark.parametrize(
    "name", ["a.npy", "a.mha", "a.mhd", "a.tif", "a.raw", "s/1.png", "s/1.tif"]
)
def test_pipes_do_not_hang(tmp_path, name):
    (tmp_path / "s").mkdir()
    os.mkfifo(tmp_path / name)
    options = ((2, 2, 2), "uint8") if name == "a.raw" else ()
    with pytest.raises(InputError, match="not a regular file"):
        open_voxels(tmp_path / "s" if name[0] == "s" else tmp_path / name, *options)


@pytest.mark.parametrize("name", ["a.npy", "a.raw", "a.mhd"])
def test_sparse_files_are_refused(tmp_path, name):
    shape = (1000, 1000, 1000)
    data = tmp_path / ("a.raw" if name == "a.mhd" else name)
    if name == "a.npy":
        np.lib.format.open_memmap(data, "w+", np.uint8, shape).flush()
    else:
        with data.open("wb") as file:
            file.truncate(10**9)
    if name == "a.mhd":
        header = "DimSize = 1000 1000 1000"
        save_metaimage(tmp_path / name, VOXELS, header, data="b.raw")
        data.replace(tmp_path / "b.raw")
    with pytest.raises(InputError, match="more than 200 times as much"):
        open_voxels(tmp_path / name, *((shape, "uint8") if name == "a.raw" else ()))


def test_orientation_of_png_is_applied(tmp_path):
    folder = save_slices(tmp_path / "s", VOXELS)
    for path in folder.iterdir():
        image = Image.open(path)
        exif = image.getexif()
        exif[274] = 6
        image.save(path, exif=exif)
    with record_notes() as notes:
        voxels = open_voxels(folder).layers(0, 5)
    assert (voxels == np.stack([np.rot90(page, -1) for page in VOXELS])).all()
    assert "Orientation (6)" in notes[0]


def test_inverted_palettes_are_noted(tmp_path):
    folder = save_slices(tmp_path / "s", VOXELS, "bmp")
    for path in folder.iterdir():
        page = Image.new("P", (7, 6))
        page.putdata(np.asarray(Image.open(path)).ravel().tolist())
        page.putpalette([255 - shade for shade in range(256) for _ in range(3)])
        page.save(path)
    with record_notes() as notes:
        assert (open_voxels(folder).layers(0, 5) == 255 - VOXELS).all()
    assert "the shades of its palette" in notes[0]


@pytest.mark.parametrize("mode", ["LA", "RGB", "RGBA"])
def test_colours_and_transparency_are_refused(tmp_path, mode):
    folder = save_slices(tmp_path / "s", VOXELS)
    for path in folder.iterdir():
        Image.open(path).convert(mode).save(path)
    with pytest.raises(InputError, match=f"has colours \\({mode}\\)"):
        open_voxels(folder)


def test_a_slice_with_several_frames_is_refused(tmp_path):
    folder = save_slices(tmp_path / "s", VOXELS)
    frames = [Image.fromarray(page) for page in VOXELS]
    frames[0].save(folder / "slice1.png", save_all=True, append_images=frames[1:])
    with pytest.raises(InputError, match="5 frames; a slice has one"):
        open_voxels(folder)


def test_slices_of_two_names_are_noted(tmp_path):
    folder = save_slices(tmp_path / "s", VOXELS)
    (folder / "slice3.png").rename(folder / "image3.png")
    with record_notes() as notes:
        open_voxels(folder)
    assert "several names, image3.png and slice1.png" in notes[0]


def test_slices_with_a_huge_unpacked_size_are_refused(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        page = Image.new("L", (13_000, 13_000))
        (tmp_path / "s").mkdir()
        page.save(tmp_path / "s" / "1.png")
        for number in range(2, 9):
            os.link(tmp_path / "s" / "1.png", tmp_path / "s" / f"{number}.png")
    with pytest.raises(InputError, match="more than 200 times as much"):
        open_voxels(tmp_path / "s")
