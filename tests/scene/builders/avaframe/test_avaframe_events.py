"""Secondary releases, hydrographs, detrainment and dams of AvaFrame's projects."""

import re

import pytest
from helpers.slide_files import box, write_lines, write_polygons, write_project

from snowshed import InputError, SnowshedNote, _core
from snowshed.scene import avaframe_scene
from snowshed.scene.builders.avaframe.project import avaframe_simulations

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")


def write_hydrograph(project, name="flood", rows=((0, 0.4, 3), (5, 0.3, 6))):
    text = "Timestep, thickness,velocity\n" + "".join(f"{t},{h},{u}\n" for t, h, u in rows)
    (project / f"Inputs/REL/{name}.csv").write_text(text)


def test_secondary_releases_are_taken_unless_switched_off(tmp_path):
    project = write_project(tmp_path / "a")
    write_polygons(project / "Inputs/SECREL/sec.geojson", box(44, 10, 54, 30), thickness=0.7)
    (area,) = avaframe_scene(project).resolve().data["terrain"]["secondary_release"]
    assert area["thickness"] == 0.7
    write_project(tmp_path / "a", "secondaryRelThFromFile = False\nsecondaryRelTh = 0.25\n")
    assert avaframe_scene(project).terrain.secondary_release[0].thickness == 0.25
    write_project(tmp_path / "a", "secRelArea = False\n")
    assert avaframe_scene(project).terrain.secondary_release is None


def test_detrainment_has_avaframes_values(tmp_path):
    assert avaframe_scene(write_project(tmp_path / "a")).numerics.detrainment == 0.0
    ini = "detrainment = True\nforestVMin = 4\nforestThMax = 8\n"
    numerics = avaframe_scene(write_project(tmp_path / "b", ini)).numerics
    assert (numerics.detrainment, numerics.forest_min_speed) == (5.0, 4.0)
    assert (numerics.forest_min_thickness, numerics.forest_max_speed) == (0.6, 40.0)
    assert numerics.forest_max_thickness == 8.0
    ini = "detrainment = True\ndetK = 30\n"
    assert avaframe_scene(write_project(tmp_path / "c", ini)).numerics.detrainment == 30.0


def test_a_dam_has_the_height_of_its_crown_above_the_ground(tmp_path):
    project = write_project(tmp_path)
    ground = 1500.0 - 0.7812856265 * 60.0  # a plane of 38 degrees
    line = [[60.0, 8.0, ground + 4.0], [60.0, 40.0, ground + 7.0]]
    write_lines(project / "Inputs/DAM/dam.shp", [line], slope=60, name="wall")
    (dam,) = avaframe_scene(project).resolve().data["terrain"]["dams"]
    assert [corner["height"] for corner in dam["corners"]] == pytest.approx([4.0, 7.0], abs=1e-3)
    assert (dam["name"], dam["slope"], dam["restitution"]) == ("wall", 60.0, 1.0)
    write_project(tmp_path, "dam = False\nnIterDam = 4\n")
    assert avaframe_scene(project).terrain.dams is None


def test_the_restitution_is_cut_as_in_avaframe(tmp_path):
    project = write_project(tmp_path, "restitutionCoefficient = 0.5\n")
    line = [[60.0, 8.0, 1500.0], [60.0, 40.0, 1500.0]]
    write_lines(project / "Inputs/DAM/dam.shp", [line], slope=60)
    with pytest.warns(SnowshedNote, match="0.5 is taken as 0, as in AvaFrame"):
        scene = avaframe_scene(project)
    assert scene.terrain.dams[0].restitution == 0.0


@pytest.mark.parametrize(
    ("lines", "fields", "message"),
    [
        ([[[60, 8, 1500], [60, 40, 1500]]], {}, 'the dam needs a field "slope"'),
        ([[[60, 8], [60, 40]]], {"slope": 60}, 'neither a field "height" nor elevations'),
        ([[[60, 8, 10], [60, 40, 10]]], {"slope": 60}, "its crown must be above the ground"),
        ([[[60, 8, 1500], [600, 40, 1500]]], {"slope": 60}, "is outside the raster"),
        ([[[60, 8, 1500], [60, 40, 1500]]] * 2, {"slope": 60}, "2 lines; AvaFrame takes one dam"),
        ([[[60, 8, 1500], [60, 40, 1500]]], {"slope": "steep"}, "slope 'steep' is not a number"),
    ],
)
def test_dams_that_avaframe_does_not_take_are_refused(tmp_path, lines, fields, message):
    project = write_project(tmp_path)
    write_lines(project / "Inputs/DAM/dam.shp", lines, **fields)
    with pytest.raises(InputError, match=re.escape(message)):
        avaframe_scene(project)


def test_each_hydrograph_is_a_simulation(tmp_path):
    project = write_project(tmp_path, "timeDependentRelease = True\n")
    write_hydrograph(project, "big")
    write_hydrograph(project, "small", ((3, 0.2, 1), (0, 0.1, 0)))
    simulations = avaframe_simulations(project)
    assert [each.hydrograph for each in simulations] == ["big", "small"]
    terrain = simulations[0].scene.resolve().data["terrain"]
    assert terrain["release"][0]["thickness"] == 0.4
    assert terrain["release_speed"] == 3.0
    (inflow,) = terrain["inflows"]
    assert inflow["outline"] == terrain["release"][0]["outline"]
    assert inflow["hydrograph"] == [{"time": 5.0, "thickness": 0.3, "speed": 6.0}]
    chosen = "timeDependentRelease = True\ntimeDependentReleaseScenarios = small.csv\n"
    (only,) = avaframe_simulations(write_project(tmp_path, chosen))
    assert only.scene.terrain.inflows[0].hydrograph[0].time == 3.0


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (((1, 0.4, 3),), "AvaFrame needs a row for the time 0"),
        (((0, 0.4, 3), (0, 0.2, 3)), "a time occurs twice"),
        (((0, 0.4, -3),), "velocity '-3'; allowed: at least 0"),
        (((0, "", 3),), "thickness ''; allowed: above 0"),
        ((), "0 rows; allowed: 1 to 1000"),
        (((0, "x", 3),), "thickness 'x'; allowed: above 0"),
    ],
)
def test_bad_hydrographs_are_refused(tmp_path, rows, message):
    project = write_project(tmp_path, "timeDependentRelease = True\n")
    write_hydrograph(project, rows=rows)
    with pytest.raises(InputError, match=re.escape(message)):
        avaframe_scene(project)


def test_ground_that_adapts_has_avaframes_keys(tmp_path):
    assert not avaframe_scene(write_project(tmp_path / "a")).numerics.ground_gains_stopped
    ini = "adaptSfcStopped = 1\nadaptSfcEntrainment = 1\nthresholdAdaptSfc = 0.02\n"
    numerics = avaframe_scene(write_project(tmp_path / "b", ini)).numerics
    assert numerics.ground_gains_stopped
    assert numerics.ground_loses_entrained
    assert not numerics.ground_gains_detrained
    assert numerics.ground_min_change == 0.02


def test_ground_that_adapts_is_refused_with_later_snow(tmp_path):
    project = write_project(tmp_path, "adaptSfcStopped = 1\n")
    write_polygons(project / "Inputs/SECREL/sec.geojson", box(44, 10, 54, 30), thickness=0.7)
    with pytest.raises(InputError, match="ground_gains_stopped: not with secondary releases"):
        _core.Simulation(avaframe_scene(project).resolve().json, project)
