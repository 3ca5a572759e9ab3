import numpy as np

from snowshed.snow.stack.surface import outline_particles, surface_particles


def test_the_surface_has_the_highest_particle_of_each_cell():
    random = np.random.default_rng(1)
    heap = random.uniform(0, 1, (50_000, 3))
    top = surface_particles(heap)
    cells = np.minimum(np.floor(30 * heap[:, :2]), 29)
    assert len(top) == 900
    for i in top[::100]:
        same = (cells == cells[i]).all(axis=1)
        assert heap[i, 2] == heap[same, 2].max()


def test_cells_span_the_range_of_the_snow():
    heap = np.array([[5.0, 1, 0], [5.0, 2, 0], [8.0, 1, 0], [8.0, 2, 0]])
    assert sorted(surface_particles(heap)) == [0, 1, 2, 3]


def test_plane_snow_has_thirty_columns():
    random = np.random.default_rng(2)
    heap = random.uniform(0, 1, (5_000, 3)) * [1, 0, 1]
    assert len(surface_particles(heap)) == 30


def test_outline_follows_the_surface():
    random = np.random.default_rng(3)
    x, z = random.uniform(0, 3, 60_000), random.uniform(0, 1, 60_000)
    surface = 1 + 0.5 * np.sin(2 * x)
    heap = np.column_stack([x, 0 * x, z * surface])
    profile = heap[outline_particles(heap)][:, [0, 2]]
    assert (np.diff(profile[:, 0]) > 0).all()
    assert np.abs(profile[:, 1] - 1 - 0.5 * np.sin(2 * profile[:, 0])).max() < 0.03


def test_without_snow_the_surface_is_empty():
    empty = np.zeros((0, 3))
    assert len(surface_particles(empty)) == len(outline_particles(empty)) == 0
