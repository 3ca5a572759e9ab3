"""Bad input to ``snowshed grains``: exit code 2, error and position, and no files."""

import numpy as np
import pytest
from helpers.grain_files import VOXEL, column_of_grains, write_labels

from snowshed.cli.main import main

GOOD = column_of_grains()


def grains(folder, *options, kind="compress", file="labels.npy"):
    return main(
        ["grains", kind, str(folder / file), "--voxel", str(VOXEL), "-o", str(folder / "out"), "-q",
         *map(str, options)]
    )  # fmt: skip


def refused(folder, capsys, message, *options, files=("labels.npy",), **case):
    assert grains(folder, *options, **case) == 2
    assert message in capsys.readouterr().err
    assert {file.name for file in folder.iterdir()} == set(files)


@pytest.mark.parametrize(
    ("labels", "message"),
    [
        (GOOD.astype(float), "allowed: integers of 1 to 8 bytes"),
        (GOOD > 0, "allowed: integers of 1 to 8 bytes"),
        (GOOD.astype(">i4"), "little-endian"),
        (GOOD[0], "three counts (nz, ny, nx)"),
        (np.asfortranarray(GOOD), "False (C order)"),
        (-GOOD, "negative or above 2147483647"),
        (GOOD.astype(np.int64) << 40, "negative or above 2147483647"),
        (np.zeros_like(GOOD), "no grain in the image"),
        (GOOD[:0], "no grain in the image"),
    ],
    ids=["float", "bool", "big_endian", "flat", "fortran", "negative", "large", "air", "empty"],
)
def test_images_that_are_not_labels_are_refused(tmp_path, capsys, labels, message):
    write_labels(tmp_path, labels)
    refused(tmp_path, capsys, message)


def test_a_missing_file_or_another_format_is_refused(tmp_path, capsys):
    refused(tmp_path, capsys, "labels.npy: no such file", files=())
    (tmp_path / "image.tif").write_bytes(b"II*\0")
    refused(tmp_path, capsys, "image.tif: not an NPY file", file="image.tif", files=["image.tif"])
    (tmp_path / "labels.npy").write_bytes(b"not an array")
    refused(tmp_path, capsys, "not a .npy file", files=["image.tif", "labels.npy"])


def test_headers_larger_than_their_file_are_refused(tmp_path, capsys):
    write_labels(tmp_path)
    good = (tmp_path / "labels.npy").read_bytes()
    for shape in (b"(99999, 99999, 99999)", b"(12, 4, 5)"):
        changed = good.replace(b"(12, 4, 4)", shape)
        (tmp_path / "labels.npy").write_bytes(changed)
        refused(tmp_path, capsys, "the shape asks for")
    (tmp_path / "labels.npy").write_bytes(b"\x93NUMPY\x02\x00\xff\xff\xff\x7f" + b" " * 2000)
    refused(tmp_path, capsys, "a header of 2147483647 bytes")


@pytest.mark.parametrize(
    ("kind", "options", "message"),
    [
        ("compress", ["--speed", 0], "/loading/0/speed: 0 is outside"),
        ("compress", ["--strain", 0.96], "allowed: up to 0.95"),
        ("compress", ["--strain", "nan"], "strain: nan is not a finite number"),
        ("compress", ["--stress", -1], "/loading/0/stress"),
        ("compress", ["--density-scaling", 0.1], "/numerics/density_scaling"),
        ("compress", ["--sides", "round"], "'round' is not one of 'walls', 'periodic'"),
        ("compress", ["--snapshots", -1], "/output/snapshot_interval"),
        ("stretch", [], '"stretch" pulls at the plates; set /numerics/bonded_plates'),
        ("penetrate", ["--half-angle", 91], "/cone/half_angle"),
        ("stretch", ["--stress", 1], "No such option"),
    ],
)  # fmt: skip
def test_impossible_loading_is_refused(tmp_path, capsys, kind, options, message):
    write_labels(tmp_path)
    refused(tmp_path, capsys, message, *options, kind=kind)


def test_a_voxel_size_is_required(tmp_path, capsys):
    write_labels(tmp_path)
    assert main(["grains", "compress", str(tmp_path / "labels.npy"), "-o", "x"]) == 2
    assert "--voxel" in capsys.readouterr().err
    refused(tmp_path, capsys, "/sample/voxel_size", "--voxel", 0)


def test_resuming_with_another_image_names_the_file(tmp_path, capsys):
    write_labels(tmp_path)
    options = ["--strain", 1e-4, "--density-scaling", 100]
    assert grains(tmp_path, *options) == 0
    assert grains(tmp_path, *options, "--resume") == 0
    labels = GOOD.copy()
    labels[0, 0, 0] = 0
    write_labels(tmp_path, labels)
    assert grains(tmp_path, *options, "--resume") == 2
    assert "labels.npy: has changed since the checkpoint" in capsys.readouterr().err


def test_an_example_that_cannot_run_leaves_no_files(tmp_path, capsys):
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "mine.txt").write_text("keep")
    assert main(["grains", "example", "-o", str(folder)]) == 2
    assert "not empty" in capsys.readouterr().err
    assert {file.name for file in tmp_path.iterdir()} == {"out"}
