"""Slabs on an incline: Coulomb's law, its coarse solutions, and their measurements."""

from types import SimpleNamespace

import numpy as np
import pytest
from validation.incline import case as incline
from validation.incline.case import ANGLE, CASES, DEFAULTS, SLAB, Incline

COARSE = {**DEFAULTS, "dx": 0.025, "length": 0.5, "speed": 0.0}


def measured(outcome):
    return {result.quantity: result for result in outcome.measured}


@pytest.mark.parametrize("dimension", [2, 3])
def test_directions_of_the_plane_are_orthonormal(dimension):
    plane = Incline(30.0, dimension)
    slope, normal = np.array(plane.slope), np.array(plane.normal)
    assert len(slope) == dimension
    assert slope @ normal == pytest.approx(0)
    assert slope @ slope == pytest.approx(1)
    assert slope[0] > 0 > slope[-1]  # down is towards +x
    assert plane.along[[0, 2]].tolist() == slope[[0, -1]].tolist()


def test_the_acceleration_of_coulombs_law():
    assert Incline(90.0, 2).coulomb(0.5) == pytest.approx(9.81)
    assert Incline(0.0, 2).coulomb(0.5) == pytest.approx(-0.5 * 9.81)
    assert Incline(35.0, 2).coulomb(np.tan(np.radians(35))) == pytest.approx(0)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_every_entry_makes_a_scene(case):
    for settings in [*case.matrix(False), *case.matrix(True)]:
        data = incline.slab_scene(settings, 40.0).resolve().data
        assert data["numerics"]["dx"] == settings["dx"]
        assert data["obstacles"][0]["friction"] == settings["friction"]
        assert data["numerics"]["threads"] == 1


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
@pytest.mark.parametrize("full", [False, True])
def test_matrices_list_no_entry_twice(case, full):
    entries = [tuple(sorted(entry.items())) for entry in case.matrix(full)]
    assert len(set(entries)) == len(entries)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_slab_lies_on_the_plane(dimension):
    settings = {**COARSE, "friction": 0.3, "dimension": dimension, "speed": 2.0}
    drive = incline.TimedEventDriver(incline.slab_scene(settings, 25.0))
    plane = Incline(25.0, dimension)
    normal = np.array([plane.normal[0], 0.0, plane.normal[-1]])
    heights = drive.core.positions() @ normal
    assert 0 < heights.min() < 0.25 * heights.max()
    assert heights.max() < incline.THICKNESS
    assert np.allclose(drive.core.velocities(), 2.0 * plane.along)


@pytest.mark.parametrize("friction", [0.0, 0.6])
def test_sliding_slabs_follow_coulombs_law(friction):
    results = measured(SLAB.measure({**COARSE, "friction": friction}))
    assert abs(results["acceleration"].error) < 0.01
    assert ("effective_friction" in results) == (friction > 0)
    for result in results.values():
        assert result.error == pytest.approx(result.value / result.exact - 1)


def test_a_wrong_friction_is_detected():
    """The measured friction follows from the acceleration, not from the settings."""
    sliding = incline.Sliding({**COARSE, "friction": 0.5}, incline.TILT)
    results = {result.quantity: result for result in incline._slide(sliding, 0.4)}
    assert results["effective_friction"].value == pytest.approx(0.5, rel=0.01)
    assert results["effective_friction"].error == pytest.approx(0.25, rel=0.05)


def test_friction_holds_a_slab_at_rest():
    (creep,) = SLAB.measure({**COARSE, "friction": 0.95}).measured
    assert creep.quantity == "creep"
    assert abs(creep.error) < 1e-3


def test_a_thrown_slab_stops_at_the_expected_distance():
    settings = {**COARSE, "model": "elastic", "friction": 1.2, "speed": 1.0}
    results = measured(SLAB.measure(settings))
    assert abs(results["stopping_distance"].error) < 0.01
    assert abs(results["creep"].value) < 1e-3


def test_the_angle_is_found_by_bisection(monkeypatch):
    """Bisection is exact to its width if slabs slide exactly by Coulomb's law."""

    core = SimpleNamespace(particle_updates=6, total_steps=3, particle_count=2)

    class Block:
        drive = SimpleNamespace(core=core, wall_s=0.5)

        def __init__(self, settings, tilt):
            self.exact = Incline(tilt, 2).coulomb(settings["friction"])

        def acceleration(self, begin, end):
            return max(self.exact, 0.0)

    monkeypatch.setattr(incline, "Sliding", Block)
    outcome = ANGLE.measure({**COARSE, "friction": 0.7})
    (angle,) = outcome.measured
    assert angle.exact == pytest.approx(np.degrees(np.arctan(0.7)))
    assert abs(angle.error) < incline.ANGLE_TOLERANCE
    count = outcome.wall_s / 0.5
    assert (outcome.updates, outcome.steps) == (6 * count, 3 * count)


def test_the_angle_of_a_coarse_slab_is_accurate():
    (angle,) = ANGLE.measure({**COARSE, "length": 0.25, "friction": 0.6}).measured
    assert abs(angle.error) < 0.1
