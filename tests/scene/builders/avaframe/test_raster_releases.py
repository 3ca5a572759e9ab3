"""A release from a raster in the compatible mode, beside AvaFrame's own results."""

import json
import re

import numpy as np
import pytest
from helpers.raster_releases import CASES, OTHER_CELLS, PLANE, RECORD, write_raster_project
from helpers.slide_files import box, plane, write_polygons, write_project

from snowshed import InputError, InputNote, _core
from snowshed.cli.main import main
from snowshed.io.raster.raster import Raster, write_ascii_grid
from snowshed.io.raster.terrain_nodes import thickness_on_terrain
from snowshed.methods.slide.maps import slide_maps
from snowshed.methods.slide.settings import SlideSettings
from snowshed.scene import slide_scene
from snowshed.scene.builders.avaframe.project import avaframe_simulations

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")

WITHOUT_BONDS = "snowSlide = 0\n"


def raster_project(folder, depth, ini=WITHOUT_BONDS):
    """Write a project on a plane of 40 by 30 nodes whose release is a raster."""
    (folder / "Inputs/REL").mkdir(parents=True)
    project = write_project(folder, ini, releases=())
    write_ascii_grid(project / "Inputs/REL/rel.asc", depth)
    return project


def some_snow(value=0.5, rows=30, columns=40):
    """Return a raster on the nodes of `plane`, with snow in the middle."""
    values = np.zeros((rows, columns))
    values[8:14, 8:16] = value
    return Raster(values, 0.0, 0.0, 2.0)


def simulations_of(project):
    return avaframe_simulations(project, ascii_copy=project.parent / "copy.asc")


@pytest.mark.filterwarnings("ignore::snowshed.InputNote")
@pytest.mark.parametrize("case", CASES)
def test_the_thickness_is_that_of_avaframe(tmp_path, case):
    recorded = json.loads(RECORD.read_text())[case]
    project = write_raster_project(tmp_path / "project", case)
    (simulation,) = simulations_of(project)
    resolved = simulation.scene.resolve()
    slide = _core.Simulation(resolved.core, resolved.base_dir)
    slide.begin_event()
    done = 0
    for step, snow in recorded["thickness"].items():
        slide.step(int(step) - done)
        done = int(step)
        thickness = slide_maps(slide).thickness
        expected = np.zeros(thickness.size)
        expected[snow["nodes"]] = snow["metres"]
        assert expected.max() > 0.3
        assert np.abs(thickness.ravel() - expected).max() < 1e-10
    assert slide.particle_count == recorded["particles"]
    entrained = slide.slide_facts()["entrained_kg"]
    assert entrained == pytest.approx(recorded["entrained_kg"], rel=1e-9)


def test_bonds_with_a_raster_are_refused_at_their_line(tmp_path):
    (simulation,) = simulations_of(raster_project(tmp_path / "a", some_snow(), "snowSlide = 1\n"))
    with pytest.raises(InputError, match="fails to bond snow of a raster") as refused:
        simulation.scene.resolve()
    assert "line 3: snowslide" in str(simulation.project.located(refused.value))


def test_snow_that_makes_no_particle_is_refused_with_its_place(tmp_path):
    depth = some_snow()
    depth.heights[8, 9] = 0.1
    (simulation,) = simulations_of(raster_project(tmp_path / "a", depth))
    resolved = simulation.scene.resolve()
    with pytest.raises(InputError, match=re.escape("is too thin: 0.100000 m at (18.000000, 16.0")):
        _core.Simulation(resolved.core, resolved.base_dir).begin_event()


@pytest.mark.parametrize(
    ("change", "ini", "message"),
    [
        ("nan", "", "no thickness at (0, 0)"),
        ("negative", "", "a negative thickness at (0, 0)"),
        ("crop", "", "does not cover the terrain"),
        ("shift", "", "begins within the terrain or ends beyond it by more than 3 cells"),
        ("polygons", "", "has polygons and rasters"),
        ("", "relThFromFile = False\nrelTh = 0.5\n", "a raster holds the thickness"),
        ("", "timeDependentRelease = True\n", "timeDependentRelease needs polygons"),
        ("", "resizeThreshold = 5\n", "resizethreshold: '5' is not available; allowed: 3"),
    ],
)
def test_what_avaframe_refuses_of_a_raster_is_refused(tmp_path, change, ini, message):
    depth = some_snow()
    if change in ("nan", "negative"):
        depth.heights[0, 0] = {"nan": np.nan, "negative": -0.1}[change]
    if change == "crop":
        depth = Raster(depth.heights[:25], 0.0, 0.0, 2.0)
    if change == "shift":
        depth = Raster(depth.heights, 7.0, 0.0, 2.0)
    project = raster_project(tmp_path / "a", depth, WITHOUT_BONDS + ini)
    if change == "polygons":
        write_polygons(project / "Inputs/REL/other.geojson", thickness=0.5)
    if "timeDep" in ini:
        (project / "Inputs/REL/times.csv").write_text("timestep,thickness,velocity\n0,1,1\n")
    with pytest.raises(InputError, match=re.escape(message)):
        simulations_of(project)


def test_each_raster_of_a_project_has_a_copy_of_its_own(tmp_path):
    project = raster_project(tmp_path / "a", some_snow())
    write_ascii_grid(project / "Inputs/REL/thick.asc", some_snow(0.9))
    first, second = simulations_of(project)
    assert first.scene.terrain.thickness_file != second.scene.terrain.thickness_file
    masses = []
    for simulation in (first, second):
        resolved = simulation.scene.resolve()
        slide = _core.Simulation(resolved.core, resolved.base_dir)
        slide.begin_event()
        masses.append(slide.slide_facts()["released_kg"])
    assert masses[1] > 1.5 * masses[0]


def test_a_scene_from_files_has_the_same_snow_as_the_project(tmp_path):
    project = write_raster_project(tmp_path / "project", OTHER_CELLS)
    with pytest.warns(InputNote, match="was interpolated onto the terrain's cells of 2 m"):
        (simulation,) = simulations_of(project)
    settings = simulation.scene.numerics
    with pytest.warns(InputNote, match="was interpolated onto the terrain's cells of 2 m"):
        scene = slide_scene(
            project / "Inputs/dem.asc",
            thickness_raster=project / "Inputs/REL/rel.asc",
            settings=settings,
            ascii_copy=tmp_path / "scene.asc",
        )
    assert "was interpolated" in scene.terrain.notes
    assert "was interpolated" in simulation.scene.terrain.notes
    particles = []
    for each in (scene, simulation.scene):
        resolved = each.resolve()
        slide = _core.Simulation(resolved.core, resolved.base_dir)
        slide.begin_event()
        particles.append((slide.particle_count, slide.slide_facts()["released_kg"]))
    assert particles[0] == particles[1]


def test_polygons_choose_the_nodes_of_a_raster(tmp_path):
    write_ascii_grid(tmp_path / "dem.asc", plane())
    write_ascii_grid(tmp_path / "depth.asc", some_snow())
    # Four nodes by four, from 16 to 22 m; their cells reach beyond the polygon.
    polygon = write_polygons(tmp_path / "rel.geojson", box(15.8, 15.8, 22.2, 22.2))
    cut = some_snow(0.0)
    cut.heights[8:12, 8:12] = 0.5
    write_ascii_grid(tmp_path / "cut.asc", cut)
    released = []
    for release, depth in ((polygon, "depth.asc"), (None, "cut.asc")):
        scene = slide_scene(
            tmp_path / "dem.asc",
            release,
            thickness_raster=tmp_path / depth,
            settings=SlideSettings(mode="compatible", bonds=False),
            ascii_copy=tmp_path / "copy.asc",
        )
        resolved = scene.resolve()
        slide = _core.Simulation(resolved.core, resolved.base_dir)
        slide.begin_event()
        released.append((slide.particle_count, slide.slide_facts()["released_kg"]))
    assert released[0] == released[1]
    assert released[0][1] > 10_000


def test_a_raster_in_double_precision_stays_exact_and_text_is_single():
    terrain, depth = plane(), some_snow(0.1)
    text = thickness_on_terrain(depth, terrain)
    assert text.heights.max() == np.float32(0.1)
    exact = Raster(depth.heights, 0.0, 0.0, 2.0, numbers="float64")
    assert thickness_on_terrain(exact, terrain).heights.max() == 0.1


def test_negative_values_are_refused_before_interpolation_hides_them():
    depth = Raster(np.full((30, 40), 0.5), -3.0, -3.0, 3.0)
    depth.heights[0, 0] = -0.1
    with pytest.raises(InputError, match="a negative thickness at"):
        thickness_on_terrain(depth, plane(columns=30, rows=30))


def test_a_plane_case_is_on_the_nodes_of_the_terrain(tmp_path):
    project = write_raster_project(tmp_path / "project", PLANE)
    (simulation,) = simulations_of(project)
    assert not simulation.scene.terrain.notes


def test_a_refused_project_leaves_no_copies(tmp_path):
    thin = raster_project(tmp_path / "a", some_snow(0.1))
    command = ["slide", "--avaframe", str(thin), "-o", str(tmp_path / "out"), "-q"]
    assert main(command) == 2
    assert [file.name for file in tmp_path.iterdir()] == ["a"]
    write_ascii_grid(thin / "Inputs/REL/rel.asc", some_snow())
    assert main([*command, "--max-time", "0.05"]) == 0
    assert (tmp_path / "out-terrain-thickness-rel.asc").exists()
    assert list((tmp_path / "out/Outputs/com1DFA/peakFiles").glob("rel_*_pft.asc"))
