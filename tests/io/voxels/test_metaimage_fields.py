"""MetaImage: every field that affects the numbers is applied or refused, by ITK's rules."""

import gzip
import itertools

import numpy as np
import pytest
from helpers.voxel_files import TYPES, VOXELS, save_metaimage, voxels_of_type

from snowshed import InputError
from snowshed.base.notes import record_notes
from snowshed.io.voxels.open_voxels import open_voxels


def read(file):
    """Return the numbers of an image, and its notes."""
    with record_notes() as notes:
        opened = open_voxels(file)
    numbers = opened.layers(0, opened.shape[0])
    layers = [opened.layers(number, number + 1) for number in range(opened.shape[0])]
    assert (np.concatenate(layers) == numbers).all()
    return numbers, notes


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("compress", [False, True])
@pytest.mark.parametrize("order", "<>")
def test_every_type(tmp_path, kind, compress, order):
    voxels = voxels_of_type(kind)
    numbers, _ = read(save_metaimage(tmp_path / "a.mha", voxels, compress=compress, order=order))
    assert (numbers == voxels).all() and numbers.dtype == voxels.dtype


@pytest.mark.parametrize("kind", ["uint8", "int16", "float32", "float64"])
def test_numbers_as_text(tmp_path, kind):
    voxels = voxels_of_type(kind)
    file = save_metaimage(tmp_path / "a.mhd", voxels, "BinaryData = False", data="a.txt")
    (tmp_path / "a.txt").write_text("\n".join(map(repr, voxels.ravel().tolist())))
    numbers, _ = read(file)
    assert (numbers == voxels).all() and numbers.dtype == voxels.dtype


@pytest.mark.parametrize(
    ("kind", "text", "message"),
    [
        ("uint8", "10 " * 209, "209 numbers as text; its header says 210"),
        ("uint8", "1 " * 211, "211 numbers as text; its header says 210"),
        ("uint8", "1 " * 209 + "256", "numbers that do not fit uint8"),
        ("int16", "1 " * 209 + "1.5", "numbers that do not fit int16"),
        ("uint8", "1 " * 209 + "x", "is not only numbers"),
        ("uint8", "1", "1 characters for 210 numbers"),
        ("int64", "1 " * 210, "whole numbers of 8 bytes as text"),
    ],
)
def test_text_with_other_numbers_is_refused(tmp_path, kind, text, message):
    file = save_metaimage(
        tmp_path / "a.mhd", voxels_of_type(kind), "BinaryData = False", data="a.txt"
    )
    (tmp_path / "a.txt").write_text(text)
    with pytest.raises(InputError, match=message):
        open_voxels(file)


@pytest.mark.parametrize("field", ["ElementByteOrderMSB", "BinaryDataByteOrderMSB"])
@pytest.mark.parametrize("word", ["True", "true", "T", "1"])
def test_the_byte_order_has_two_names(tmp_path, field, word):
    voxels = voxels_of_type("int16")
    file = save_metaimage(tmp_path / "a.mha", voxels, order=">")
    content = file.read_bytes().replace(b"ElementByteOrderMSB = True", f"{field} = {word}".encode())
    file.write_bytes(content)
    assert (read(file)[0] == voxels).all()


@pytest.mark.parametrize("order", itertools.permutations(range(3)))
@pytest.mark.parametrize("signs", [(1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1), (-1, -1, -1)])
@pytest.mark.parametrize("compress", [False, True])
def test_axes_point_where_the_matrix_says(tmp_path, order, signs, compress):
    """A step along axis a of the file is, by definition, a step along row a of the matrix."""
    matrix = np.zeros((3, 3), dtype=int)
    for axis in range(3):
        matrix[axis, order[axis]] = signs[axis]
    header = f"TransformMatrix = {' '.join(map(str, matrix.ravel()))}"
    numbers, notes = read(save_metaimage(tmp_path / "a.mha", VOXELS, header, compress=compress))
    positions = np.indices(VOXELS.shape).reshape(3, -1)[::-1].T @ matrix  # x, y, z of each voxel
    x, y, z = (positions - positions.min(axis=0)).T
    assert numbers.shape == (z.max() + 1, y.max() + 1, x.max() + 1)
    assert (numbers[z, y, x] == VOXELS.ravel()).all()
    turned = not (matrix == np.eye(3)).all()
    assert [note.endswith("rotated according to its TransformMatrix") for note in notes] == [
        True
    ] * turned


@pytest.mark.parametrize("name", ["Rotation", "Orientation", "TransformMatrix"])
@pytest.mark.parametrize(
    "matrix", ["0.8 0.6 0 -0.6 0.8 0 0 0 1", "1 0 0 1 0 0 0 0 1", "2 0 0 0 2 0 0 0 2"]
)
def test_axes_that_are_not_along_x_y_and_z_are_refused(tmp_path, name, matrix):
    file = save_metaimage(tmp_path / "a.mha", VOXELS, f"{name} = {matrix}")
    with pytest.raises(InputError, match=f"{name} .*along x, y and z"):
        open_voxels(file)


@pytest.mark.parametrize(("size", "start"), [("36", 36), ("-1", None), ("0", 0)])
def test_a_header_size_is_skipped(tmp_path, size, start):
    file = save_metaimage(tmp_path / "a.mhd", VOXELS, f"HeaderSize = {size}", data="a.raw")
    head = b"junk" * 9 if start != 0 else b""
    (tmp_path / "a.raw").write_bytes(head + VOXELS.tobytes())
    assert (read(file)[0] == VOXELS).all()


def test_streams_of_gzip_and_their_length(tmp_path):
    file = save_metaimage(tmp_path / "a.mhd", VOXELS, "CompressedData = True", data="a.zraw")
    packed = gzip.compress(VOXELS.tobytes())
    (tmp_path / "a.zraw").write_bytes(packed)
    assert (read(file)[0] == VOXELS).all()
    header = file.read_text().replace(
        "ElementDataFile", f"CompressedDataSize = {len(packed) + 1}\nElementDataFile"
    )
    file.write_text(header)
    with pytest.raises(InputError, match="packed bytes; its header says"):
        open_voxels(file)


@pytest.mark.parametrize(
    ("header", "size"),
    [
        ("ElementSpacing = 0.05 0.05 0.05", 5e-5),
        ("ElementSpacing = 50 50 50\nDistanceUnits = um", 5e-5),
        ("ElementSpacing = 5e-5 5e-5 5e-5\nDistanceUnits = m", 5e-5),
        ("ElementSize = 0.05 0.05 0.05", 5e-5),
        ("Offset = 1 2 3", None),
    ],
)
def test_the_edge_of_a_voxel(tmp_path, header, size):
    opened = open_voxels(save_metaimage(tmp_path / "a.mha", VOXELS, header))
    assert opened.voxel_size == size


def test_another_scale_of_the_numbers_is_noted(tmp_path):
    slope = "ElementToIntensityFunctionSlope = 2"
    numbers, notes = read(save_metaimage(tmp_path / "a.mha", VOXELS, slope))
    assert (numbers == VOXELS).all() and "ElementToIntensityFunctionSlope 2 and Offset" in notes[0]
    with pytest.raises(InputError, match="only positive ones"):
        open_voxels(save_metaimage(tmp_path / "a.mha", VOXELS, slope.replace("2", "-2")))


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("ObjectType = Mesh", "ObjectType 'Mesh'"),
        ("NDims = 2", "NDims '2'"),
        ("NDims = x", "a whole number is needed"),
        ("ElementNumberOfChannels = 2", "several numbers per voxel"),
        ("ElementType = MET_STRING", "ElementType 'MET_STRING'"),
        ("DimSize = 7 6 5.5", "whole numbers are needed"),
        ("BinaryData = maybe", "True or False is needed"),
        ("CompressedData = True\nBinaryData = False", "are not packed"),
        ("CompressedData = True\nHeaderSize = -1", "must be known where packed numbers begin"),
        ("BinaryDataByteOrderMSB = True", "contradicts it"),
        ("ElementSpacing = 1 1 2", "must be cubes"),
        ("ElementSpacing = 1 1 1\nDistanceUnits = mile", "DistanceUnits 'mile'"),
        ("HeaderSize = -2", "a number of bytes is needed"),
    ],
)
def test_unsupported_fields_are_refused(tmp_path, header, message):
    with pytest.raises(InputError, match=message):
        open_voxels(save_metaimage(tmp_path / "a.mha", VOXELS, header))


def test_a_repeated_field_is_refused(tmp_path):
    file = save_metaimage(tmp_path / "a.mha", VOXELS)
    file.write_bytes(file.read_bytes().replace(b"NDims = 3\n", b"NDims = 3\nNDims = 3\n"))
    with pytest.raises(InputError, match="'NDims' occurs twice"):
        open_voxels(file)


def test_a_link_does_not_lead_out_of_the_folder(tmp_path):
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "secret").write_bytes(VOXELS.tobytes())
    file = save_metaimage(inside / "a.mhd", VOXELS, data="a.raw")
    (inside / "a.raw").unlink()
    (inside / "a.raw").symlink_to(tmp_path / "secret")
    with pytest.raises(InputError, match="must be in the same folder"):
        open_voxels(file)


def test_packed_numbers_with_a_huge_unpacked_size_are_refused(tmp_path):
    """1200 x 1200 x 1200 zeros take 1.7 MB."""
    header = "DimSize = 1200 1200 1200\nElementType = MET_UCHAR"
    file = save_metaimage(tmp_path / "a.mha", np.zeros((9, 9, 9), np.uint8), header, compress=True)
    with pytest.raises(InputError, match="more than 200 times as much"):
        open_voxels(file)
