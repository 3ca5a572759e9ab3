"""``snowshed grains synthetic|segment``: folders for loading tests, and bad input."""

import json

import numpy as np
import pandas as pd
import pytest

from snowshed.cli.main import main

for library in ("skimage", "edt"):
    pytest.importorskip(library)


def grains(*words):
    return main(["grains", *map(str, words), "-q"])


def make(folder, *options):
    words = ["--shape", 32, 32, 32, "--density", 350, "--seed", 2, "-o", folder, *options]
    assert grains("synthetic", *words) == 0


def test_from_synthetic_snow_to_a_loading_test(tmp_path):
    make(tmp_path / "snow", "--specific-surface", 20)
    assert grains("segment", tmp_path / "snow", "-o", tmp_path / "sample", "--surface") == 0
    names = {file.name for file in (tmp_path / "sample").iterdir()}
    assert names == {
        "snow.npy", "labels.npy", "grains.csv", "contacts.csv", "microstructure.json",
        "slices.png", "surface.vtp",
    }  # fmt: skip
    numbers = json.loads((tmp_path / "sample/microstructure.json").read_text())
    labels = np.load(tmp_path / "sample/labels.npy")
    table = pd.read_csv(tmp_path / "sample/grains.csv")
    contacts = pd.read_csv(tmp_path / "sample/contacts.csv")
    assert numbers["synthetic"]
    assert numbers["voxel_size_m"] == 5e-5
    assert numbers["grains"] == len(table) == labels.max()
    assert numbers["contacts"] == len(contacts) == table.coordination.sum() / 2
    assert table.volume_m3.sum() == pytest.approx(np.count_nonzero(labels) * 5e-5**3, rel=1e-5)
    words = ["--strain", 1e-4, "--speed", 0.2, "--density-scaling", 100]
    assert grains("compress", tmp_path / "sample", "-o", tmp_path / "out", *words) == 0
    scene = json.loads((tmp_path / "out/scene.json").read_text())
    assert scene["title"].startswith("synthetic: Gaussian random field")
    assert json.loads((tmp_path / "out/grains.json").read_text())["final_particles"] == labels.max()


def test_a_sphere_pack_has_labels(tmp_path):
    make(tmp_path / "snow", "--spheres", 5e-4)
    assert np.load(tmp_path / "snow/labels.npy").max() > 5
    assert grains("segment", tmp_path / "snow", "--method", "curvature", "-o", tmp_path / "s") == 0


def test_the_surface_belongs_to_the_grains(tmp_path):
    """The file's vertices lie inside the image, and its triangles belong to grains."""
    make(tmp_path / "snow", "--spheres", 5e-4)
    assert grains("segment", tmp_path / "snow", "--surface", "-o", tmp_path / "s") == 0
    content = (tmp_path / "s/surface.vtp").read_bytes()
    head, _, data = content.partition(b'<AppendedData encoding="raw">\n_')
    points = int(head.split(b'NumberOfPoints="')[1].split(b'"')[0])
    size = int.from_bytes(data[:8], "little")
    assert size == 12 * points
    vertices = np.frombuffer(data, "<f4", 3 * points, 8).reshape(-1, 3)
    assert vertices.min() > 0
    assert vertices.max() < 32 * 5e-5
    count = int(head.split(b'NumberOfPolys="')[1].split(b'"')[0])
    owners = np.frombuffer(data, "<i4", count, size + 16)
    assert set(owners) <= set(range(1, int(np.load(tmp_path / "s/labels.npy").max()) + 1))


BALL = sum((axis - 14.5) ** 2 for axis in np.indices((30, 30, 30))) < 100


@pytest.mark.parametrize(
    ("voxels", "options", "message"),
    [
        (np.zeros((9, 9, 9)), [], "empty"),
        (BALL, [], "all ice is one grain"),
        (BALL, ["--voxel", 0.05], "wrongly scaled"),
        (BALL, ["--crop", "0:9"], "--crop '0:9'"),
        (BALL, ["--crop", "0:99,0:9,0:9"], "crop 0:99 along x"),
        (BALL, ["--downscale", 40], "whole numbers from 1 to 16"),
        (BALL, ["--contiguity", 3], "contiguity 3"),
        (BALL[0], [], "2 dimensions"),
    ],
)
def test_bad_images_are_named_and_leave_no_files(tmp_path, capsys, voxels, options, message):
    np.save(tmp_path / "a.npy", voxels)
    words = ["segment", tmp_path / "a.npy", "--voxel", 5e-5, "-o", tmp_path / "out", *options]
    assert grains(*words) == 2
    assert message in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["a.npy"]


def test_a_folder_that_is_not_empty_is_refused(tmp_path, capsys):
    np.save(tmp_path / "a.npy", BALL)
    assert grains("segment", tmp_path / "a.npy", "--voxel", 5e-5, "-o", tmp_path) == 2
    assert "not empty" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--density", 300], "give one of the two"),
        (["--density", 300, "--specific-surface", 15, "--neck", 0.4], "--neck: not an option"),
        (["--density", 300, "--spheres", 5e-4, "--anisotropy", 2], "--anisotropy: not an option"),
        (["--density", 300, "--spheres", 5e-4, "--specific-surface", 9], "not an option of a pack"),
    ],
)
def test_options_that_do_not_fit_are_refused(tmp_path, capsys, options, message):
    assert grains("synthetic", *options, "-o", tmp_path / "snow") == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "snow").exists()


def test_labels_without_a_voxel_size_are_refused(tmp_path, capsys):
    np.save(tmp_path / "labels.npy", BALL.astype(np.int32))
    assert grains("compress", tmp_path / "labels.npy", "-o", tmp_path / "out") == 2
    assert "the edge of a voxel is not known" in capsys.readouterr().err
