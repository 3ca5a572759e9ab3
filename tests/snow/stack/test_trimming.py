import numpy as np
import pytest

from snowshed import InputError
from snowshed.snow.stack.trimming import DIVISIONS, TRIMMINGS, circular_order, inliers


def disc(count: int, seed: int = 3) -> np.ndarray:
    random = np.random.default_rng(seed)
    r, angle = np.sqrt(random.uniform(0, 1, count)), random.uniform(0, 2 * np.pi, count)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), 0 * r])


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("count", [1, 10, 33, 34, 100, 1001])
def test_at_most_three_percent_are_dropped(dimension, count):
    inside = inliers(disc(count), np.ones(count), dimension)
    assert count - inside.sum() == int(0.03 * count)


def test_3d_drops_stray_grains_in_all_directions():
    strays = 5 * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0.7, 0.7, 0]])
    inside = inliers(np.vstack([disc(995), strays]), np.ones(1000), 3)
    assert not inside[995:].any()


def test_3d_drops_from_the_outside_lap_by_lap():
    heap = disc(10_000)
    heap -= heap.mean(axis=0)
    inside = inliers(heap, np.ones(len(heap)), 3)
    radius = np.hypot(heap[:, 0], heap[:, 1])
    start = np.hypot(np.abs(heap[:, 0]).max(), np.abs(heap[:, 1]).max())
    assert radius[inside].max() - radius[~inside].min() <= 2 * start / DIVISIONS


def test_3d_circles_from_the_x_axis_towards_y():
    angles = np.radians([200, 20, 110, 290, 0])
    x, y = np.cos(angles), np.sin(angles)
    ring = np.arange(5)[np.argsort(angles)]
    order = circular_order(np.append(x, [0.0] * 400), np.append(y, [0.0] * 400), np.ones(405))
    assert order[:5].tolist() == ring.tolist()


def inliers_2d(x, trimming, masses=None):
    x = np.asarray(x, float)
    masses = np.ones(len(x)) if masses is None else masses
    return inliers(np.column_stack([x, 0 * x, 0 * x]), masses, 2, trimming)


@pytest.mark.parametrize("trimming", TRIMMINGS)
def test_2d_takes_from_both_ends_of_a_symmetric_stack_alike(trimming):
    x = np.linspace(-1, 1, 1001)
    inside = inliers_2d(x, trimming)
    assert x[inside].min() == -x[inside].max() == pytest.approx(-0.97)


def test_the_rules_differ_for_a_chunk_that_rolled_far_off():
    """`outermost_first` drops the far chunk at once, `equal_pace` also snow of the stack."""
    stack, chunk = np.linspace(0, 1, 980), np.linspace(8.9, 9.0, 20)
    outermost, equal = (inliers_2d([*stack, *chunk], name) for name in TRIMMINGS)
    # Dropped: the chunk, and ten particles at the end that is farther from the centre, x = 0.67.
    assert np.flatnonzero(~outermost).tolist() == [*range(10), *range(980, 1000)]
    # Both ends are 2.5 cm inward when 30 particles are dropped: 25 of the stack, 5 of the chunk.
    assert np.flatnonzero(~equal).tolist() == [*range(25), *range(995, 1000)]


def test_outermost_first_measures_from_the_centre_of_mass():
    x = np.concatenate([np.zeros(95), np.linspace(1, 2, 5)])
    inside = inliers_2d(x, "outermost_first")
    assert np.flatnonzero(~inside).tolist() == [97, 98, 99]
    heavy = np.concatenate([np.full(95, 0.01), np.full(5, 10.0)])  # now the dense end is far
    assert not inliers_2d(x, "outermost_first", heavy)[:95].any()


def test_an_unknown_rule_is_refused():
    with pytest.raises(InputError, match=r"trimming: 'both'.*: outermost_first, equal_pace"):
        inliers_2d([0.0, 1.0], "both")


def test_the_share_is_by_mass_not_by_number():
    """Three percent of the mass are dropped; ten light grains have the mass of a heavy one."""
    x = np.arange(109.0)
    masses = np.where(x < 10, 0.1, 1.0)
    inside = inliers(np.column_stack([x, 0 * x, 0 * x]), masses, 2)
    assert masses[~inside].sum() <= 3.0
    assert (~inside).sum() > 3  # three percent of the number


def test_particles_at_a_single_point_are_trimmed():
    assert inliers(np.zeros((50, 3)), np.ones(50), 3).sum() == 49
