"""A stack is the snow that rests on the ground below."""

import numpy as np
import pytest
from helpers.piles import ball, triangle

from snowshed import measure_stack

DX = 0.02


def measure(*clouds, **flags):
    snow = np.vstack(clouds)
    ones = np.ones(len(snow))
    marked = {
        name: np.concatenate([np.full(len(cloud), i in numbers) for i, cloud in enumerate(clouds)])
        for name, numbers in flags.items()
    }
    return measure_stack(snow, 1e-3 * ones, 200 * ones, dimension=2, dx=DX, **marked)


PILE = triangle(1.0, 0.3)


def test_snow_that_hangs_over_the_edge_belongs_to_the_panel():
    held, hanging = ball((-1.0, 0, 1.0), 0.1, 500), ball((-0.9, 0, 0.98), 0.05, 200)
    stack = measure(PILE, held, hanging, exclude=[1])
    assert stack.height == measure(PILE).height
    assert stack.on_panel_mass == pytest.approx(0.7)
    assert stack.members.sum() == len(PILE) and not stack.joined


def test_snow_on_a_roof_is_excluded_and_snow_against_a_wall_counts():
    roof = ball((3.0, 0, 2.0), 0.1, 300)
    stack = measure(PILE, roof, structures=[1])
    assert (stack.height, stack.on_structures_mass) == (measure(PILE).height, pytest.approx(0.3))
    leaning = measure(PILE, structures=[0])
    assert (leaning.mass, leaning.on_structures_mass) == (measure(PILE).mass, 0.0)


def test_a_grain_in_the_air_does_not_raise_the_stack():
    stack = measure(PILE, ball((0.0, 0, 0.6), 0.01, 3))
    assert stack.height == measure(PILE).height
    assert stack.mass == pytest.approx(measure(PILE).mass + 0.003)  # it is off the panel
    assert stack.detached_mass == pytest.approx(0.003)


def test_a_slab_across_the_edge_joins_the_stack_to_the_snow_on_the_panel():
    bridge = np.column_stack([np.linspace(0, 0.5, 200), np.zeros(200), np.linspace(0.28, 0.6, 200)])
    stack = measure(PILE, bridge, ball((0.52, 0, 0.61), 0.05, 300), exclude=[2])
    assert stack.joined
    assert stack.height > 0.5  # the pile supports it on the ground


def test_heights_are_measured_above_the_ground():
    hill = 0.4 * PILE[:, 0]
    raised = PILE + np.column_stack([0 * hill, 0 * hill, hill - 2.0])
    ones = np.ones(len(PILE))
    on_hill = measure_stack(raised, ones, 200 * ones, dimension=2, dx=DX, ground=hill - 2.0)
    assert on_hill.height == pytest.approx(measure(PILE).height)
    assert np.allclose(on_hill.ground, 0.4 * on_hill.outline[:, 0] - 2.0)
