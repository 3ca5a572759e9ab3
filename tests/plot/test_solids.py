"""The solids of a scene in pictures: their outlines are those of the scene."""

import numpy as np
import pytest

from snowshed import Scene, _core
from snowshed.plot.solids import Box, scene_solids
from snowshed.scene import Ground, Obstacle, Panel, Shape, Slab, gable_roof

AROUND = Box(np.array([-4.0, 0.0, 0.0]), np.array([4.0, 0.0, 5.0]))


def area(solid):
    """Return the area of a flat solid, m2."""
    first, second, third = (solid.corners[solid.triangles[:, k]][:, [0, 2]] for k in range(3))
    (a, b), (c, d) = (second - first).T, (third - first).T
    return 0.5 * np.abs(a * d - b * c).sum()


def test_a_house_has_straight_walls_and_guards():
    """Its width at the walls and its height at the ridge, by hand."""
    roof = gable_roof(eaves=2.5, length=3.0, tilt=40.0, snow=0.25, guards=[0.4], dx=0.05)
    solids, _ = scene_solids(roof.resolve(), AROUND, None)
    named = {solid.name: solid for solid in solids}
    assert {"house", "far-slope", "guard-1", "far-guard-1"} <= named.keys()
    house = named["house"].corners
    low = house[np.abs(house[:, 2]) < 0.05, 0]
    width = 2.0 * (3.0 - 0.3) * np.cos(np.radians(40.0))
    assert np.ptp(low) == pytest.approx(width, abs=0.03)
    ridge = 2.5 + 3.0 * np.sin(np.radians(40.0)) - 0.075 / np.cos(np.radians(40.0))
    assert house[:, 2].max() == pytest.approx(ridge, abs=0.03)
    assert area(named["guard-1"]) == pytest.approx(2 * 0.1 * 0.2)  # front and back


def test_a_moved_sampled_shape_is_drawn_where_snow_meets_it():
    """The shape lies far from the snow before it is moved beside the panel."""
    hollow = Shape.difference(
        Shape.box([10.0, 0.5], [0.4, 1.0]), Shape.box([10.0, 0.5], [0.2, 0.2])
    )
    wall = Shape.transform(hollow, angle=90.0, translate=[1.5, 10.5])
    scene = Scene(
        dimension=2, ground=Ground(), slab=Slab(thickness=0.1), panel=Panel(height=1.0, length=1.0),
        obstacles=[Obstacle(name="wall", shape=wall, condition="separate")],
    ).resolve()  # fmt: skip
    solids, _ = scene_solids(scene, AROUND, None)
    corners = next(solid.corners for solid in solids if solid.name == "wall")
    simulation = _core.Simulation(scene.core, scene.base_dir)
    assert len(corners) > 50
    assert np.abs(simulation.obstacle_distance(corners)).max() < 0.03


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_turned_and_moved_box_is_drawn_where_the_core_has_it(dimension):
    size, shift = ([1.0, 0.2], [2.0, 1.0]) if dimension == 2 else ([1.0, 0.4, 0.2], [2.0, 0.0, 1.0])
    box = Shape.transform(Shape.box([0.0] * dimension, size), angle=30.0, translate=shift,
                          axis=None if dimension == 2 else (0.0, 1.0, 0.0))  # fmt: skip
    scene = Scene(
        dimension=dimension, ground=Ground(), slab=Slab(thickness=0.1),
        panel=Panel(height=1.0, length=1.0, width=1.0 if dimension == 3 else None),
        obstacles=[Obstacle(name="box", shape=box, condition="separate")],
    ).resolve()  # fmt: skip
    solids, _ = scene_solids(scene, AROUND, None)
    corners = next(solid.corners for solid in solids if solid.name == "box")
    simulation = _core.Simulation(scene.core, scene.base_dir)
    assert np.abs(simulation.obstacle_distance(corners)).max() < 1e-6
