"""Stress runs in separate processes, so that crashes and hangs are recorded."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import NamedTuple

from snowshed.base.pool.pool import Isolation, Pool, TaskEnd
from validation.stress.solve import Record, solve
from validation.stress.space import Point

LIMIT_S = 60.0  # time limit of a run, s


class ProcessRun(NamedTuple):
    """A run of the suite: the parameters of its scene, and its time steps."""

    point: Point
    steps: int


def stress_pool(limit_s: float = LIMIT_S) -> Pool[ProcessRun, Record]:
    """Return a pool that computes runs one after another, each within a time limit `limit_s`.

    Examples
    --------
    >>> from validation.stress.space import reference
    >>> with stress_pool() as pool:
    ...     record(pool, ProcessRun(reference(), 20))["ended"]
    'time_limit'
    """
    return Pool(1, compute, Isolation(limit_s=limit_s, environment={"OMP_NUM_THREADS": "1"}))


def record(pool: Pool[ProcessRun, Record], run: ProcessRun) -> Record:
    """Return the record of a run; ``ended`` is "crashed", "hung" or "raised" after such an end.

    "raised" stands for an exception that is neither `InputError` nor `SimulationError`.
    """
    pool.submit(run)
    while not (results := pool.collect(LIMIT_S)):
        pass
    return _record(results[0])


def compute(run: ProcessRun, report: Callable[[float], None]) -> Record:
    """Compute a run in this process."""
    try:
        return solve(run.point, run.steps)
    except Exception:
        # Every exception is a result of the suite.
        return {"ended": "raised", "message": traceback.format_exc(limit=-3)}


def _record(ended: TaskEnd[ProcessRun, Record]) -> Record:
    if ended.result is not None:
        return ended.result
    if ended.error is not None:
        return {"ended": "raised", "message": f"{type(ended.error).__name__}: {ended.error}"}
    if ended.hung:
        return {"ended": "hung", "message": ended.death}
    return {"ended": "crashed", "message": f"{ended.death} {ended.last_words}".strip()}
