"""Scenes of AvaFrame's projects: settings of an ini and files are applied or refused."""

import re

import numpy as np
import pytest
from helpers.slide_files import WITH_HOLE, box, plane, write_polygons, write_project

from snowshed import InputError, _core
from snowshed.io.raster.raster import read_raster
from snowshed.scene import avaframe_scene
from snowshed.scene.builders.avaframe.project import avaframe_simulations

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")


def test_a_project_without_ini_has_com5s_defaults(tmp_path):
    data = avaframe_scene(write_project(tmp_path)).resolve().data
    assert data["numerics"]["mode"] == "compatible"
    assert data["numerics"]["cell"] == 2.0
    assert data["events"]["max_time"] == 400.0


def test_settings_of_an_ini_are_applied(tmp_path):
    ini = "muvoellmy = 0.4\ncohesionMaxStrain = 0.1\ntEnd = 9\nsnowSlide = 0\nseed = 3\n"
    scene = avaframe_scene(write_project(tmp_path, ini))
    assert (scene.numerics.friction, scene.numerics.max_strain) == (0.4, 0.1)
    assert (scene.events.max_time, scene.numerics.bonds) == (9.0, False)


def test_each_law_of_friction_has_its_own_coefficient(tmp_path):
    ini = "frictModel = Coulomb\nmuvoellmy = 0.4\n"
    assert avaframe_scene(write_project(tmp_path / "a", ini)).numerics.friction == 0.155
    ini += "mucoulomb = 0.5\n"
    assert avaframe_scene(write_project(tmp_path / "b", ini)).numerics.friction == 0.5


@pytest.mark.parametrize(
    ("ini", "message"),
    [
        ("sphOption = 2", "sphoption: '2' is not available; allowed: 1"),
        ("detK = -1", "detk: '-1'; allowed: at least 0"),
        ("restitutionCoefficient = 2", "restitutioncoefficient: '2'; allowed: at least 0 and at"),
        ("nIterDam = 3", "niterdam: '3' is not available; allowed: 1"),
        ("adaptSfcStopped = 2", "adaptsfcstopped: '2' is neither True nor False"),
        ("thresholdAdaptSfc = -1", "thresholdadaptsfc: '-1'; allowed: at least 0"),
        ("resType = sfcChange", "restype: sfcChange needs adaptSfcStopped"),
        (
            "adaptSfcStopped = 1\nresType = demAdapted\ntSteps = 1",
            "restype: demAdapted is made at the end only; leave tSteps empty",
        ),
        ("timeDependentRelease = True", "timeDependentRelease needs a table (*.csv) here"),
        ("ResistanceModel = cRes", "resistancemodel: 'cRes' is not available"),
        ("frictModel = samosAT", "frictmodel: 'samosAT' is not available; allowed: Voellmy, Coul"),
        ("muvoelmy = 0.4", "unknown key; did you mean"),
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
def test_bad_inis_are_refused(tmp_path, ini, message):
    with pytest.raises(InputError, match=re.escape(message)):
        avaframe_scene(write_project(tmp_path, ini))


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("meshCellSize = nan", "meshcellsize: 'nan'; allowed: at least 0 and at most 1e+06"),
        ("meshCellSize = -5", "meshcellsize: '-5'; allowed: at least 0"),
        ("meshCellSize = 1e-300", "meshcellsize: /numerics/cell: 1e-300 m makes inf cells"),
        ("meshCellSize = 0.001", "meshcellsize: /numerics/cell: 0.001 m makes"),
        ("dt = 1e-300", "dt: '1e-300'; allowed: at least 1e-06 and at most 1"),
        ("dt = inf", "dt: 'inf'; allowed: at least 1e-06 and at most 1"),
        ("rho = 0", "rho: '0'; allowed: above 0 and at most 1000"),
        ("muvoellmy = nan", "muvoellmy: 'nan'; allowed: at least 0"),
        ("tEnd = inf", "tend: 'inf'; allowed: above 0 and at most 1e+09"),
        ("tEnd = nan", "tend: 'nan'; allowed: above 0"),
        ("tSteps = 0:inf", "tsteps: '0:inf' is neither start:interval nor times"),
        ("tSteps = nan:1", "tsteps: 'nan:1' is neither"),
        ("tSteps = 1|inf", "tsteps: '1|inf' is neither"),
        ("tSteps = 0:1e-9", "tsteps: '0:1e-9' are 4e+11 times until 400 s; allowed: 10000"),
        ("tSteps = 0:1e-320", "tsteps: '0:1e-320' are inf times until 400 s"),
        ("tSteps = " + "1|" * 20000 + "1", "are 2e+04 times until 400 s"),
        ("relThFromFile = False\nrelTh = nan", "relth: 'nan'; allowed: above 0 and at most 100"),
        ("entThFromFile = False\nentTh = -1", "entth: '-1'; allowed: above 0 and at most 100"),
        ("simTypeList = \x1b[31m", r"simtypelist: '\x1b[31m' is not available"),
        ("\x1b[31m = 1", "?[31m: unknown key"),
    ],
)
def test_impossible_numbers_are_refused_with_their_line(tmp_path, line, message):
    project = write_project(tmp_path, f"tAnything = 1\n{line}\n".replace("tAnything", "seed"))
    with pytest.raises(InputError, match=re.escape(message)) as refused:
        avaframe_scene(project, ascii_copy=tmp_path / "copy.asc")
    number = 4 + line.count("\n")
    assert f"com5SnowSlideCfg.ini, line {number}: " in str(refused.value)
    assert not (tmp_path / "copy.asc").exists()


def test_a_setting_that_the_scene_refuses_is_located(tmp_path):
    project = write_project(tmp_path, "meshCellSize = 2\ndeltaTh = 1e-12\n")
    (simulation,) = avaframe_simulations(project)
    resolved = simulation.scene.resolve()
    with pytest.raises(InputError, match=r"1e-12 m makes .* particles; at most 2e") as refused:
        _core.Simulation(resolved.json, resolved.base_dir)
    located = simulation.project.located(refused.value)
    assert "com5SnowSlideCfg.ini, line 4: deltath: /numerics/layer_thickness" in str(located)


def test_maps_that_would_fill_the_disk_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("snowshed.scene.builders.avaframe.project.MAX_SAVED_CELLS", 10_000)
    project = write_project(tmp_path, "tSteps = 0|1\n")
    assert avaframe_simulations(project)
    write_project(tmp_path, "tSteps = 0|1|2\n")
    with pytest.raises(InputError, match=r"line 3: tsteps: 9 maps have 1\.08e\+04 cells"):
        avaframe_simulations(project)


def test_an_ini_that_is_too_long_is_refused(tmp_path):
    project = write_project(tmp_path, "rho = 200\n")
    ini = project / "Inputs/CFGs/com5SnowSlideCfg.ini"
    ini.write_text(ini.read_text() + "#\n" * 600_000)
    with pytest.raises(InputError, match="longer than 1 MB"):
        avaframe_scene(project)


def test_an_ini_without_sections_is_refused(tmp_path):
    project = write_project(tmp_path)
    (project / "local_com5SnowSlideCfg.ini").write_text("muvoellmy = 0.4\n")
    with pytest.raises(InputError, match="not an ini file"):
        avaframe_scene(project)


def test_each_release_file_and_type_is_a_simulation(tmp_path):
    project = write_project(tmp_path, releases=("north", "south"))
    write_polygons(project / "Inputs/ENT/ent.geojson", box(40, 10, 60, 30))
    write_polygons(project / "Inputs/RES/res.geojson", box(50, 10, 60, 30))
    simulations = avaframe_simulations(project)
    assert [(s.release, s.sim_type) for s in simulations] == [
        ("north", "entres"), ("north", "null"), ("south", "entres"), ("south", "null"),
    ]  # fmt: skip
    with_areas, without_areas = (s.scene.resolve().data["terrain"] for s in simulations[:2])
    assert with_areas["entrainment"][0]["thickness"] == 0.3  # com1DFA's default
    assert with_areas["resistance"]
    assert not without_areas.get("entrainment")
    assert not without_areas.get("resistance")


def test_the_ini_chooses_among_types_and_releases(tmp_path):
    ini = "simTypeList = null|res\nreleaseScenario = south\nrelThFromFile = False\nrelTh = 0.8\n"
    project = write_project(tmp_path, ini, releases=("north", "south"))
    write_polygons(project / "Inputs/RES/res.geojson", box(50, 10, 60, 30))
    simulations = avaframe_simulations(project)
    assert [(s.release, s.sim_type) for s in simulations] == [("south", "res"), ("south", "null")]
    assert simulations[0].scene.terrain.release[0].thickness == 0.8


@pytest.mark.parametrize(
    ("folder", "message"),
    [
        ("ENT", "are taken from polygons only"),
        ("SECREL", "are taken from polygons only"),
    ],
)
def test_rasters_of_areas_are_refused(tmp_path, folder, message):
    project = write_project(tmp_path)
    (project / "Inputs" / folder).mkdir(exist_ok=True)
    (project / "Inputs" / folder / "depth.asc").write_bytes(b"")
    with pytest.raises(InputError, match=message):
        avaframe_scene(project)


def test_a_release_with_a_hole_is_refused_as_in_avaframe(tmp_path):
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
    assert copy.heights.shape == (31, 41)  # within the raster
    assert (copy.cell, copy.east, copy.north) == (2.0, 0.0, 0.0)
    # Away from the border, a plane stays a plane within single precision.
    slope = (raster.heights[0, 1] - raster.heights[0, 0]) / 5.0
    expected = 1500.0 + slope * 2.0 * np.arange(41)
    assert copy.heights[15, 4:-4] == pytest.approx(expected[4:-4], abs=2e-4)
