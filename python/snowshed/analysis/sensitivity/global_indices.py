"""Global sensitivity indices from designed samples, by SALib (extra ``snowshed[sensitivity]``).

The design is recognised from the points, so that only a store is needed. Sobol indices need
Saltelli's blocks of k + 2 points, elementary effects need Morris's trajectories of k + 1 points. A
block is left out as a whole if one of its runs failed or is not yet computed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.sensitivity.sampling import EXTRA, LEVELS, problem
from snowshed.analysis.sensitivity.stored import TARGETS, StudyRuns
from snowshed.base.arguments import checked
from snowshed.base.arrays import Booleans, Floats
from snowshed.base.callers import argument
from snowshed.base.extras import require
from snowshed.study.factors import SEED

if TYPE_CHECKING:
    import pandas as pd

RESAMPLES = 500  # of the bootstrap
CONFIDENCE = 0.95
RESAMPLING_SEED = 1
MIN_BLOCKS = 2  # blocks
SAME_STEP = 1e-3  # relative difference of equal steps: files hold rounded numbers


@checked
def sobol_indices(stored: StudyRuns) -> pd.DataFrame:
    """Return first-order and total Sobol indices per parameter and event.

    Returns
    -------
    pandas.DataFrame
        ``parameter`` (the seed is one, ``seeding.seed``), ``event``, ``target``, ``first`` and
        ``total`` index, each with the half width of its 95 % bootstrap interval
        (``first_interval``, ``total_interval``), and ``blocks``: how many were complete.

    Raises
    ------
    InputError
        If the points are not Saltelli's design, or fewer than two blocks are complete.
    """
    analyzer = require("SALib.analyze.sobol", EXTRA, "Sobol indices")
    design = _Design.of(stored, 2, _is_saltelli, "a Saltelli sample")

    def analyze(chosen: Booleans, values: Floats) -> dict[str, Floats]:
        if np.ptp(values[chosen]) == 0:  # no variance to share out
            columns = ("first", "first_interval", "total", "total_interval")
            return dict.fromkeys(columns, np.full(len(design.names), np.nan))
        indices = analyzer.analyze(
            problem(design.names),
            values[chosen],
            calc_second_order=False,
            num_resamples=RESAMPLES,
            conf_level=CONFIDENCE,
            seed=RESAMPLING_SEED,
        )
        return {
            "first": indices["S1"],
            "first_interval": indices["S1_conf"],
            "total": indices["ST"],
            "total_interval": indices["ST_conf"],
        }

    return _index_table(stored, design, analyze)


@checked
def morris_effects(stored: StudyRuns) -> pd.DataFrame:
    """Return Morris's elementary effects per parameter and event.

    An effect is the change of the stack, relative to its mean over the sample, over the sampled
    range of the parameter (of its logarithm if only that has equal steps). A seed has no range. Its
    step is set to the mean step of the parameters, so that its strength measures their noise.

    Returns
    -------
    pandas.DataFrame
        ``parameter`` (the seed is one, ``seeding.seed``), ``event``, ``target``; ``effect``, the
        mean (mu); ``strength``, the mean of the absolute values (mu star), with the half width of
        its 95 % bootstrap interval (``strength_interval``); ``spread``, the standard deviation
        (sigma); ``blocks``: how many trajectories were complete.

    Raises
    ------
    InputError
        If the points are not Morris's design, a parameter has steps of different size, or fewer
        than two trajectories are complete.
    """
    analyzer = require("SALib.analyze.morris", EXTRA, "elementary effects")
    design = _Design.of(stored, 1, _is_trajectory, "Morris trajectories")
    unit, steps = _even_steps(design.names, design.points)
    scale = LEVELS / (2 * (LEVELS - 1)) / steps  # SALib assumes the steps of its own levels

    def analyze(chosen: Booleans, values: Floats) -> dict[str, Floats]:
        effects = analyzer.analyze(
            problem(design.names),
            unit[chosen],
            values[chosen] / values[chosen].mean(),
            num_levels=LEVELS,
            num_resamples=RESAMPLES,
            conf_level=CONFIDENCE,
            seed=RESAMPLING_SEED,
        )
        return {
            "effect": effects["mu"] * scale,
            "strength": effects["mu_star"] * scale,
            "strength_interval": effects["mu_star_conf"] * scale,
            "spread": effects["sigma"] * scale,
        }

    return _index_table(stored, design, analyze)


@dataclass(frozen=True)
class _Design:
    """The points of a designed sample, which come in blocks.

    Attributes
    ----------
    names
        Names of the inputs.
    points
        Shape (blocks * size, inputs), in the inputs' units.
    size
        Number of points of a block.
    """

    names: list[str]
    points: Floats
    size: int

    @classmethod
    def of(
        cls, stored: StudyRuns, extra_points: int, is_block: Callable[[Booleans], bool], unit: str
    ) -> _Design:
        """Return the design of a study's points.

        Parameters
        ----------
        stored
            The study.
        extra_points
            Number of points of a block beyond the number of inputs.
        is_block
            Function that returns whether points are a block, from the changes between neighbours.
        unit
            Name of the design, for messages.
        """
        names = list(stored.axes)
        points = stored.points[names].to_numpy(float)
        size = len(names) + extra_points
        _check_blocks(points, size, is_block, unit)
        return cls(names, points, size)


def _index_table(
    stored: StudyRuns,
    design: _Design,
    analyze: Callable[[Booleans, Floats], dict[str, Floats]],
) -> pd.DataFrame:
    """Return the indices of all events and targets.

    Parameters
    ----------
    stored, design
        The study, and its design.
    analyze
        Function of the points that count and of the values at all points; returns columns.
    """
    import pandas as pd

    table_rows: list[dict[str, Any]] = []
    for event, target, values in _values(stored):
        complete = np.isfinite(values.reshape(-1, design.size)).all(axis=1)
        if complete.sum() < MIN_BLOCKS:
            raise InputError(
                f"event {event}: {complete.sum()} of {complete.size} blocks of {design.size} runs "
                f"are complete; at least {MIN_BLOCKS} are needed"
            )
        columns = analyze(np.repeat(complete, design.size), values)
        for number, name in enumerate(design.names):
            row = {"parameter": name, "event": event, "target": target}
            row.update({column: float(values[number]) for column, values in columns.items()})
            table_rows.append({**row, "blocks": int(complete.sum())})
    return pd.DataFrame(table_rows)


def _values(stored: StudyRuns) -> Iterator[tuple[int, str, Floats]]:
    """Yield each event's measures in the order of the points, NaN for missing ones."""
    for event in stored.events:
        rows = stored.rows[stored.rows["event"] == event].set_index("hash")
        for target in TARGETS:
            yield event, target, rows[target].reindex(stored.points["hash"]).to_numpy(float)


def _check_blocks(
    points: Floats, size: int, is_block: Callable[[Booleans], bool], design: str
) -> None:
    """Raise an InputError unless the points consist of such blocks."""
    if len(points) % size or len(points) == 0:
        raise InputError(
            f"its {len(points)} points are not {design}: with {points.shape[1]} inputs, their "
            f"number is a multiple of {size}; see {argument('method')}"
        )
    for start in range(0, len(points), size):
        if not is_block(np.diff(points[start : start + size], axis=0) != 0):
            raise InputError(f"points {start + 1} to {start + size} are not {design}")


def _is_trajectory(changes: Booleans) -> bool:
    """Return whether every step changes one input, and every input is changed once."""
    return bool((changes.sum(axis=0) == 1).all() and (changes.sum(axis=1) == 1).all())


def _even_steps(names: Sequence[str], points: Floats) -> tuple[Floats, Floats]:
    """Return the points in the unit cube, and the size of each input's step there.

    Each input is taken linearly or by its logarithm, whichever makes all its steps equal. Seeds
    only need to differ.
    """
    unit, steps = np.empty_like(points), np.full(len(names), np.nan)
    for number, name in enumerate(names):
        values = points[:, number].reshape(-1, len(names) + 1)
        if name == SEED:
            unit[:, number] = (values != values[:, :1]).ravel()
            continue
        for scaled in [values, np.log(values)] if (values > 0).all() else [values]:
            scaled = _in_unit_cube(scaled)
            sizes = np.abs(np.diff(scaled, axis=1)).max(axis=1)
            if np.ptp(sizes) <= SAME_STEP * sizes.max():
                break
        else:
            raise InputError(f"{name}: its steps differ; those of Morris trajectories are equal")
        unit[:, number], steps[number] = scaled.ravel(), sizes.mean()
    seeds = np.isnan(steps)
    steps[seeds] = 1.0 if seeds.all() else steps[~seeds].mean()
    return unit, steps


def _is_saltelli(changes: Booleans) -> bool:
    """Return whether A is followed by A with each input of B in turn, and by B.

    The first input changes from A to the first point, two neighbours change from each point to the
    next, and all inputs except the last change from the last point to B.
    """
    count = changes.shape[1]
    identity = np.eye(count, dtype=bool)
    expected = np.vstack([identity[:1], identity[:-1] | identity[1:], ~identity[-1:]])
    return bool((changes == expected).all())


def _in_unit_cube(values: Floats) -> Floats:
    low, high = values.min(), values.max()
    return np.asarray((values - low) / (high - low if high > low else 1.0))
