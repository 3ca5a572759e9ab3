"""Scenes from arrays in memory: terrain, polygons, grains and solids."""

import warnings

import numpy as np
import pandas as pd
import pytest

import snowshed
from snowshed import (
    GrainsSettings,
    InputError,
    LoadingStage,
    Obstacle,
    Sample,
    Scene,
    Shape,
    SnowshedNote,
)
from snowshed.io import Raster
from snowshed.io.array_files import array_folder
from snowshed.scene import slide_scene
from snowshed.study import Study
from snowshed.study.factors import Factor

HILL = np.repeat([np.linspace(60.0, 0.0, 41)], 21, axis=0)
CORNERS = [(20, 30), (60, 30), (60, 70), (20, 70)]


@pytest.fixture
def release():
    return pytest.importorskip("shapely.geometry").Polygon(CORNERS)


def as_array(**attributes):
    xarray = pytest.importorskip("xarray")
    x, y = 5.0 * np.arange(41), 5.0 * np.arange(21)
    return xarray.DataArray(HILL, {"y": y, "x": x}, ("y", "x"), attrs=attributes)


def reached(results):
    return results.summary.reached_m2, results.summary.peak_speed_m_s


def test_a_slide_from_arrays_is_that_of_the_raster(tmp_path, release):
    arrays = [as_array(crs="EPSG:31287"), as_array()[::-1, ::-1], Raster(HILL, 0.0, 0.0, 5.0)]
    outcomes = [
        reached(snowshed.slide(array, release, tmp_path / f"{number}", thickness=0.5, max_time=2,
                               pictures=False))
        for number, array in enumerate(arrays)
    ]  # fmt: skip
    assert outcomes[0] == outcomes[1] == outcomes[2]


@pytest.mark.parametrize("terrain", [as_array, lambda crs: Raster(HILL, 0.0, 0.0, 5.0, crs=crs)])
def test_a_map_in_degrees_is_refused(terrain, release):
    with pytest.raises(InputError, match=r"is in degrees \(EPSG:4326\); project it to metres"):
        slide_scene(terrain(crs="EPSG:4326"), release, thickness=0.5)


def test_the_maps_of_a_slide_keep_the_coordinate_system(tmp_path, release):
    results = snowshed.slide(as_array(crs="EPSG:31287"), release, tmp_path / "out", thickness=0.5,
                             max_time=1, pictures=False)  # fmt: skip
    assert results.maps.attrs["crs"] == "EPSG:31287"
    assert results.maps.x.values[[0, -1]].tolist() == [0.0, 200.0]


def test_a_scene_from_arrays_needs_no_file_and_its_run_keeps_one(tmp_path, release):
    scene = slide_scene(as_array(), [release], thickness=0.5).set("events.max_time", 1)
    first = snowshed.run(scene, tmp_path / "out", pictures=False)
    file = first.scene.data["terrain"]["file"]
    assert file.startswith(str(tmp_path / "out-inputs"))
    again = snowshed.run(tmp_path / "out/run.json", pictures=False)
    assert reached(again) == reached(first)


def test_arrays_of_a_run_that_a_note_refuses_are_not_left(tmp_path, release):
    scene = slide_scene(as_array(), [release], thickness=5.0).set("events.max_time", 1)
    with warnings.catch_warnings():
        warnings.simplefilter("error", SnowshedNote)
        with pytest.raises(SnowshedNote):
            snowshed.run(scene, tmp_path / "out", pictures=False)
    assert list(tmp_path.iterdir()) == []


def test_thickness_and_names_come_from_a_table_of_polygons(release):
    class Frame(pd.DataFrame):
        crs = "EPSG:31287"

        @property
        def geometry(self):
            return self["geometry"]

    table = Frame({"geometry": [release], "name": ["east"], "thickness": [0.7]})
    (area,) = slide_scene(as_array(crs="EPSG:31287"), table).terrain.release
    assert (area.name, area.thickness) == ("east", 0.7)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda a: a.rename(x="t"), "its dimensions are y, t; needed: y and x"),
        (lambda a: a.assign_coords(x=a.x**2 + 1), "x are not evenly spaced"),
        (lambda a: a.assign_coords(x=2 * a.x), "not square"),
        (lambda a: a.isel(x=[0]), "dimensions are y; needed"),
    ],
)
def test_wrong_elevations_are_refused(release, change, message):
    with pytest.raises(InputError, match=message):
        slide_scene(change(as_array()), release, thickness=0.5)


@pytest.mark.parametrize("polygons", [[], [1.5], 7])
def test_wrong_polygons_are_refused(polygons):
    with pytest.raises(InputError, match=r"release|polygons"):
        slide_scene(as_array(), polygons, thickness=0.5)


def test_polygons_that_cross_themselves_are_refused():
    geometry = pytest.importorskip("shapely.geometry")
    bow = geometry.Polygon([(20, 30), (60, 70), (60, 30), (20, 70)])
    with pytest.raises(InputError, match="release 1: the polygon crosses"):
        slide_scene(as_array(), bow, thickness=0.5)


def test_grains_are_loaded_from_an_array(tmp_path):
    labels = np.zeros((8, 8, 8), int)
    labels[:, 2:6, 2:6] = 1
    labels[4:, 2:6, 2:6] = 2
    scene = Scene(
        method="grains", dimension=3, sample=Sample.from_labels(labels, voxel_size=1e-4),
        loading=[LoadingStage(kind="compress", strain=0.01)],
        numerics=GrainsSettings(density_scaling=1e4),
    )  # fmt: skip
    results = snowshed.run(scene, tmp_path / "out", pictures=False)
    assert results.run["particles"] == 2


def test_a_solid_from_distances_is_the_same_as_its_primitive(tmp_path):
    x, z = np.meshgrid(np.linspace(-0.2, 0.2, 81), np.linspace(-0.2, 0.2, 81), indexing="ij")
    disc = Shape.from_distances(np.hypot(x, z) - 0.1, origin=(-0.2, -0.2), spacing=0.005)
    scene = Scene.preset("lab-50").with_({"dimension": 2, "numerics.dx": 0.02})
    resolved = scene.append("obstacles", Obstacle(name="disc", shape=disc)).resolve()
    core = snowshed._core.Simulation(resolved.core, resolved.base_dir)
    points = np.array([[0.15, 0.0, 0.0], [0.0, 0.0, 0.18]])
    assert np.allclose(core.obstacle_distance(points), [0.05, 0.08], atol=1e-3)


@pytest.mark.parametrize(
    "make",
    [
        lambda: Sample.from_labels(np.ones((2, 2)), voxel_size=1e-4),
        lambda: Sample.from_labels(np.full((2, 2, 2), 0.5), voxel_size=1e-4),
        lambda: Shape.from_distances(np.ones(3), origin=(0, 0), spacing=1.0),
        lambda: Shape.from_distances(np.full((2, 2), np.nan), origin=(0, 0), spacing=1.0),
    ],
)
def test_wrong_arrays_are_refused(make):
    with pytest.raises(InputError, match="needed is an array"):
        make()


def test_a_failed_run_leaves_no_copies(tmp_path):
    labels = np.zeros((4, 4, 4), int)  # no ice
    scene = Scene(method="grains", dimension=3,
                  sample=Sample.from_labels(labels, voxel_size=1e-4))  # fmt: skip
    with pytest.raises(InputError):
        snowshed.run(scene, tmp_path / "out")
    assert list(tmp_path.iterdir()) == [] and array_folder().is_dir()


def test_factors_come_from_a_table():
    table = pd.DataFrame({"panel.tilt": [40, 50], "panel.friction": [0.3, 0.4]})
    study = Study(Scene.preset("lab-50"), [[Factor(table)]], "pairs")
    tilts = [run.scene.count('"tilt": 50') for run in study.runs()]
    assert tilts == [0, 1] or len(tilts) == 2
