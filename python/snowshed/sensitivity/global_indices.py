"""Global sensitivity indices from designed samples, by SALib (extra ``snowshed[sensitivity]``).

The design is read off the points themselves, so that a store is all that is needed: Saltelli's
blocks of k + 2 points for Sobol indices, Morris's trajectories of k + 1 points for elementary
effects. A block with runs that failed or are not yet computed is left out as a whole.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed._core import InputError
from snowshed.arrays import Booleans, Floats
from snowshed.extras import require
from snowshed.sensitivity.sampling import EXTRA, LEVELS, problem
from snowshed.sensitivity.stored import TARGETS, StoredRuns

if TYPE_CHECKING:
    import pandas as pd

RESAMPLES = 500  # of the bootstrap
CONFIDENCE = 0.95
RANDOM = 1
FEWEST = 2  # blocks


def sobol_indices(stored: StoredRuns) -> pd.DataFrame:
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
        If the points are no such design, or fewer than two blocks are complete.
    """
    analyzer = require("SALib.analyze.sobol", EXTRA, "Sobol indices")

    def analyze(names: list[str], _: Floats, values: Floats) -> dict[str, Floats]:
        if np.ptp(values) == 0:  # no variance to share out
            columns = ("first", "first_interval", "total", "total_interval")
            return dict.fromkeys(columns, np.full(len(names), np.nan))
        found = analyzer.analyze(
            problem(names),
            values,
            calc_second_order=False,
            num_resamples=RESAMPLES,
            conf_level=CONFIDENCE,
            seed=RANDOM,
        )
        return {
            "first": found["S1"],
            "first_interval": found["S1_conf"],
            "total": found["ST"],
            "total_interval": found["ST_conf"],
        }

    return _analyzed(stored, 2, _is_saltelli, "a sample after Saltelli", analyze)


def morris_effects(stored: StoredRuns) -> pd.DataFrame:
    """Return elementary effects after Morris per parameter and event.

    An effect is the change of the stack, relative to its mean over the sample, per range of the
    parameter.

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
        If the points are no such design, or fewer than two trajectories are complete.
    """
    analyzer = require("SALib.analyze.morris", EXTRA, "elementary effects")

    def analyze(names: list[str], points: Floats, values: Floats) -> dict[str, Floats]:
        found = analyzer.analyze(
            problem(names),
            points,
            values / values.mean(),
            num_levels=LEVELS,
            num_resamples=RESAMPLES,
            conf_level=CONFIDENCE,
            seed=RANDOM,
        )
        return {
            "effect": found["mu"],
            "strength": found["mu_star"],
            "strength_interval": found["mu_star_conf"],
            "spread": found["sigma"],
        }

    return _analyzed(stored, 1, _is_trajectory, "trajectories after Morris", analyze)


def _analyzed(
    stored: StoredRuns,
    more: int,
    is_block: Callable[[Booleans], bool],
    design: str,
    analyze: Callable[[list[str], Floats, Floats], dict[str, Floats]],
) -> pd.DataFrame:
    """Return indices of all events and targets.

    Parameters
    ----------
    stored
        The study.
    more
        How many points a block has more than inputs.
    is_block
        Whether the changes from each point to the next make a block.
    design
        What the points should be, for messages.
    analyze
        Returns columns for the inputs' names, points in the unit cube, and values.
    """
    import pandas as pd

    names = list(stored.axes)
    points = stored.points[names].to_numpy(float)
    size = len(names) + more
    blocks = _blocks(points, size, is_block, design)
    unit = _in_unit_cube(points)
    found: list[dict[str, Any]] = []
    for event, target, values in _values(stored):
        complete = np.isfinite(values.reshape(-1, size)).all(axis=1)
        if complete.sum() < FEWEST:
            raise InputError(
                f"event {event}: {complete.sum()} of {blocks} blocks of {size} runs are complete; "
                f"at least {FEWEST} are needed"
            )
        chosen = np.repeat(complete, size)
        columns = analyze(names, unit[chosen], values[chosen])
        for number, name in enumerate(names):
            row = {"parameter": name, "event": event, "target": target}
            row.update({column: float(of[number]) for column, of in columns.items()})
            found.append({**row, "blocks": int(complete.sum())})
    return pd.DataFrame(found)


def _values(stored: StoredRuns) -> Iterator[tuple[int, str, Floats]]:
    """Yield each event's measures in the order of the points, NaN where there is none."""
    for event in stored.events:
        rows = stored.rows[stored.rows["event"] == event].set_index("hash")
        for target in TARGETS:
            yield event, target, rows[target].reindex(stored.points["hash"]).to_numpy(float)


def _blocks(points: Floats, size: int, is_block: Callable[[Booleans], bool], design: str) -> int:
    """Return the number of blocks, all of which are checked."""
    if len(points) % size or len(points) == 0:
        raise InputError(
            f"its {len(points)} points are not {design}: for {size - 1} or fewer inputs these come "
            f"in blocks of {size}; see `snowshed sensitivity --method`"
        )
    for start in range(0, len(points), size):
        if not is_block(np.diff(points[start : start + size], axis=0) != 0):
            raise InputError(f"points {start + 1} to {start + size} are not {design}")
    return len(points) // size


def _is_trajectory(changes: Booleans) -> bool:
    """Whether every step changes one input, and every input is changed once."""
    return bool((changes.sum(axis=0) == 1).all() and (changes.sum(axis=1) == 1).all())


def _is_saltelli(changes: Booleans) -> bool:
    """Whether A is followed by A with each input of B in turn, and by B.

    From A to the first of them the first input changes, from one to the next two neighbours, and
    from the last one to B all but the last.
    """
    count = changes.shape[1]
    one = np.eye(count, dtype=bool)
    expected = np.vstack([one[:1], one[:-1] | one[1:], ~one[-1:]])
    return bool((changes == expected).all())


def _in_unit_cube(points: Floats) -> Floats:
    low, high = points.min(axis=0), points.max(axis=0)
    return np.asarray((points - low) / np.where(high > low, high - low, 1.0))
