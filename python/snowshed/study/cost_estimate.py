"""The expected cost of a study: the core's estimate of its work, and speeds measured here."""

from __future__ import annotations

import bisect
import heapq
import itertools
import json
import statistics
import time
from collections.abc import Iterable, Sequence

import snowshed._core as _core
from snowshed._core import InputError, SimulationError
from snowshed.study.aged_scene import split_ageing, without_ageing

THIRDS = (1 / 6, 3 / 6, 5 / 6)  # the middle of each third
ROUNDS = 9  # largest number of measurements of each speed
MAX_MEASURING_SHARE = 0.01  # no further round after this share of the expected time


def work(scene: str) -> float:
    """Return the expected number of particle updates of a run, weighted as in ``plan``.

    Parameters
    ----------
    scene
        The complete scene of a run as JSON. The work of a scene that cannot be run is 0.

    Examples
    --------
    >>> from snowshed import Scene
    >>> lab = Scene.preset("lab-50").update({"dimension": 2, "events.count": 1})
    >>> one = work(lab.resolve().json)
    >>> two = work(lab.set("events.count", 2).resolve().json)
    >>> 2 < two / one < 3  # the second event moves its own snow and a part of the first one's
    True
    """
    try:
        return _core.expected_work(without_ageing(scene))
    except (InputError, SimulationError):
        return 0.0


def speed(scene: str, threads: int) -> float:
    """Return the particle updates per second of a scene on this machine at present."""
    data = split_ageing(scene)[0]
    data["numerics"]["threads"] = threads
    try:
        return max(float(_core.plan(json.dumps(data))["updates_per_s"]), 1.0)
    except (InputError, SimulationError):
        return 1.0


def makespan(works: Iterable[float], workers: int) -> float:
    """Return the time that workers need for tasks if the longest start first.

    Parameters
    ----------
    works
        Time of each task, in any unit.
    workers
        Number of tasks at once.

    Examples
    --------
    >>> makespan([3.0, 1.0, 1.0, 1.0], 2)
    3.0
    """
    busy_until = [0.0] * workers
    for task in sorted(works, reverse=True):
        heapq.heapreplace(busy_until, busy_until[0] + task)
    return max(busy_until)


def expected_time(
    scenes: Sequence[str], works: Sequence[float], workers: int, threads: int
) -> float:
    """Return the expected time of runs, s.

    The speed is measured on three runs, each of which stands for a third of the work. Before long
    studies each is measured several times, and the highest speed counts: other work may slow a
    machine down for seconds, but nothing makes it faster.

    Parameters
    ----------
    scenes, works
        The complete scene of each run, and its `work`.
    workers
        Runs at once.
    threads
        Threads of each run.
    """
    order = sorted(range(len(works)), key=works.__getitem__)
    done = list(itertools.accumulate(works[run] for run in order))
    typical = [scenes[order[bisect.bisect_left(done, part * done[-1])]] for part in THIRDS]
    updates = makespan(works, workers)
    quickest = dict.fromkeys(typical, 1.0)  # updates/s, the least that `speed` returns
    start = time.monotonic()
    for _ in range(ROUNDS):
        for scene, before in quickest.items():
            quickest[scene] = max(before, speed(scene, threads))
        seconds = updates * statistics.fmean(1 / quickest[scene] for scene in typical)
        if time.monotonic() - start > MAX_MEASURING_SHARE * seconds:
            break
    return seconds
