"""Samples for global sensitivity indices, by SALib (extra ``snowshed[sensitivity]``).

The seed of the particles' placement is one of the inputs. Another seed gives another stack, because
the motion is chaotic. The effect of the seed alone is the noise that any other effect must exceed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.sensitivity.parameter_values import HARDENING, VALUES
from snowshed.base.arrays import Floats
from snowshed.base.extras import require
from snowshed.study.factors import SEED, Span

EXTRA = "sensitivity"
LEVELS = 4  # of Morris's grid
SAMPLE_SEED = 1  # seed of the samples, so that they are reproducible
#: Ranges of Table 3.2.1; the hardening factor spans a decade, and so is sampled by its logarithm.
SPANS: Mapping[str, Span] = {
    path: Span(min(values), max(values), "log" if path == HARDENING else "linear")
    for path, values in VALUES.items()
}

Columns = dict[str, list[float]]


def problem(names: list[str]) -> dict[str, Any]:
    """Return the inputs in the unit cube as a problem of SALib."""
    return {"num_vars": len(names), "names": names, "bounds": [[0.0, 1.0]] * len(names)}


def sobol_points(count: int) -> Columns:
    """Return points for first-order and total Sobol indices, after Saltelli.

    For k inputs (with the seed) a block has k + 2 points: a point A; then A with each input in turn
    replaced by that of a second point B; then B.

    Parameters
    ----------
    count
        Number of blocks, a power of two, for which Sobol's sequence is balanced.

    Examples
    --------
    >>> points = sobol_points(2)
    >>> {path: len(values) for path, values in points.items()}["snow.cohesion"]
    16
    >>> points["seeding.seed"]
    [1, 1, 1, 1, 1, 1, 2, 2, 3, 3, 3, 3, 3, 3, 4, 4]
    """
    if count < 1 or count & (count - 1):
        raise InputError(f"samples: {count} is not a power of two, which Sobol's sequence needs")
    sampler = require("SALib.sample.sobol", EXTRA, "sampling for Sobol indices")
    names = [*SPANS, SEED]
    cube = sampler.sample(problem(names), count, calc_second_order=False, seed=SAMPLE_SEED)
    return _columns(cube, len(names) + 2)


def morris_points(count: int) -> Columns:
    """Return trajectories for elementary effects, after Morris.

    For k inputs (with the seed) a trajectory has k + 1 points. From one point to the next, one
    input changes by two thirds of its range.

    Parameters
    ----------
    count
        Trajectories.

    Examples
    --------
    >>> points = morris_points(3)
    >>> len(points["seeding.seed"]), sorted(set(points["seeding.seed"]))
    (21, [1, 2, 3, 4, 5, 6])
    """
    sampler = require("SALib.sample.morris", EXTRA, "sampling for elementary effects")
    names = [*SPANS, SEED]
    cube = sampler.sample(problem(names), count, num_levels=LEVELS, seed=SAMPLE_SEED)
    return _columns(cube, len(names) + 1)


SAMPLERS: Mapping[str, Callable[[int], Columns]] = {
    "sobol": sobol_points,
    "morris": morris_points,
}


def _columns(cube: Floats, block: int) -> Columns:
    """Return points of the unit cube as values of the inputs."""
    columns: Columns = {
        path: [span.at(float(fraction)) for fraction in cube[:, number]]
        for number, (path, span) in enumerate(SPANS.items())
    }
    columns[SEED] = _seeds(cube[:, -1], block)
    return columns


def _seeds(fractions: Floats, block: int) -> list[float]:
    """Return the seed of each point: one of two seeds of its block, which starts with the first.

    No two blocks have a seed in common, so that no point of the design occurs twice.
    """
    blocks = fractions.reshape(-1, block)
    first = 2 * np.arange(len(blocks))[:, None] + 1
    seeds = first + (blocks != blocks[:, :1])
    return [int(seed) for seed in seeds.ravel()]
