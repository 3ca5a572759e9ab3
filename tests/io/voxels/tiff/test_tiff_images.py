"""TIFF files: tags that affect the numbers are applied or refused; compared with tifffile."""

import io
import re
import struct

import numpy as np
import pytest
from helpers.voxel_files import VOXELS, save_pages, voxels_of_type
from PIL import Image, ImageOps

from snowshed import InputError
from snowshed.base.notes import record_notes
from snowshed.io.voxels.open_voxels import open_voxels

tifffile = pytest.importorskip("tifffile")

KINDS = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "float16", "float32",
         "float64")  # fmt: skip
GREY = {"photometric": "minisblack"}


def written(folder, voxels, **options):
    """Write a stack with tifffile, and return its file."""
    tifffile.imwrite(folder / "a.tif", voxels, **{**GREY, **options})
    return folder / "a.tif"


def read(file):
    """Return the numbers of an image, the same for all layers at once and singly, and its notes."""
    with record_notes() as notes:
        opened = open_voxels(file)
    numbers = opened.layers(0, opened.shape[0])
    layers = [opened.layers(number, number + 1) for number in range(opened.shape[0])]
    assert (np.concatenate(layers) == numbers).all()
    assert opened.notes == tuple(notes)
    return numbers, notes


def assert_same(numbers, voxels):
    assert numbers.shape == voxels.shape
    assert numbers.dtype == voxels.dtype.newbyteorder("=")
    assert (numbers == voxels).all()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("order", "<>")
def test_every_type_in_either_byte_order(tmp_path, kind, order):
    numbers, notes = read(written(tmp_path, voxels_of_type(kind), byteorder=order))
    assert_same(numbers, voxels_of_type(kind))
    assert notes == []


@pytest.mark.parametrize("kind", ["bool", "uint8", "uint16", "uint32", "float32"])
def test_white_is_zero_means_the_same_for_every_type(tmp_path, kind):
    voxels = VOXELS > 100 if kind == "bool" else voxels_of_type(kind)
    numbers, notes = read(written(tmp_path, voxels, photometric="miniswhite"))
    assert_same(numbers, voxels.astype(np.uint8) if kind == "bool" else voxels)
    assert len(notes) == 1 and "WhiteIsZero" in notes[0] and "`dark_ice=True`" in notes[0]


@pytest.mark.parametrize("kind", ["uint8", "uint16", "uint32", "uint64", "float32", "float64"])
@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize(("name", "code"), [("LZW", 5), ("Deflate", 8)])
def test_packed_numbers_with_differences(tmp_path, kind, order, name, code):
    """tifffile packs LZW only with another library, so Pillow packs it here."""
    voxels = voxels_of_type(kind)
    file = tmp_path / "a.tif"
    predictor = 3 if voxels.dtype.kind == "f" else 2
    file.write_bytes(packed_tiff(voxels.astype(voxels.dtype.newbyteorder(order)), code, predictor))
    assert_same(read(file)[0], voxels)


def packed_tiff(voxels, code, predictor):
    """Return a TIFF file whose pages are packed strips, after TIFF 6.0 and its supplement 3."""
    kind, order = voxels.dtype.kind, ">" if voxels.dtype.str[0] == ">" else "<"
    size = voxels.dtype.itemsize
    body, pages = b"", []
    for page in voxels:
        if predictor == 2:
            integers = page.astype(page.dtype.newbyteorder("=")).view(f"u{size}")
            delta = np.diff(integers, axis=1, prepend=np.zeros((len(integers), 1), integers.dtype))
            rows = delta.astype(f"{order}u{size}").tobytes()
        else:
            planes = page.astype(f">f{size}").view(np.uint8).reshape(*page.shape, size)
            flat = planes.transpose(0, 2, 1).reshape(len(page), -1)
            rows = np.diff(flat, axis=1, prepend=np.zeros((len(flat), 1), np.uint8)).tobytes()
        strip = packed_by_libtiff(rows, code)
        pages.append((8 + len(body), len(strip)))
        body += strip + b"\0" * (len(strip) % 2)
    height, width = voxels.shape[1:]
    ifds, directory_start = b"", 8 + len(body)
    for number, (start, length) in enumerate(pages):
        tags = [(256, width), (257, height), (258, 8 * size), (259, code), (262, 1), (273, start),
                (277, 1), (278, height), (279, length), (317, predictor),
                (339, 3 if kind == "f" else 1)]  # fmt: skip
        following = directory_start + len(ifds) + 2 + 12 * len(tags) + 4
        entries = b"".join(struct.pack(f"{order}HHII", tag, 4, 1, value) for tag, value in tags)
        ifds += struct.pack(f"{order}H", len(tags)) + entries
        ifds += struct.pack(f"{order}I", following if number < len(pages) - 1 else 0)
    mark = b"MM" if order == ">" else b"II"
    return struct.pack(f"{order}2sHI", mark, 42, directory_start) + body + ifds


def packed_by_libtiff(rows, code):
    memory = io.BytesIO()
    picture = Image.frombytes("L", (len(rows), 1), rows)
    picture.save(memory, "TIFF", compression={5: "tiff_lzw", 8: "tiff_adobe_deflate"}[code])
    memory.seek(0)
    with tifffile.TiffFile(memory) as tiff:
        (start,), (length,) = tiff.pages[0].dataoffsets, tiff.pages[0].databytecounts
    return memory.getvalue()[start : start + length]


@pytest.mark.parametrize("compression", ["packbits", "tiff_lzw", "tiff_adobe_deflate"])
@pytest.mark.parametrize("kind", ["uint8", "uint16", "int32", "float32"])
def test_packed_by_pillow(tmp_path, compression, kind):
    voxels = VOXELS.astype(kind) - (40 if kind == "int32" else 0)
    assert_same(read(save_pages(tmp_path / "a.tif", voxels, compression=compression))[0], voxels)


@pytest.mark.parametrize("compression", ["group3", "group4", "tiff_ccitt"])
def test_fax_images(tmp_path, compression):
    ice = np.random.default_rng(2).random((3, 40, 50)) < 0.5
    numbers, _ = read(save_pages(tmp_path / "a.tif", ice, compression=compression))
    assert set(np.unique(numbers)) == {0, 1}
    # Fax codes white first; a tag and a note say whether white is 0.
    assert (numbers == ice).all() or (numbers == ~ice).all()


@pytest.mark.parametrize(
    ("shape", "options"),
    [
        ((3, 70, 90), {"tile": (32, 48)}), ((3, 64, 48), {"tile": (64, 48)}),
        ((3, 50, 48), {"tile": (32, 48)}), ((3, 70, 90), {"rowsperstrip": 11}),
        ((3, 70, 90), {"rowsperstrip": 11, "compression": "deflate"}),
        ((3, 70, 90), {"tile": (16, 16), "compression": "deflate", "predictor": 2}),
        ((3, 20, 30), {"bigtiff": True}), ((3, 20, 30), {"bigtiff": True, "byteorder": ">"}),
        ((3, 20, 30), {"compression": "lzma"}),
    ],
)  # fmt: skip
def test_strips_tiles_and_bigtiff(tmp_path, shape, options):
    voxels = np.random.default_rng(1).integers(0, 60_000, shape).astype(np.uint16)
    file = written(tmp_path, voxels, **options)
    assert_same(read(file)[0], tifffile.imread(file))


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("every_page", [True, False])
def test_orientation_is_applied_and_noted(tmp_path, orientation, every_page):
    voxels = voxels_of_type("uint16")
    tag = [(274, 3, 1, orientation, not every_page)]
    numbers, notes = read(written(tmp_path, voxels, extratags=tag))
    picture = Image.fromarray(np.arange(42, dtype=np.uint8).reshape(6, 7))  # compared with Pillow
    picture.getexif()[274] = orientation
    order = np.asarray(ImageOps.exif_transpose(picture))
    assert_same(numbers, np.stack([page.ravel()[order] for page in voxels]))
    assert [f"Orientation ({orientation})" in note for note in notes] == [True] * (orientation > 1)


def test_grey_palettes_are_read_and_colours_are_refused(tmp_path):
    grey = np.repeat((np.arange(256) * 257)[None], 3, axis=0).astype(np.uint16)
    options = {"photometric": "palette"}
    assert_same(read(written(tmp_path, VOXELS, colormap=grey, **options))[0], VOXELS)
    numbers, notes = read(written(tmp_path, VOXELS, colormap=grey[:, ::-1], **options))
    assert_same(numbers, 255 - VOXELS)
    assert "the shades of its palette" in notes[0]
    coloured = grey.copy()
    coloured[1] = 0
    with pytest.raises(InputError, match="has colours"):
        open_voxels(written(tmp_path, VOXELS, colormap=coloured, **options))


def test_descriptions_contain_the_voxel_size(tmp_path):
    imagej = {"imagej": True, "resolution": (0.02, 0.02)}
    size = {"axes": "ZYX", "spacing": 50.0, "unit": "um"}
    file = written(tmp_path, voxels_of_type("uint16"), **imagej, metadata=size)
    assert_same(read(file)[0], voxels_of_type("uint16"))
    assert open_voxels(file).voxel_size == pytest.approx(5e-5)
    flat = written(
        tmp_path, voxels_of_type("uint16"), **imagej, metadata={**size, "spacing": 100.0}
    )
    with pytest.raises(InputError, match="they must be cubes"):
        open_voxels(flat)
    edges = {f"PhysicalSize{axis}": 0.05 for axis in "XYZ"}
    units = {f"PhysicalSize{axis}Unit": "mm" for axis in "XYZ"}
    metadata = {"axes": "ZYX", **edges, **units}
    file = written(tmp_path, voxels_of_type("uint16"), ome=True, metadata=metadata)
    assert open_voxels(file).voxel_size == pytest.approx(5e-5)


@pytest.mark.parametrize(
    ("resolution", "unit", "size"),
    [(200, "CENTIMETER", 5e-5), (254, "INCH", 1e-4), (300, "INCH", None), (72, "INCH", None),
     (200, "NONE", None)],
)  # fmt: skip
def test_a_resolution_for_printers_is_not_a_voxel_size(tmp_path, resolution, unit, size):
    file = written(tmp_path, VOXELS, resolution=(resolution, resolution), resolutionunit=unit)
    opened = open_voxels(file)
    assert opened.voxel_size is None
    assert opened.printed_size == (size and pytest.approx(size))


@pytest.mark.parametrize("options", [{"imagej": True}, {"ome": True}])
def test_frames_become_slices_and_several_stacks_are_refused(tmp_path, options):
    voxels = voxels_of_type("uint16")
    numbers, notes = read(written(tmp_path, voxels, **options, metadata={"axes": "TYX"}))
    assert_same(numbers, voxels)
    assert "5 frames are taken for slices" in notes[0]
    for axes in ("TZYX", "CZYX" if "ome" in options else "TZYX"):
        file = written(tmp_path, np.stack([voxels] * 2), **options, metadata={"axes": axes})
        with pytest.raises(InputError, match="one stack of slices is needed"):
            open_voxels(file)


def test_a_page_with_several_slices_is_read(tmp_path):
    """ImageJ writes stacks beyond 4 GB in this form, and tifffile on request."""
    voxels = voxels_of_type("uint16")
    options = {"truncate": True, "metadata": {"axes": "ZYX"}}
    file = written(tmp_path, voxels, imagej=True, **options)
    assert len(tifffile.TiffFile(file).pages) == 1
    assert_same(read(file)[0], voxels)
    content = file.read_bytes()
    short = content.replace(b"images=5\n", b"images=9\n").replace(b"slices=5\n", b"slices=9\n")
    file.write_bytes(short)
    with pytest.raises(InputError, match="9 slices end at byte"):
        open_voxels(file)


def test_an_ome_image_of_several_files_is_refused(tmp_path):
    written(tmp_path, VOXELS, ome=True, metadata={"axes": "ZYX"})
    text = tifffile.TiffFile(tmp_path / "a.tif").pages[0].description
    uuids = "".join(
        f'<TiffData IFD="{n}"><UUID FileName="{n}.tif">u</UUID></TiffData>' for n in (0, 1)
    )
    many = re.sub(r"<TiffData.*?(/>|</TiffData>)", uuids, text, count=1, flags=re.DOTALL)
    tifffile.imwrite(tmp_path / "b.tif", VOXELS, **GREY, description=many, metadata=None)
    with pytest.raises(InputError, match="one of 2 files of an image"):
        open_voxels(tmp_path / "b.tif")
    entity = '<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/passwd">]><OME>&b;</OME>'
    tifffile.imwrite(tmp_path / "c.tif", VOXELS, **GREY, description=entity, metadata=None)
    with pytest.raises(InputError, match="XML that defines entities"):
        open_voxels(tmp_path / "c.tif")


@pytest.mark.parametrize(
    ("voxels", "options", "message"),
    [
        (np.stack([VOXELS] * 3, axis=-1), {"photometric": "rgb"}, "3 numbers per pixel"),
        (np.stack([VOXELS] * 3, axis=1), {"photometric": "rgb", "planarconfig": "separate"},
         "3 numbers per pixel"),
        (np.stack([VOXELS] * 2, axis=-1), {"extrasamples": ["unassalpha"]}, "2 numbers per pixel"),
        (VOXELS.astype(np.complex64), {}, "SampleFormat 6"),
        (np.stack([VOXELS] * 2), {}, "an array of 2 x 5 x 6 x 7"),
        (np.zeros((16, 16, 16), np.uint8), {"tile": (16, 16, 16), "volumetric": True},
         "ImageDepth"),
    ],
)  # fmt: skip
def test_images_that_are_not_a_stack_of_numbers_are_refused(tmp_path, voxels, options, message):
    with pytest.raises(InputError, match=message):
        open_voxels(written(tmp_path, voxels, **options))


def test_a_slice_has_one_page(tmp_path):
    tifffile.imwrite(tmp_path / "1.tif", VOXELS, **GREY)
    with pytest.raises(InputError, match="5 pages; a slice has one"):
        open_voxels(tmp_path)


def test_more_pages_than_the_limit_are_refused_before_they_are_read(tmp_path, monkeypatch):
    monkeypatch.setattr("snowshed.io.voxels.tiff.tags.MAX_PAGES", 50)
    good = written(tmp_path, np.zeros((1, 2, 2), np.uint8), metadata=None).read_bytes()
    start = struct.unpack("<I", good[4:8])[0]
    (count,) = struct.unpack("<H", good[start : start + 2])
    ifd = good[start : start + 2 + 12 * count]
    body = bytearray(good[:start])
    for _ in range(51):
        body += ifd + struct.pack("<I", len(body) + len(ifd) + 4)
    (tmp_path / "a.tif").write_bytes(bytes(body) + ifd + bytes(4))
    with pytest.raises(InputError, match="more than 50 pages"):
        open_voxels(tmp_path / "a.tif")


def test_pages_in_a_loop_are_refused(tmp_path):
    content = bytearray(written(tmp_path, VOXELS, metadata=None).read_bytes())
    with tifffile.TiffFile(tmp_path / "a.tif") as tiff:
        second = tiff.pages[1]
        end = second.offset + 2 + 12 * len(second.tags)
        content[end : end + 4] = struct.pack("<I", tiff.pages[0].offset)
    (tmp_path / "a.tif").write_bytes(content)
    with pytest.raises(InputError, match="it is an earlier page again"):
        open_voxels(tmp_path / "a.tif")


def test_a_small_file_of_many_pixels_is_refused(tmp_path):
    tifffile.imwrite(tmp_path / "a.tif", np.zeros((20_000, 20_000), np.uint8), **GREY,
                     compression="deflate", rowsperstrip=2_000)  # fmt: skip
    with pytest.raises(InputError, match="more than 200 times as much"):
        open_voxels(tmp_path / "a.tif")
