"""Every measurement is made in a fork of a process that has not computed anything yet.

No measurement may depend on the memory or the caches of another. To start Python for each
measurement would take longer than most measurements.
"""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Optional

from snowshed._core import SimulationError
from snowshed.base.machine import peak_memory_mb
from snowshed.base.pool.pool import Isolation, Pool
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.case import Outcome

Measure = Callable[[CaseSettings], Outcome]

WAIT_S = 3600.0  # s between two checks of a measurement, which has no time limit


class Request(NamedTuple):
    """A measurement: a function of a module, and its settings."""

    measure: Measure
    settings: CaseSettings


@dataclass(frozen=True)
class Answer:
    """Result of a measurement: an outcome, or the reason why there is none."""

    outcome: Optional[Outcome]
    failure: str = ""
    peak_memory_mb: float = 0.0
    elapsed_s: float = 0.0


def measuring_pool() -> Pool[Request, Answer]:
    """Return the pool that makes measurements, one after another."""
    return Pool(1, answer, Isolation(forked=True))


def measure_once(pool: Pool[Request, Answer], measure: Measure, settings: CaseSettings) -> Answer:
    """Measure once in a `measuring_pool()`, and return the outcome or the error.

    Raises
    ------
    SimulationError
        If the measuring process does not start.

    Examples
    --------
    >>> from validation.framework.cases import load_cases
    >>> case = load_cases(["material_paths"])[0]
    >>> with measuring_pool() as pool:
    ...     measure_once(pool, case.measure, case.matrix(False)[0]).failure
    ''
    """
    pool.submit(Request(measure, dict(settings)))
    while not (results := pool.collect(WAIT_S)):
        pass
    (ended,) = results
    if ended.result is not None:
        return ended.result
    if ended.never_began:
        raise SimulationError(f"no process starts that could measure: it {ended.death}")
    if ended.error is not None:
        return Answer(None, _reason(ended.error))
    return Answer(None, " ".join(f"its process {ended.death} {ended.last_words}".split()))


def answer(request: Request, report: Callable[[float], None]) -> Answer:
    """Measure in this process."""
    started = time.perf_counter()
    outcome, failure = None, ""
    try:
        outcome = request.measure(request.settings)
        if not isinstance(outcome, Outcome):
            raise TypeError(f"measure returned {type(outcome).__name__}, not Outcome")
    except Exception as error:
        outcome, failure = None, _reason(error)
    return Answer(outcome, failure, peak_memory_mb(), time.perf_counter() - started)


def _reason(error: Exception) -> str:
    """Return the text of an error with the line that raised it, if it is known."""
    message = f"{type(error).__name__}: {' '.join(str(error).split())}"
    frames = traceback.extract_tb(error.__traceback__)
    if error.__traceback__ is None or not frames:
        return message
    return f"{message} ({Path(frames[-1].filename).name}:{frames[-1].lineno})"
