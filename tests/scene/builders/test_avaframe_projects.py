"""Scenes of AvaFrame's projects: what an ini and a folder ask for is done or refused."""

import re

import numpy as np
import pytest
from slide_files import WITH_HOLE, box, plane, write_polygons, write_project

from snowshed import InputError
from snowshed.io.raster import read_raster
from snowshed.scene.builders import avaframe_scene
from snowshed.scene.builders.avaframe import avaframe_simulations

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")


def test_a_project_without_ini_has_com5s_defaults(tmp_path):
    data = avaframe_scene(write_project(tmp_path)).resolve().data
    assert data["numerics"]["mode"] == "compatible"
    assert data["numerics"]["cell"] == 2.0
    assert data["events"]["max_time"] == 400.0


def test_an_ini_is_taken_as_it_is(tmp_path):
    ini = "muvoellmy = 0.4\ncohesionMaxStrain = 0.1\ntEnd = 9\nsnowSlide = 0\nseed = 3\n"
    scene = avaframe_scene(write_project(tmp_path, ini))
    assert (scene.numerics.friction, scene.numerics.max_strain) == (0.4, 0.1)
    assert (scene.events.max_time, scene.numerics.bonds) == (9.0, False)


def test_each_law_of_friction_has_a_coefficient_of_its_own(tmp_path):
    ini = "frictModel = Coulomb\nmuvoellmy = 0.4\n"
    assert avaframe_scene(write_project(tmp_path / "a", ini)).numerics.friction == 0.155
    ini += "mucoulomb = 0.5\n"
    assert avaframe_scene(write_project(tmp_path / "b", ini)).numerics.friction == 0.5


@pytest.mark.parametrize(
    ("ini", "message"),
    [
        ("sphOption = 2", "sphoption: '2' is not available; allowed: 1"),
        ("detrainment = True", "detrainment: 'True' is not available; allowed: false"),
        ("ResistanceModel = cRes", "resistancemodel: 'cRes' is not available"),
        ("frictModel = samosAT", "frictmodel: 'samosAT' is not available; allowed: Voellmy, Coul"),
        ("muvoelmy = 0.4", "none of the keys that are known here; did you mean"),
        ("dt = 0.1|0.2", "'0.1|0.2' is not one number"),
        ("relThPercentVariation = 50$10", "variations of a thickness are not available here"),
        ("relTh = 0.4", "relth: given, though relthfromfile is True"),
        ("relThFromFile = False", "relth: missing, though relthfromfile is False"),
        ("simTypeList = null|entr", "'entr' is not available; allowed: available, entres"),
        ("simTypeList = res", "holds no polygons, which simTypeList res needs"),
        ("resType = ppr|pta", "restype: 'pta' is not available"),
        ("tSteps = 1-5", "neither start:interval nor times"),
        ("sphKernelRadius = 5", "sphkernelradius: '5' is not available; allowed: meshCellSize"),
        ("releaseScenario = other", "no release area 'other'"),
    ],
)
def test_bad_inis_are_named(tmp_path, ini, message):
    with pytest.raises(InputError, match=re.escape(message)):
        avaframe_scene(write_project(tmp_path, ini))


def test_an_ini_without_sections_is_none(tmp_path):
    project = write_project(tmp_path)
    (project / "local_com5SnowSlideCfg.ini").write_text("muvoellmy = 0.4\n")
    with pytest.raises(InputError, match="not an ini file"):
        avaframe_scene(project)


def test_each_release_file_and_type_is_a_simulation(tmp_path):
    project = write_project(tmp_path, releases=("north", "south"))
    write_polygons(project / "Inputs/ENT/ent.geojson", box(40, 10, 60, 30))
    write_polygons(project / "Inputs/RES/res.geojson", box(50, 10, 60, 30))
    found = avaframe_simulations(project)
    assert [(s.release, s.sim_type) for s in found] == [
        ("north", "entres"), ("north", "null"), ("south", "entres"), ("south", "null"),
    ]  # fmt: skip
    full, none = (s.scene.resolve().data["terrain"] for s in found[:2])
    assert full["entrainment"][0]["thickness"] == 0.3  # com1DFA's, where the file says nothing
    assert full["resistance"]
    assert not none.get("entrainment")
    assert not none.get("resistance")


def test_the_ini_chooses_among_types_and_releases(tmp_path):
    ini = "simTypeList = null|res\nreleaseScenario = south\nrelThFromFile = False\nrelTh = 0.8\n"
    project = write_project(tmp_path, ini, releases=("north", "south"))
    write_polygons(project / "Inputs/RES/res.geojson", box(50, 10, 60, 30))
    found = avaframe_simulations(project)
    assert [(s.release, s.sim_type) for s in found] == [("south", "res"), ("south", "null")]
    assert found[0].scene.terrain.release[0].thickness == 0.8


@pytest.mark.parametrize(
    ("folder", "message"),
    [("SECREL", "secondary release areas are not available"), ("DAM", "dams are not available")],
)
def test_what_is_not_done_is_refused_unless_switched_off(tmp_path, folder, message):
    project = write_project(tmp_path)
    write_polygons(project / "Inputs" / folder / "more.geojson", thickness=1)
    with pytest.raises(InputError, match=message):
        avaframe_scene(project)
    assert avaframe_scene(write_project(tmp_path, "secRelArea = False\ndam = False\n"))


@pytest.mark.parametrize(
    ("folder", "message"),
    [("REL", "takes no release from a raster"), ("ENT", "are taken from polygons only")],
)
def test_rasters_of_areas_are_refused(tmp_path, folder, message):
    project = write_project(tmp_path)
    (project / "Inputs" / folder).mkdir(exist_ok=True)
    (project / "Inputs" / folder / "depth.asc").write_bytes(b"")
    with pytest.raises(InputError, match=message):
        avaframe_scene(project)


def test_a_release_with_a_hole_is_refused_as_there(tmp_path):
    project = write_project(tmp_path)
    write_polygons(project / "Inputs/REL/rel.geojson", WITH_HOLE, thickness=0.5)
    with pytest.raises(InputError, match="has a hole, which AvaFrame does not allow"):
        avaframe_scene(project)


def test_terrain_of_other_cells_is_resampled_by_cubic_convolution(tmp_path):
    pytest.importorskip("rasterio")
    raster = plane(columns=17, rows=13, cell=5.0)
    project = write_project(tmp_path, raster=raster)
    scene = avaframe_scene(project, ascii_copy=tmp_path / "copy.asc")
    copy = read_raster(scene.terrain.file)
    assert copy.heights.shape == (31, 41)  # no further than the raster
    assert (copy.cell, copy.east, copy.north) == (2.0, 0.0, 0.0)
    # A plane stays one, but for single precision, away from the border.
    slope = (raster.heights[0, 1] - raster.heights[0, 0]) / 5.0
    expected = 1500.0 + slope * 2.0 * np.arange(41)
    assert copy.heights[15, 4:-4] == pytest.approx(expected[4:-4], abs=2e-4)
