"""The stress on snow and its settling, against closed forms."""

import numpy as np
import pytest

from snowshed import InputError
from snowshed.running.ageing.columns import SnowColumns

DX, DENSITY = 0.05, 200.0


def block(low, high, dimension, per_cell=4):
    """Particles on a lattice that fills a box of snow, and their masses."""
    step = DX / per_cell
    axes = [
        np.arange(a + step / 2, b, step) if d != 1 or dimension == 3 else np.zeros(1)
        for d, (a, b) in enumerate(zip(low, high))
    ]
    positions = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
    return positions, np.full(len(positions), DENSITY * step**dimension)


def columns_of(positions, masses, dimension):
    return SnowColumns(positions, masses, np.full(len(masses), DENSITY), dimension, DX)


def interior(positions, length):
    return np.abs(positions[:, 0]) < 0.5 * length - 2 * DX


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_stress_below_a_block_is_its_weight(dimension):
    positions, masses = block((-0.4, -0.4, 0.0), (0.4, 0.4, 1.0), dimension)
    columns = columns_of(positions, masses, dimension)
    stress = columns.at_particles(columns.stresses(9.81))
    inner = interior(positions, 0.8) & (np.abs(positions[:, 1]) < 0.3)
    expected = DENSITY * 9.81 * (1.0 - positions[:, 2])
    deep = inner & (positions[:, 2] > DX)  # the lowest node has half a cell of snow
    assert np.abs(stress - expected)[deep].max() < 0.5 * DENSITY * 9.81 * DX


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_that_shortens_everywhere_sinks_in_proportion(dimension):
    positions, masses = block((-0.4, -0.4, 0.0), (0.4, 0.4, 1.0), dimension)
    columns = columns_of(positions, masses, dimension)
    drops = columns.drops(np.full_like(columns.masses, np.log(1.25)))
    expected = 0.2 * positions[:, 2]  # also along the walls
    assert np.abs(drops - expected).max() < 0.2 * DX
    assert (drops >= 0).all()


def test_snow_beyond_a_gap_neither_presses_nor_sinks():
    below, below_masses = block((-0.4, 0, 0.0), (0.4, 0, 0.5), 2)
    above, above_masses = block((-0.4, 0, 0.8), (0.4, 0, 1.0), 2)
    alone = columns_of(below, below_masses, 2)
    both = columns_of(np.append(below, above, axis=0), np.append(below_masses, above_masses), 2)
    strains = np.full_like(both.masses, 0.1)
    drops = both.drops(strains)
    assert drops[len(below) :].max() < 0.2 * (1 - np.exp(-0.1)) + 1e-9
    stress = both.at_particles(both.stresses(9.81))[: len(below)]
    assert stress == pytest.approx(alone.at_particles(alone.stresses(9.81)))


def test_without_snow_drops_are_empty():
    columns = columns_of(np.zeros((0, 3)), np.zeros(0), 2)
    assert columns.drops(np.zeros_like(columns.masses)).shape == (0,)


def test_snow_spread_too_far_is_refused():
    positions = np.array([[0.0, 0.0, 0.0], [1e4, 1e4, 1e3]])
    with pytest.raises(InputError, match=r"more than 1\.5e\+08 cells of 0\.05 m"):
        columns_of(positions, np.ones(2), 3)
