"""Three-dimensional images: every format gives the same voxels, and hostile files are refused."""

import re
import struct

import numpy as np
import pytest
from helpers.voxel_files import TYPES, VOXELS, save_metaimage, save_pages, save_slices
from PIL import Image

from snowshed import InputError
from snowshed.io.voxels.open_voxels import open_voxels


def assert_same(opened, voxels):
    assert opened.shape == voxels.shape
    numbers = opened.layers(0, len(voxels))
    assert numbers.dtype == voxels.dtype.newbyteorder("=")
    assert (numbers == voxels).all()
    assert (opened.layers(2, 4) == voxels[2:4]).all()


@pytest.mark.parametrize("kind", ["uint8", "int16", "uint16", "float32", ">u2", ">f4", "bool"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_npy(tmp_path, kind, order):
    voxels = (VOXELS % 2 if kind == "bool" else VOXELS).astype(kind)
    np.save(tmp_path / "a.npy", np.asarray(voxels, order=order))
    assert_same(open_voxels(tmp_path / "a.npy"), voxels)


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("order", "<>")
def test_metaimage(tmp_path, kind, order):
    voxels = (VOXELS.astype(int) - (40 if kind in ("int16", "float32") else 0)).astype(kind)
    for name, options in {
        "a.mha": {}, "b.mhd": {"data": "b.raw"}, "c.mha": {"compress": True},
        "d.mhd": {"data": "d.zraw", "compress": True},
    }.items():  # fmt: skip
        assert_same(
            open_voxels(save_metaimage(tmp_path / name, voxels, order=order, **options)), voxels
        )


def test_the_voxel_size_of_a_metaimage_is_in_millimetres(tmp_path):
    file = save_metaimage(tmp_path / "a.mha", VOXELS, "ElementSpacing = 0.02 0.02 0.02\n")
    assert open_voxels(file).voxel_size == pytest.approx(2e-5)
    file = save_metaimage(tmp_path / "b.mha", VOXELS, "ElementSpacing = 0.02 0.02 0.04\n")
    with pytest.raises(InputError, match="voxels must be cubes"):
        open_voxels(file)


@pytest.mark.parametrize("kind", ["uint8", "uint16-be", "int16", "float32-be"])
def test_raw(tmp_path, kind):
    name, _, big = kind.partition("-")
    VOXELS.astype(np.dtype(name).newbyteorder(">" if big else "<")).tofile(tmp_path / "a.raw")
    assert_same(open_voxels(tmp_path / "a.raw", VOXELS.shape, kind), VOXELS.astype(name))


@pytest.mark.parametrize("kind", ["uint8", "uint16", "int32", "float32"])
@pytest.mark.parametrize("compression", [None, "tiff_lzw", "tiff_deflate"])
def test_tiff_stack(tmp_path, kind, compression):
    voxels = VOXELS.astype(kind)
    assert_same(
        open_voxels(save_pages(tmp_path / "a.tif", voxels, compression=compression)), voxels
    )


def test_tiff_of_one_bit_and_of_the_other_byte_order(tmp_path):
    save_pages(tmp_path / "bits.tif", VOXELS > 100)
    assert_same(open_voxels(tmp_path / "bits.tif"), (VOXELS > 100).astype(np.uint8))
    (tmp_path / "big.tif").write_bytes(
        big_endian_tiff((VOXELS[0].astype(np.uint16) * 200).astype(">u2"))
    )
    opened = open_voxels(tmp_path / "big.tif")
    assert (opened.layers(0, 1)[0] == VOXELS[0].astype(np.uint16) * 200).all()
    (tmp_path / "signed.tif").write_bytes(big_endian_tiff(VOXELS[0].view(np.int8), 2))
    opened = open_voxels(tmp_path / "signed.tif")
    assert (opened.layers(0, 1)[0] == VOXELS[0].view(np.int8)).all()


def big_endian_tiff(page, sample_format=1):
    """Return a TIFF file of one page, written by hand after the specification (TIFF 6.0)."""
    height, width = page.shape
    tags = [(256, width), (257, height), (258, 8 * page.itemsize), (259, 1), (262, 1), (273, 8),
            (277, 1), (278, height), (279, page.nbytes), (339, sample_format)]  # fmt: skip
    entries = b"".join(
        struct.pack(">HHII", tag, 4, 1, value)
        if tag in (273, 279)
        else struct.pack(">HHIHH", tag, 3, 1, value, 0)
        for tag, value in tags
    )
    pixels = page.tobytes() + b"\0" * (page.nbytes % 2)
    return (
        struct.pack(">2sHI", b"MM", 42, 8 + len(pixels)) + pixels
        + struct.pack(">H", len(tags)) + entries + b"\0" * 4
    )  # fmt: skip


@pytest.mark.parametrize("ending", ["png", "bmp", "tif"])
def test_slices_are_in_the_order_of_their_numbers(tmp_path, ending):
    voxels = np.concatenate([VOXELS, VOXELS[::-1], VOXELS])  # 15: slice2 comes before slice10
    folder = save_slices(tmp_path / "s", voxels, ending)
    (folder / "notes.txt").write_text("this is not a slice")
    assert_same(open_voxels(folder), voxels)


def test_a_sixteen_bit_png_is_read(tmp_path):
    voxels = VOXELS.astype(np.uint16) * 200
    assert_same(open_voxels(save_slices(tmp_path / "s", voxels)), voxels)


def test_slices_in_palettes_of_grey(tmp_path):
    folder = save_slices(tmp_path / "s", VOXELS)
    for path in folder.iterdir():
        page = Image.open(path).convert("P")
        page.putpalette([shade for shade in range(256) for _ in range(3)])
        page.save(path)
    opened = open_voxels(folder)
    assert (opened.layers(0, 5) == VOXELS).all()


def damage_slices(folder, damage_kind):
    """Damage a folder of slices."""
    if damage_kind == "missing":
        (folder / "slice3.png").unlink()
    elif damage_kind == "twice":
        (folder / "slice03.png").write_bytes((folder / "slice3.png").read_bytes())
    elif damage_kind == "mixed":
        Image.fromarray(VOXELS[0]).save(folder / "slice6.bmp")
    elif damage_kind == "size":
        Image.fromarray(VOXELS[0, 1:]).save(folder / "slice4.png")
    elif damage_kind == "type":
        Image.fromarray(VOXELS[0].astype(np.uint16)).save(folder / "slice4.png")
    elif damage_kind == "colour":
        Image.fromarray(np.dstack([VOXELS[0]] * 2 + [VOXELS[1]])).save(folder / "slice1.png")
    elif damage_kind == "name":
        (folder / "slice1.png").rename(folder / "first.png")
    elif damage_kind == "other":
        (folder / "slice2.png").write_bytes(b"II*\0 is no PNG")


@pytest.mark.parametrize(
    ("damage_kind", "message"),
    [
        ("missing", "slice 3 is missing, between slice2.png and slice4.png"),
        ("twice", "has the number of slice03.png, 3"),
        ("mixed", "slices of mixed types: BMP, PNG"),
        ("size", "slice4.png: 7 x 5 pixels; slice1.png has 7 x 6"),
        ("type", "slice4.png: pixels of type I;16; slice1.png has L"),
        ("colour", "has colours (RGB); convert it to shades of grey"),
        ("name", "no number in its name"),
        ("other", "slice2.png: damaged: not read as PNG"),
    ],
)
def test_damaged_folders_of_slices_are_refused(tmp_path, damage_kind, message):
    folder = save_slices(tmp_path / "s", VOXELS)
    damage_slices(folder, damage_kind)
    with pytest.raises(InputError, match=re.escape(message)):
        open_voxels(folder).layers(0, 5)


def test_an_empty_folder_is_refused(tmp_path):
    with pytest.raises(InputError, match="no slices in it"):
        open_voxels(tmp_path)


def test_pages_that_differ_are_refused(tmp_path):
    pages = [Image.fromarray(VOXELS[0]), Image.fromarray(VOXELS[1, 1:])]
    pages[0].save(tmp_path / "a.tif", save_all=True, append_images=pages[1:])
    with pytest.raises(InputError, match=r"page 2: 7 x 5 pixels; a.tif, page 1 has 7 x 6"):
        open_voxels(tmp_path / "a.tif").layers(0, 2)


@pytest.mark.parametrize("keep", [0, 3, 60, 200, -30])
@pytest.mark.parametrize("name", ["a.tif", "a.npy", "a.mha", "c.mha"])
def test_files_that_end_early_are_refused(tmp_path, name, keep):
    voxels = np.random.default_rng(1).integers(0, 255, (4, 20, 20)).astype(np.uint8)
    if name == "a.tif":
        save_pages(tmp_path / name, voxels)
    elif name == "a.npy":
        np.save(tmp_path / name, voxels)
    else:
        save_metaimage(tmp_path / name, voxels, compress=name == "c.mha")
    content = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(content[:keep])
    with pytest.raises(InputError):
        open_voxels(tmp_path / name).layers(0, 4)


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("DimSize = 99999 99999 99999\n", "1 to 65,536 along an edge"),
        ("DimSize = 60000 60000 1\n", "damaged: "),
        ("DimSize = 7 6\n", "three numbers are needed"),
        ("DimSize = 7 6 -5\n", "1 to 65,536 along an edge"),
        ("DimSize = 7 6 inf\n", "three numbers are needed"),
        ("ElementNumberOfChannels = 3\n", "several numbers per voxel"),
        ("ElementSpacing = 0 0 0\n", "voxels must be cubes"),
    ],
)
def test_false_headers_are_refused(tmp_path, header, message):
    save_metaimage(tmp_path / "a.mha", VOXELS, header)
    with pytest.raises(InputError, match=message):
        open_voxels(tmp_path / "a.mha")


@pytest.mark.parametrize("data", ["../b.raw", "/etc/passwd", "LIST", "slice%03d.raw 1 5 1"])
def test_a_header_cannot_name_files_in_other_folders(tmp_path, data):
    nz, ny, nx = VOXELS.shape
    (tmp_path / "a.mhd").write_text(
        f"DimSize = {nx} {ny} {nz}\nElementType = MET_UCHAR\nElementDataFile = {data}\n"
    )
    with pytest.raises(InputError, match="ElementDataFile"):
        open_voxels(tmp_path / "a.mhd")


def test_packed_data_is_unpacked_only_to_its_size(tmp_path):
    bomb = np.zeros((300, 300, 300), dtype=np.uint8)
    file = save_metaimage(tmp_path / "a.mha", bomb, compress=True)
    file.write_bytes(file.read_bytes().replace(b"DimSize = 300 300 300", b"DimSize = 4 4 4"))
    assert open_voxels(file).layers(0, 4).size == 64


def test_arrays_that_are_not_images_are_refused(tmp_path):
    for array, message in (
        (VOXELS[0], "2 dimensions"),
        (VOXELS[:0], "1 to 65,536"),
        (VOXELS.astype(complex), "whole numbers and floating-point"),
        (VOXELS.astype("S1"), "whole numbers and floating-point"),
        (VOXELS.astype(object), "whole numbers and floating-point"),
    ):
        np.save(tmp_path / "a.npy", array, allow_pickle=True)
        with pytest.raises(InputError, match=message):
            open_voxels(tmp_path / "a.npy")


def test_other_names_and_raw_files_without_a_shape_are_refused(tmp_path):
    (tmp_path / "a.jpg").write_bytes(b"")
    (tmp_path / "a.raw").write_bytes(bytes(10))
    for name, options, message in (
        ("a.jpg", (), "not an image that is read"),
        ("a.raw", (), "needs the shape and the type"),
        ("a.raw", ((2, 2, 2), "uint8"), "10 bytes; 2 x 2 x 2 voxels of type uint8 take 8"),
        ("a.raw", ((2, 2, 2), "double"), "type 'double'"),
    ):
        with pytest.raises(InputError, match=message):
            open_voxels(tmp_path / name, *options)
    with pytest.raises(FileNotFoundError):
        open_voxels(tmp_path / "b.tif")
