"""Structures: positions of their parts, refused arguments, and runs."""

import math

import numpy as np
import pytest

from snowshed import InputError, _core, read_events, run_events
from snowshed.base.notes import record_notes
from snowshed.scene import (
    gable_roof,
    mesh_structure,
    panel_rows,
    panel_table,
    shed_roof,
    tracker,
)
from snowshed.scene.builders.guards import carried_length

PANEL = {"height": 0.6, "length": 1.0, "tilt": 40.0, "snow": 0.1, "dx": 0.05}
ROOF = {"eaves": 2.0, "length": 2.0, "tilt": 30.0, "snow": 0.2, "dx": 0.05}


def begin_simulation(scene):
    """Return a simulation that has the snow of its first event."""
    resolved = scene.set("numerics.threads", 1).resolve()
    simulation = _core.Simulation(resolved.json, resolved.base_dir)
    simulation.begin_event()
    return simulation


def distance(simulation, *points):
    """Return distances from points (x, z) to obstacles, without panel and ground."""
    return simulation.obstacle_distance(np.array([[x, 0.0, z] for x, z in points]))


def test_rows_are_a_pitch_apart_and_carry_the_same_snow():
    simulation = begin_simulation(panel_rows(3, 2.0, **PANEL))
    x, _, z = simulation.positions().T
    first_row = np.abs(x) < 0.5
    assert simulation.masses().sum() == pytest.approx(
        3 * simulation.masses()[first_row].sum(), rel=0.01
    )
    for offset in (2.0, 4.0):
        assert np.ptp(x[np.abs(x - offset) < 0.5]) == pytest.approx(np.ptp(x[first_row]), abs=0.02)
        face = 0.6 + 0.5 * math.sin(math.radians(40.0))
        assert abs(distance(simulation, (offset, face))[0]) < 1e-6
        assert z[np.abs(x - offset) < 0.5].min() == pytest.approx(z[first_row].min(), abs=0.03)


def test_rows_on_tilted_ground_keep_their_height_above_it():
    simulation = begin_simulation(panel_rows(2, 2.0, ground_tilt=10.0, **PANEL))
    edge = 0.5 * math.cos(math.radians(40.0))
    lower = (2.0 + edge, 0.6 - (2.0 + edge) * math.tan(math.radians(10.0)))
    assert abs(distance(simulation, lower)[0]) < 1e-6


def test_a_table_has_gaps_and_stands_on_its_posts():
    scene = panel_table(2, 0.1, module_length=1.0, height=0.6, tilt=30.0, snow=0.1, dx=0.05)
    simulation = begin_simulation(scene)
    cos, sin = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))

    def point_on_table(along):
        return 0.5 * cos - along * cos, 0.6 + along * sin

    gap, module = distance(simulation, point_on_table(1.05), point_on_table(1.6))
    assert gap == pytest.approx(0.05, abs=1e-6)
    assert abs(module) < 1e-6
    post = point_on_table(0.8 * 2.1)[0]
    assert distance(simulation, (post, 0.3))[0] < 0
    assert simulation.masses().sum() == pytest.approx(2.1 * 0.1 * 210.0, rel=1e-6)


def test_a_guard_holds_what_the_hand_calculation_says(tmp_path):
    """Below the carried length the guard keeps all snow above it; far beyond it, less than half."""
    snow = shed_roof(**ROOF).resolve().data["snow"]
    carried = carried_length(snow, 0.3, 30.0, 0.3, guard_height=0.3)
    assert carried == pytest.approx(3.69, abs=0.01)
    held_share = {}
    for share in (0.75, 1.75):
        length = share * carried
        roof = shed_roof(
            eaves=2.5,
            length=length + 0.4,
            tilt=30.0,
            snow=0.3,
            guards=[0.3],
            guard_height=0.3,
            dx=0.05,
        ).update({"events.max_time": 5.0})
        run_events(roof, tmp_path / f"{share}", pictures=False)
        events = read_events(tmp_path / f"{share}")
        above = 0.3 * length * snow["density"]
        held_share[share] = (events["on_panel_kg"] + events["on_structures_kg"]).iloc[0] / above
    assert held_share[0.75] > 0.98
    assert held_share[1.75] < 0.5


def test_overloaded_guards_are_named():
    with record_notes() as notes:
        shed_roof(
            eaves=2.5, length=6.0, tilt=30.0, snow=0.3, guards=[0.3], guard_height=0.3, dx=0.05
        )
    assert ["5.6 m of slope lie above one guard" in note for note in notes] == [True]
    with record_notes() as notes:
        shed_roof(
            eaves=2.5, length=6.0, tilt=30.0, snow=0.3, guards=[0.3, 3.1], guard_height=0.3, dx=0.05
        )
    assert notes == []


def test_snow_guards_displace_only_their_volume_of_snow():
    open_roof, guarded = (
        begin_simulation(shed_roof(**ROOF)),
        begin_simulation(shed_roof(guards=[0.4], **ROOF)),
    )
    assert distance(guarded, *guarded.positions()[:, [0, 2]]).min() > -1e-3
    missing = open_roof.masses().sum() - guarded.masses().sum()
    assert missing == pytest.approx(0.1 * 0.15 * 210.0, rel=0.1)


def test_a_gable_is_symmetric_about_its_ridge():
    simulation = begin_simulation(gable_roof(**ROOF))
    x, _, z = simulation.positions().T
    ridge = -0.5 * 2.0 * math.cos(math.radians(30.0))
    right = x > ridge
    mass = simulation.masses()
    assert mass[right].sum() == pytest.approx(mass[~right].sum(), rel=0.02)
    assert x.mean() == pytest.approx(ridge, abs=0.02)
    assert z[right].mean() == pytest.approx(z[~right].mean(), abs=0.02)
    eaves = distance(simulation, (ridge, 1.0), (ridge, 2.0 + 1.0 + 0.3))
    assert eaves[0] < 0 < eaves[1]  # the house is under the roof, and nothing is above it


def test_structures_may_be_3d():
    for scene in (
        panel_rows(2, 2.0, width=0.5, **PANEL),
        panel_table(2, 0.1, module_length=1.0, height=0.6, tilt=30.0, snow=0.1, width=0.6, dx=0.05),
        gable_roof(width=1.0, guards=[0.3], **ROOF),
        tracker(axis_height=1.0, length=1.0, snow=0.1, width=0.5, dx=0.05),
    ):
        assert scene.resolve().data["dimension"] == 3


CUBE = """v 0 -1 0
v 2 -1 0
v 2 1 0
v 0 1 0
v 0 -1 1
v 2 -1 1
v 2 1 1
v 0 1 1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""


@pytest.mark.parametrize("dimension", [2, 3])
def test_snow_on_a_mesh_lies_on_top_of_it(tmp_path, dimension):
    (tmp_path / "box.obj").write_text(CUBE)
    scene = mesh_structure(tmp_path / "box.obj", snow=0.2, dx=0.1, dimension=dimension, scale=0.5)
    simulation = begin_simulation(scene)
    assert simulation.masses().sum() == pytest.approx(1.0 * 0.2 * 210.0, rel=0.05)
    x, _, z = simulation.positions().T
    assert z.min() >= 0.5 and z.max() <= 0.7
    assert x.min() >= 0.0 and x.max() <= 1.0


def test_a_tracker_turns_to_its_tilt_and_dumps_its_snow():
    """Friction 0.2 holds the snow at first; the snow slides from about atan(0.2) = 11 degrees."""
    scene = tracker(
        axis_height=0.5, length=0.5, snow=0.1, tilt_to=60.0, seconds=0.6, friction=0.2, dx=0.05,
        settle=0.3,
    )  # fmt: skip
    scene.update({"snow.youngs_modulus": 1e5, "seeding.particles_per_voxel": 4})
    simulation = begin_simulation(scene)
    before = simulation.positions()
    simulation.run(lambda _: True)
    assert simulation.time_s >= 0.6
    tilt = math.radians(60.0)
    on_face = [(s * math.cos(tilt), 0.5 - s * math.sin(tilt)) for s in (-0.2, 0.0, 0.2)]
    np.testing.assert_allclose(distance(simulation, *on_face), 0.0, atol=1e-4)
    after = simulation.positions()
    assert after[:, 2].mean() < before[:, 2].mean() - 0.2
    assert after[:, 0].mean() > 0.1


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: panel_rows(1, 2.0, **PANEL), "count: 1 is not allowed"),
        (lambda: panel_rows(2, 0.5, **PANEL), "pitch: 0.5 m is not allowed; the panels overlap"),
        (
            lambda: panel_table(2, 0.01, module_length=1.0, height=1, tilt=30, snow=0.1, dx=0.02),
            "gap: 0.01 m is less than 2 grid cells of 0.02 m; reduce dx to 0.005 m or less",
        ),
        (
            lambda: panel_table(
                2, 0.0, module_length=1.0, height=0, tilt=5, snow=0.1, dx=0.02, posts=[0.0]
            ),
            "posts: the table is too low for a post at 0 of its length",
        ),
        (lambda: shed_roof(guards=[5.0], **ROOF), "guards: 5 m is outside the allowed range"),
        (lambda: shed_roof(overhang=1.5, **ROOF), "overhang: 1.5 m is outside the allowed range"),
        (
            lambda: tracker(axis_height=0.5, length=3.0, snow=0.1),
            "axis_height: 0.5 m is not allowed; the board reaches the ground below",
        ),
        (lambda: mesh_structure("a.stl", snow=-1.0), "snow: -1 is not allowed"),
    ],
)
def test_impossible_structures_are_refused(build, message):
    with pytest.raises(InputError, match=message):
        build()
