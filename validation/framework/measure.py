"""Measuring every case over its matrix, one measurement after another.

Measurements never run at the same time, because run times are measured. The result of a failed
measurement holds the reason of the failure.
"""

from __future__ import annotations

import datetime
import math
import time
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, Optional

from snowshed import _core
from snowshed.base.machine import cpu_name
from snowshed.base.progress import Progress, Reporter
from snowshed.snow.accuracy import setting_labels
from snowshed.snow.accuracy.measurements import (
    CaseSettings,
    Measured,
    MeasuredSolution,
    measurement_key,
)
from validation.framework.case import Case, Outcome
from validation.framework.measurement_file import MeasurementFile
from validation.framework.process import Answer, measure_once, measuring_pool

MAX_LABEL_LENGTH = 60  # characters of the label of a progress bar


class Task(NamedTuple):
    """One entry of a case's matrix."""

    case: Case
    settings: CaseSettings

    @property
    def key(self) -> str:
        """Key of the measurement that this task makes."""
        return measurement_key(self.case.name, self.settings)


def tasks_of(cases: Iterable[Case], *, full: bool) -> list[Task]:
    """Return the entries of the cases' matrices without duplicates."""
    tasks = [Task(case, settings) for case in cases for settings in case.matrix(full)]
    return list({task.key: task for task in tasks}.values())


def measure_cases(
    cases: Sequence[Case],
    file: MeasurementFile,
    *,
    full: bool = False,
    progress: Optional[Reporter] = None,
    durations: Optional[Mapping[str, float]] = None,
) -> list[MeasuredSolution]:
    """Make all measurements that `file` does not hold yet, and return all of them.

    Parameters
    ----------
    cases
        Cases to measure.
    file
        File of the measurements. Measurements of this version that did not fail are not repeated.
    full
        Whether to measure the full matrices; otherwise the quick ones.
    progress
        Called before every measurement.
    durations
        Durations of earlier measurements (s) by key, for the estimate of the remaining time.

    Returns
    -------
    list of MeasuredSolution
        In the order of the matrices.
    """
    tasks = tasks_of(cases, full=full)
    held = {
        measurement.key: measurement
        for measurement in file.read()
        if measurement.version == _core.version and not measurement.failure
    }
    due = [task for task in tasks if task.key not in held]
    estimate = Estimate(due, durations or {})
    with measuring_pool() as pool:
        for done, task in enumerate(due):
            if progress is not None:
                fraction, left_s = estimate.after(done)
                before = len(tasks) - len(due)
                label = f"{task.case.name}: {setting_labels.settings_label(task.settings)}"
                doing = label[:MAX_LABEL_LENGTH]
                report = Progress(
                    fraction, before + done, len(tasks), "measured", doing, left_s=left_s
                )
                progress(report)
            answer = measure_once(pool, task.case.measure, task.settings)
            held[task.key] = _measurement(task, answer)
            file.append(held[task.key])
    return [held[task.key] for task in tasks]


class Estimate:
    """Estimated duration of tasks: the duration of earlier runs, scaled by the present speed.

    A task without an earlier run gets the mean of its case, or the mean of all tasks.

    Parameters
    ----------
    tasks
        All tasks, in order.
    durations
        Durations of earlier tasks (s) by key.
    """

    def __init__(self, tasks: Sequence[Task], durations: Mapping[str, float]) -> None:
        self._known = any(task.key in durations for task in tasks)
        self._expected = [_expected(task, tasks, durations) for task in tasks]
        self._started = time.monotonic()

    def after(self, done: int) -> tuple[float, Optional[float]]:
        """Return the elapsed share of the time after `done` tasks, and the remaining time, s."""
        over, ahead = math.fsum(self._expected[:done]), math.fsum(self._expected[done:])
        if over > 0.0:
            pace = (time.monotonic() - self._started) / over
        elif self._known:
            pace = 1.0
        else:
            return 0.0, None
        return over / (over + ahead), pace * ahead


def _expected(task: Task, tasks: Sequence[Task], durations: Mapping[str, float]) -> float:
    if task.key in durations:
        return durations[task.key]
    alike = [other for other in tasks if other.case.name == task.case.name]
    for group in (alike, tasks):
        known = [durations[other.key] for other in group if other.key in durations]
        if known:
            return math.fsum(known) / len(known)
    return 1.0


def _measurement(task: Task, answer: Answer) -> MeasuredSolution:
    failure = answer.failure or _breach(task.case, answer.outcome)
    outcome = Outcome([], 0.0, 0) if failure or answer.outcome is None else answer.outcome
    nothing = [
        Measured(quantity.name, math.nan, math.nan, math.nan) for quantity in task.case.quantities
    ]
    return MeasuredSolution(
        case=task.case.name,
        settings=dict(task.settings),
        measured=nothing if failure else list(outcome.measured),
        wall_s=outcome.wall_s,
        updates=outcome.updates,
        steps=outcome.steps,
        particles=outcome.particles,
        peak_memory_mb=answer.peak_memory_mb,
        elapsed_s=answer.elapsed_s,
        version=_core.version,
        machine=cpu_name(),
        date=datetime.date.today().isoformat(),
        failure=failure,
    )


def _breach(case: Case, outcome: Optional[Outcome]) -> str:
    """Return how an outcome breaks the contract of its case; empty if it does not."""
    returned = [measured.quantity for measured in outcome.measured] if outcome else []
    quantity_names = [quantity.name for quantity in case.quantities]
    if not returned:
        return "measure returned no quantity"
    if wrong := [
        name for name in returned if name not in quantity_names or returned.count(name) > 1
    ]:
        return f"measure returned {wrong[0]!r}, which the case does not list, or twice"
    return ""
