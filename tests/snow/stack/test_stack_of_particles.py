"""Stacks of simulated scenes: below a roof, and on terrain."""

import numpy as np
import pytest

from snowshed import Scene, Simulation
from snowshed.io.raster.raster import Raster
from snowshed.scene.builders.panels import single_panel
from snowshed.scene.builders.roofs import gable_roof
from snowshed.scene.builders.terrain import on_terrain


def test_snow_that_stays_on_a_roof_is_excluded_from_the_stack():
    """The pile is 0.5 m high; with the snow on the house, the stack would be 3.29 m high."""
    roof = gable_roof(eaves=1.0, length=1.0, tilt=30.0, snow=0.2, dx=0.05, friction=2.0)
    simulation = Simulation(roof)
    simulation.begin_event()
    simulation.run(until=0.02)
    stack = simulation.measure()
    assert (stack.height, stack.mass) == (0.0, 0.0)
    assert stack.on_panel_mass + stack.on_structures_mass == pytest.approx(
        simulation.masses().sum()
    )


def test_on_terrain_heights_are_measured_from_the_ground_below(tmp_path):
    hill = Raster(0.35 * np.arange(14.0)[:, None] * np.ones(14), 0.0, 0.0, 1.0)
    panel = single_panel(height=1.0, length=1.0, tilt=45.0, snow=0.1, dx=0.1)
    file = tmp_path / "hill.npy"
    scene = on_terrain(panel, hill, file, origin=(6, 6), azimuth=180, x=(-2, 5))
    scene.append("bodies", {"shape": {"type": "box", "center": [2.0, -0.3], "size": [0.6, 0.3]}})
    simulation = Simulation(Scene.from_data(scene.to_data()))
    simulation.begin_event()
    simulation.run(until=0.5)
    stack = simulation.measure()
    assert 0.0 < stack.height < 0.6
    assert (stack.outline[:, 1] > -0.1).all()
    assert np.allclose(stack.ground, -0.35 * (stack.outline[:, 0] - 0.354), atol=0.03)
