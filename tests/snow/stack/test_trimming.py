import numpy as np
import pytest

from snowshed.snow.stack.trimming import DIVISIONS, circular_order, inliers


def disc(count: int, seed: int = 3) -> np.ndarray:
    random = np.random.default_rng(seed)
    r, angle = np.sqrt(random.uniform(0, 1, count)), random.uniform(0, 2 * np.pi, count)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), 0 * r])


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("count", [1, 10, 33, 34, 100, 1001])
def test_three_percent_are_dropped_and_never_more(dimension, count):
    kept = inliers(disc(count), np.ones(count), dimension)
    assert count - kept.sum() == int(0.03 * count)


def test_3d_drops_stray_grains_in_all_directions():
    strays = 5 * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0.7, 0.7, 0]])
    kept = inliers(np.vstack([disc(995), strays]), np.ones(1000), 3)
    assert not kept[995:].any()


def test_3d_drops_from_the_outside_lap_by_lap():
    heap = disc(10_000)
    heap -= heap.mean(axis=0)
    kept = inliers(heap, np.ones(len(heap)), 3)
    radius = np.hypot(heap[:, 0], heap[:, 1])
    start = np.hypot(np.abs(heap[:, 0]).max(), np.abs(heap[:, 1]).max())
    assert radius[kept].max() - radius[~kept].min() <= 2 * start / DIVISIONS


def test_3d_circles_from_the_x_axis_towards_y():
    angles = np.radians([200, 20, 110, 290, 0])
    x, y = np.cos(angles), np.sin(angles)
    ring = np.arange(5)[np.argsort(angles)]
    order = circular_order(np.append(x, [0.0] * 400), np.append(y, [0.0] * 400), np.ones(405))
    assert order[:5].tolist() == ring.tolist()


def test_2d_steps_inward_from_both_ends_alike():
    x = np.linspace(-1, 1, 1001)
    kept = inliers(np.column_stack([x, 0 * x, 0 * x]), np.ones(1001), 2)
    assert x[kept].min() == -x[kept].max() == pytest.approx(-0.97)


def test_mass_counts_not_number():
    """Three percent of the mass: ten light grains weigh no more than one heavy one."""
    x = np.arange(109.0)
    masses = np.where(x < 10, 0.1, 1.0)
    kept = inliers(np.column_stack([x, 0 * x, 0 * x]), masses, 2)
    assert masses[~kept].sum() <= 3.0
    assert (~kept).sum() > 3  # which is three percent of their number


def test_particles_all_in_one_place():
    assert inliers(np.zeros((50, 3)), np.ones(50), 3).sum() == 49
