"""Runs of snow slides: figures, maps, resuming, and the particles after a step."""

import csv
import json
import math
import subprocess
import sys
import time

import numpy as np
import pytest

from snowshed import InputError
from snowshed.base.interrupt import Interrupted
from snowshed.io.raster.raster import Raster, read_raster, write_ascii_grid
from snowshed.methods import slide_states
from snowshed.plot import slide_page
from snowshed.running.run import run
from snowshed.scene import Area, Events, Scene, Terrain, example_slide

pytestmark = pytest.mark.usefixtures("undrawn")

OUTLINE = [(20.3, 18.3), (44.3, 18.3), (44.3, 42.3), (20.3, 42.3)]


@pytest.fixture
def slope(tmp_path) -> Scene:
    """A plane of 38 degrees, and a slab of half a metre on it."""
    fall = math.tan(math.radians(38.0)) * np.arange(60) * 2.0
    write_ascii_grid(tmp_path / "slope.asc", Raster(np.tile(300.0 - fall, (30, 1)), 1e5, 2e5, 2.0))
    outline = [(x + 1e5, y + 2e5) for x, y in OUTLINE]
    return Scene(
        method="slide",
        terrain=Terrain(file=tmp_path / "slope.asc", release=[Area("a", outline, thickness=0.5)]),
        events=Events(max_time=2.0),
    )


def test_figures_agree_with_maps(slope, tmp_path):
    summary = run(slope, tmp_path / "out", pictures=False).summary
    sloping = 24.0 * 24.0 / math.cos(math.radians(38.0))
    assert summary.released_kg == pytest.approx(sloping * 0.5 * 300.0, rel=1e-9)
    speed = read_raster(tmp_path / "out/peaks/pfv.asc")
    assert speed.heights.max() == pytest.approx(summary.peak_speed_m_s, rel=1e-8)
    assert (speed.east, speed.north, speed.cell) == (1e5, 2e5, 2.0)
    pressure = read_raster(tmp_path / "out/peaks/ppr.asc").heights
    assert pressure == pytest.approx(0.3 * speed.heights**2, rel=1e-6)
    assert json.loads((tmp_path / "out/slide.json").read_text())["ended"] == "time_limit"
    # As a block: gravity less Coulomb friction and Voellmy's drag at half a metre.
    a = 9.81 * (math.sin(math.radians(38)) - 0.325 * math.cos(math.radians(38)))
    b = 9.81 / (58 * 0.5)
    block = math.sqrt(a / b) * math.tanh(math.sqrt(a * b) * 2.0)
    assert summary.peak_speed_m_s == pytest.approx(block, rel=0.06)


def test_an_interrupted_slide_resumes_to_the_same_maps(slope, tmp_path):
    run(slope, tmp_path / "whole", pictures=False)

    def stop(progress):
        if progress.time > 0.2:
            raise KeyboardInterrupt

    with pytest.raises((Interrupted, KeyboardInterrupt)):
        run(slope, tmp_path / "two", progress=stop, pictures=False)
    run(slope, tmp_path / "two", resume=True, pictures=False)
    for name in ("peaks/pfv.asc", "peaks/pft.asc", "flow/FT.asc"):
        expected, resumed = ((tmp_path / folder / name).read_bytes() for folder in ("whole", "two"))
        assert expected == resumed


def test_particles_accelerate_by_gravity_less_friction(slope):
    start, later = slide_states(slope, steps=[0, 3])
    assert (start.particles["velocity"] == 0).all()
    # From rest under gravity less friction, in three steps of a hundredth of a second.
    a = 9.81 * (math.sin(math.radians(38)) - 0.325 * math.cos(math.radians(38)))
    speed = np.linalg.norm(later.particles["velocity"], axis=1)
    assert np.median(speed) == pytest.approx(a * 0.03, rel=0.05)


def test_the_energy_balance_is_written_and_closes(slope, tmp_path):
    run(slope.set("output.energy", True), tmp_path / "out", pictures=False)
    (row,) = list(csv.DictReader((tmp_path / "out/energy.csv").open()))
    energy = {name: float(value) for name, value in row.items() if name != "event"}
    drop = energy["added_j"] - energy["potential_j"] - energy["left_terrain_j"]
    assert drop > 0
    assert energy["coulomb_j"] > 0.1 * drop
    assert abs(energy["residual_j"]) < 0.01 * drop
    (event,) = json.loads((tmp_path / "out/run.json").read_text())["finished_events"]
    assert event["energy"] == pytest.approx(energy)


def test_the_example_draws_its_map(tmp_path, drawn):
    scene = example_slide(tmp_path).set("events.max_time", 1.0)
    run(scene, tmp_path / "out")
    assert (tmp_path / "out/slide.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("events.count", 2, "/events/count: 2 events; a slide has 1"),
        ("dimension", 2, "/dimension: a slide needs three dimensions"),
        ("terrain.release.0.thickness", 0, "/terrain/release/0/thickness: 0 is outside"),
        (
            "terrain.release.0.outline",
            [[0, 0], [6, 4], [4, 0], [0, 5]],
            "crosses or touches itself",
        ),
        ("numerics.explicit_friction", True, "/numerics/explicit_friction: only in the mode"),
        ("numerics.artificial_viscosity", 50.0, 'viscosity: only in the mode "compatible"'),
        (
            "panel",
            {"height": 1, "length": 2, "width": 1},
            '/panel: the method "slide" takes no such',
        ),
    ],
)
def test_bad_slides_are_refused(slope, path, value, message):
    with pytest.raises(InputError, match=message):
        slope.set(path, value).resolve()


@pytest.mark.parametrize(("time_step", "is_told"), [(0.1, True), (0.03, True), (0.02, False)])
def test_divided_steps_are_told(slope, tmp_path, time_step, is_told):
    slope.update({"numerics.bonds": False, "numerics.time_step": time_step, "events.max_time": 0.5})
    notes = run(slope, tmp_path / "out", pictures=False).summary.notes
    assert any("were divided" in note for note in notes) == is_told


def test_a_release_beyond_the_terrain_is_refused_without_files(slope, tmp_path):
    slope.terrain.release[0].outline = [(0, 0), (9, 0), (9, 9)]
    with pytest.raises(InputError, match="/terrain/release/0: reaches beyond the terrain"):
        run(slope, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_states_are_those_of_times_or_steps_in_the_given_order(slope):
    by_steps = slide_states(slope, steps=[3, 0, 3])
    assert [(state.steps, state.time) for state in by_steps] == [(3, 0.03), (0, 0.0), (3, 0.03)]
    (by_time,) = slide_states(slope, [0.03])
    assert by_time.particles.identical(by_steps[0].particles)
    assert by_time.particles["thickness"].attrs["units"] == "m"
    wrong = [
        ({}, "either times or steps"),
        ({"times": [1.0], "steps": [1]}, "either times or steps"),
        ({"times": [-1.0]}, "times: -1.0; a time from 0 s"),
        ({"steps": [-1]}, "steps: -1; an integer from 0"),
    ]
    for arguments, message in wrong:
        with pytest.raises(InputError, match=message):
            slide_states(slope, **arguments)
    with pytest.raises(InputError, match='/method: is not "slide"'):
        slide_states(Scene.preset("lab-50").update({"dimension": 2}), [0.0])


def test_snapshots_hold_thickness_speed_and_bonds_as_lines(slope, tmp_path):
    from xml.etree import ElementTree

    from snowshed.io.vtk.vtp import APPENDED_HEAD, read_particles

    slope.update({"numerics.max_strain": 0.02, "output.snapshot_interval": 0.5})
    run(slope, tmp_path / "out", pictures=False)
    files = sorted((tmp_path / "out/snapshots").glob("*.vtp"))
    assert len(files) == 5  # at 0, 0.5, ..., 2 s
    (state,) = slide_states(slope, [1.0])
    snapshot = read_particles(files[2])
    particles, count = np.unique(state.bonds, return_counts=True)
    assert len(state.bonds) > 0 and (snapshot["bonds"][particles] == count).all()
    assert snapshot["bonds"].sum() == 2 * len(state.bonds)
    assert snapshot["thickness"] == pytest.approx(state.quantities["thickness"], rel=1e-6)
    assert snapshot["speed"] == pytest.approx(
        np.linalg.norm(snapshot["velocity"], axis=1), rel=1e-5
    )
    head, _, data = files[2].read_bytes().partition(APPENDED_HEAD)
    lines = ElementTree.fromstring(head + b"</VTKFile>").find("PolyData/Piece/Lines")
    offset = int(lines[0].attrib["offset"]) + 8
    ends = np.frombuffer(data, "<i4", 2 * len(state.bonds), offset).reshape(-1, 2)
    assert (ends == state.bonds).all()


KILLED_RUN = """
import sys
from snowshed.running.run import run
run(sys.argv[1], sys.argv[2])
"""


def test_the_page_of_a_killed_slide_is_complete_after_resuming(tmp_path, monkeypatch, drawn):
    scene = example_slide(tmp_path).set("output.checkpoint_interval", 0.05)
    (tmp_path / "scene.json").write_text(scene.resolve().json)
    drawn = []
    monkeypatch.setattr(
        slide_page, "_film", lambda maps, outlines, frames, objects: drawn.append(frames)
    )
    run(tmp_path / "scene.json", tmp_path / "straight")

    out = tmp_path / "killed"
    command = [sys.executable, "-c", KILLED_RUN, tmp_path / "scene.json", out]
    with subprocess.Popen(command) as process:
        while not (out / "checkpoint.bin").exists():
            assert process.poll() is None
            time.sleep(0.01)
        process.kill()
    run(tmp_path / "scene.json", out, resume=True)

    straight, resumed = drawn
    assert [frame.time for frame in resumed] == [frame.time for frame in straight]
    assert len(straight) > 20 and straight[0].time == 0.0
    for frame, expected in zip(resumed, straight):
        np.testing.assert_array_equal(frame.thickness, expected.thickness)


def test_a_slide_without_film_has_a_page_without_it(slope, tmp_path, drawn):
    run(slope.set("output.film", False), tmp_path / "out")
    page = (tmp_path / "out/slide.html").read_text()
    assert "Peak values" in page and "Over time" not in page
