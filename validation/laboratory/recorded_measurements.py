"""Measurements of `stack_convergence` from recorded runs, which need not be repeated.

``python -m validation.laboratory.recorded_measurements`` adds the measurements of the scheme
objective to the package's recorded measurements. ``--accuracy`` and the error of a stack use these.
The full suite makes the same measurements.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from snowshed._core import InputError
from snowshed.snow.accuracy.measurements import CaseSettings, MeasuredSolution
from snowshed.snow.accuracy.mechanisms import scheme_of
from snowshed.snow.accuracy.recorded import PACKAGED_FILE, load_recorded, record
from validation.laboratory.case_stack_convergence import CASE, compared, matrix
from validation.laboratory.lab_records import RecordedRun, recorded_runs

SCHEME = "objective"


def measurements_of(scheme: str) -> list[MeasuredSolution]:
    """Return the measurements of the full matrix that follow from the recorded runs of a scheme.

    Raises
    ------
    InputError
        If the runs of one grid were made on several machines, by several versions, or without
        their cost.
    LookupError
        If an entry of the matrix was not recorded.
    """
    return [_measured(entry) for entry in matrix(True) if scheme_of(entry) == scheme]


def _measured(settings: CaseSettings) -> MeasuredSolution:
    dimension, dx = int(settings["dimension"]), float(settings["dx"])
    runs = recorded_runs(dimension, dx, scheme_of(settings))
    if len(runs) != settings["seedings"]:
        raise LookupError(f"{settings}: {len(runs)} runs are recorded")
    runs = [run.until(int(settings["events"])) for run in undisturbed(runs)]
    outcome = compared(runs, settings)
    return MeasuredSolution(
        case=CASE.name,
        settings=dict(settings),
        measured=outcome.measured,
        wall_s=outcome.wall_s,
        updates=outcome.updates,
        steps=outcome.steps,
        particles=outcome.particles,
        # The time does not include seeding and evaluation, which were not recorded.
        elapsed_s=math.fsum(run.cost.wall_s for run in runs),
        version=_common(runs, "version"),
        machine=_common(runs, "machine"),
        date=max(run.date for run in runs),
    )


def undisturbed(runs: Sequence[RecordedRun]) -> list[RecordedRun]:
    """Return the runs of one grid with wall times scaled to the speed of the fastest run.

    Recorded runs were made several at a time, on machines with other work. Both can only increase
    their times. The speed is the number of particle updates per second, over all events of a run.

    Raises
    ------
    InputError
        If the time on one thread or the updates of a run were not recorded.
    """
    if not all(run.cost.wall_s and run.cost.updates for run in runs):
        raise InputError("the time of the runs on one thread was not recorded")
    seconds = [run.cost.wall_s / run.cost.updates for run in runs]
    return [
        replace(
            run,
            costs=[replace(cost, wall_s=cost.wall_s * min(seconds) / own) for cost in run.costs],
        )
        for run, own in zip(runs, seconds)
    ]


def _common(runs: Iterable[RecordedRun], name: str) -> str:
    values = sorted({str(getattr(run, name)) for run in runs})
    if len(values) != 1:
        raise InputError(f"the runs of one grid differ in their {name}: {', '.join(values)}")
    return values[0]


def renew(new: Sequence[MeasuredSolution], path: Path = PACKAGED_FILE) -> None:
    """Write measurements into a file in place of those of the same case and scheme."""
    case, schemes = CASE.name, {scheme_of(measurement.settings) for measurement in new}
    others = [
        measurement
        for measurement in load_recorded(path)
        if measurement.case == case and scheme_of(measurement.settings) not in schemes
    ]
    record([*others, *new], path)


if __name__ == "__main__":
    renew(measurements_of(SCHEME))
