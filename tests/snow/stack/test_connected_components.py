import numpy as np
import pytest

from snowshed.snow.stack.connected_components import connected_bodies, largest_body


def row(*x: float) -> np.ndarray:
    return np.column_stack([x, np.zeros(len(x)), np.zeros(len(x))])


@pytest.mark.parametrize("shift", np.linspace(0, 0.01, 5))
def test_particles_closer_than_a_cell_are_linked_at_any_grid_offset(shift):
    labels = connected_bodies(row(-0.013 - shift, 0.0, 0.0099), 0.01)
    assert labels[1] == labels[2]


@pytest.mark.parametrize("direction", np.eye(3))
def test_gaps_wider_than_two_cells_separate_bodies(direction):
    labels = connected_bodies(np.outer([0, 0.0201], direction), 0.01)
    assert labels[0] != labels[1]


def test_links_reach_along_a_winding_body():
    t = np.linspace(0, 6 * np.pi, 3000)
    spiral = np.column_stack([t * np.cos(t), t * np.sin(t), 0.3 * t]) * 0.05
    random = np.random.default_rng(4).permutation(len(t))
    assert len(np.unique(connected_bodies(spiral[random], 0.012))) == 1


def test_neighbours_across_a_diagonal_are_linked():
    assert len(np.unique(connected_bodies(np.array([[0.0, 0, 0], [0.9, 0.9, 0.9]]), 0.5))) == 1


def test_rows_of_voxels_do_not_touch_end_to_start():
    """The last voxel of a row is not a neighbour of the first voxel in the next row."""
    corners = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    assert len(np.unique(connected_bodies(corners * [0.1, 0.5, 0.5], 0.1))) == 4


def test_components_agree_with_a_plain_search():
    random = np.random.default_rng(5)
    points = random.uniform(0, 1, (150, 3))
    voxel = np.floor((points - points.min(axis=0)) / 0.11).astype(int)
    near = (np.abs(voxel[:, None] - voxel[None]) <= 1).all(axis=2)
    while not np.array_equal(near, near @ near):
        near = near @ near
    labels = connected_bodies(points, 0.11)
    assert np.array_equal(labels[:, None] == labels[None], near)
    assert len(np.unique(labels)) > 1


def test_the_largest_body_has_the_most_mass():
    points = row(0, 0.01, 0.02, 5)
    assert largest_body(points, np.array([1, 1, 1, 1.0]), 0.01).tolist() == [True] * 3 + [False]
    assert largest_body(points, np.array([1, 1, 1, 9.0]), 0.01).tolist() == [False] * 3 + [True]
