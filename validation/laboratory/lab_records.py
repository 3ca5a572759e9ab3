"""Recorded stacks of the laboratory: the references of the stack's convergence.

Stacks have no exact answer. They are compared with the mean over seedings on the finest affordable
grid with the same scheme. The runs on these grids take hours. `record` made them once; they are
stored in ``lab_stack.json``, beside this module, each with its settings, version and date.
"""

from __future__ import annotations

import datetime
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import nan
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed import _core
from snowshed.base.arrays import Floats
from snowshed.base.machine import cpu_name
from snowshed.io.atomic import write_text
from snowshed.snow.accuracy.measurements import CaseSettings, Measured, Value
from snowshed.snow.accuracy.mechanisms import FIRST_SCHEME, scheme_of
from validation.framework.drive import absolute
from validation.laboratory.lab_stack import COMPARED, Cost, StackRun, run_lab

FILE = Path(__file__).with_name("lab_stack.json")
#: Events of a recorded run that does not name their number.
EVENTS = 5

#: The only setting of `FIRST_SCHEME`'s reference that is not a default: no snow sleeps.
NO_SLEEP: CaseSettings = {"sleep_speed": 0.0}


@dataclass(frozen=True)
class Grid:
    """Recorded runs on one grid, with the seeds from 1 on."""

    dimension: int
    dx: float
    seedings: int
    events: int = EVENTS


@dataclass(frozen=True)
class Reference:
    """Recorded runs of a scheme.

    Attributes
    ----------
    settings
        Settings of all runs, for `lab_scene`.
    grids
        Grids of the runs; the finest grid of each dimension is the reference.
    """

    settings: CaseSettings
    grids: Sequence[Grid]


REFERENCES: Mapping[str, Reference] = {
    FIRST_SCHEME: Reference(
        NO_SLEEP,
        (
            Grid(2, 0.02, 12),
            Grid(2, 0.01, 12),
            Grid(2, 0.005, 6),
            Grid(2, 0.0025, 4),
            Grid(3, 0.02, 8),
            Grid(3, 0.01, 4),
            Grid(3, 0.005, 1),
        ),
    ),
    # Snow sleeps as by default.
    "objective": Reference(
        {"scheme": "objective", "sleep_speed": 0.02},
        (
            Grid(2, 0.02, 12),
            Grid(2, 0.01, 12),
            Grid(2, 0.005, 12),
            Grid(2, 0.0025, 8),
            Grid(3, 0.02, 8, events=2),
            Grid(3, 0.01, 4, events=2),
            Grid(3, 0.005, 4, events=2),
        ),
    ),
}


@dataclass(frozen=True)
class RecordedRun:
    """A recorded run.

    Attributes
    ----------
    measures
        Each of `COMPARED` after each event, m.
    costs
        Cost up to the end of each event; empty if it was not recorded.
    machine, version, date
        Origin of the run; the machine is empty if it was not recorded.
    """

    measures: Mapping[str, Sequence[float]]
    costs: Sequence[Cost] = field(default_factory=list)
    machine: str = ""
    version: str = ""
    date: str = ""

    def series(self, name: str) -> Sequence[float]:
        """Return one of `COMPARED` after each event, m."""
        return self.measures[name]

    @property
    def cost(self) -> Cost:
        """Cost of all events.

        Raises
        ------
        LookupError
            If the cost was not recorded.
        """
        if not self.costs:
            raise LookupError("the cost of this run was not recorded")
        return self.costs[-1]

    def until(self, event: int) -> RecordedRun:
        """Return the part of the run up to the end of an event.

        Raises
        ------
        LookupError
            If the run has fewer events.
        """
        measures = {name: values[:event] for name, values in self.measures.items()}
        if any(len(values) < event for values in measures.values()):
            raise LookupError(f"no event {event} in this run")
        return RecordedRun(measures, self.costs[:event], self.machine, self.version, self.date)


@dataclass(frozen=True)
class RecordedStacks:
    """Recorded stacks of one scheme, dimension and dx, with values for each event.

    Attributes
    ----------
    dx
        Size of the grid cells, m.
    runs
        Values of each of `COMPARED`, shape (seedings, events), m.
    """

    dx: float
    runs: Mapping[str, Floats]

    @property
    def events(self) -> int:
        """Number of recorded events."""
        return int(min(values.shape[1] for values in self.runs.values()))

    def mean(self, name: str, event: int) -> float:
        """Return the mean over seedings of a measure after an event, m; NaN: not recorded."""
        return float(self.runs[name][:, event - 1].mean()) if event <= self.events else nan

    def spread(self, name: str, event: int) -> float:
        """Return the standard deviation between seedings after an event, m; NaN: not recorded."""
        return float(self.runs[name][:, event - 1].std(ddof=1)) if event <= self.events else nan


def noise(name: str, runs: Sequence[StackRun], settings: CaseSettings) -> Measured:
    """Compare the mean of the last stacks with the recorded mean of its scheme on the same grid.

    Parameters
    ----------
    name
        One of `COMPARED`.
    runs
        Runs with these settings and different seeds.
    settings
        For `lab_scene`.

    Returns
    -------
    Measured
        The quantity ``<name>_noise``: the deviation in standard deviations between the recorded
        seedings.
    """
    reference = recorded(int(settings["dimension"]), float(settings["dx"]), scheme_of(settings))
    last = [run.series(name) for run in runs]
    event, value = len(last[0]), float(np.mean([series[-1] for series in last]))
    deviation = (value - reference.mean(name, event)) / reference.spread(name, event)
    return absolute(f"{name}_noise", deviation, 0.0)


def recorded(
    dimension: int, dx: Optional[float] = None, scheme: str = FIRST_SCHEME
) -> RecordedStacks:
    """Return the recorded stacks of a scheme on a grid, by default on the finest of the dimension.

    Raises
    ------
    LookupError
        If nothing was recorded on that grid.

    Examples
    --------
    >>> recorded(2).dx
    0.0025
    >>> recorded(3, scheme="objective").events
    2
    """
    wanted, runs = _entries(dimension, dx, scheme)
    return RecordedStacks(
        wanted, {name: np.array([run[name] for run in runs]) for name in COMPARED}
    )


def recorded_runs(dimension: int, dx: float, scheme: str) -> list[RecordedRun]:
    """Return the recorded runs of a scheme on a grid, sorted by seed.

    Raises
    ------
    LookupError
        If nothing was recorded on that grid.
    """
    runs = sorted(_entries(dimension, dx, scheme)[1], key=lambda run: run["seed"])
    return [
        RecordedRun(
            {name: run[name] for name in COMPARED},
            [Cost(*cost) for cost in run.get("costs", ())],
            run.get("machine", ""),
            run["version"],
            run["date"],
        )
        for run in runs
    ]


def _entries(
    dimension: int, dx: Optional[float], scheme: str
) -> tuple[float, list[dict[str, Any]]]:
    """Return the size of the cells (m), and the entries of the file with this size."""
    runs = [run for run in _read() if run["dimension"] == dimension and scheme_of(run) == scheme]
    wanted = min((run["dx"] for run in runs), default=nan) if dx is None else dx
    chosen = [run for run in runs if np.isclose(run["dx"], wanted)]
    if not chosen:
        known = sorted({run["dx"] for run in runs})
        raise LookupError(
            f"no stacks of {scheme} recorded in {dimension}D at dx {dx}; there are {known}"
        )
    return float(wanted), chosen


@lru_cache(maxsize=1)
def _read() -> list[dict[str, Any]]:
    return read_entries(FILE)


def read_entries(path: Path) -> list[dict[str, Any]]:
    """Return the entries of a file of recorded runs, or an empty list if there is no file."""
    if not path.exists():
        return []
    runs: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["runs"]
    return runs


def record(
    path: Path = FILE,
    scheme: str = FIRST_SCHEME,
    grids: Optional[Iterable[Grid]] = None,
    **settings: Value,
) -> None:
    """Compute the reference of a scheme again; this takes hours.

    The file is written after each run. Runs of the same version that the file holds are kept.

    Parameters
    ----------
    path
        The file.
    scheme
        One of `REFERENCES`.
    grids
        Grids to compute; by default all grids of the reference.
    settings
        Further settings for `lab_scene`, such as ``events=1``.
    """
    reference = REFERENCES[scheme]
    runs = read_entries(path)
    for grid in reference.grids if grids is None else grids:
        for key in keys_of(grid, {**reference.settings, **settings}):
            held = [run for run in runs if is_of(run, key)]
            if any(run["version"] == _core.version for run in held):
                continue
            runs = [run for run in runs if run not in held] + [_run_entry(key)]
            write_entries(runs, path)


def keys_of(grid: Grid, settings: CaseSettings) -> list[CaseSettings]:
    """Return the settings of each run on a grid, as in its entry.

    Examples
    --------
    >>> keys_of(Grid(3, 0.01, 1, events=2), {"scheme": "objective"})
    [{'dimension': 3, 'dx': 0.01, 'seed': 1, 'events': 2, 'scheme': 'objective'}]
    """
    events: CaseSettings = {} if grid.events == EVENTS else {"events": grid.events}
    return [
        {"dimension": grid.dimension, "dx": grid.dx, "seed": seed, **events, **settings}
        for seed in range(1, grid.seedings + 1)
    ]


def is_of(run: Mapping[str, Any], key: CaseSettings) -> bool:
    """Return whether an entry belongs to a run with these settings."""
    return scheme_of(run) == scheme_of(key) and key.items() <= run.items()


def _run_entry(settings: CaseSettings) -> dict[str, Any]:
    run = run_lab(settings)
    date = datetime.date.today().isoformat()
    return entry(settings, run, run.ended, run.costs, (_core.version, date, cpu_name()))


def entry(
    settings: CaseSettings,
    run: StackRun,
    ended: Iterable[str],
    costs: Sequence[Cost],
    origin: tuple[str, str, str],
) -> dict[str, Any]:
    """Return the entry of a run for the file.

    Parameters
    ----------
    settings
        For `lab_scene`.
    run
        The stacks.
    ended
        The end of each event.
    costs
        Cost up to the end of each event. Times are for one thread; they are 0 if the run had
        several threads.
    origin
        Version, date and machine.
    """
    return {
        **settings,
        **dict(zip(("version", "date", "machine"), origin)),
        "particles": costs[-1].particles,
        "steps": costs[-1].steps,
        "ended": sorted(set(ended)),
        **{name: [round(value, 5) for value in run.series(name)] for name in COMPARED},
        "costs": [
            [round(cost.wall_s, 4), cost.updates, cost.steps, cost.particles] for cost in costs
        ],
    }


def write_entries(runs: Iterable[Mapping[str, Any]], path: Path) -> None:
    """Write a file of recorded runs, with a run in each line."""
    about = (
        "Stacks of preset lab-50 after each event, in m, with panel friction 0.3 and the core's "
        "default numerics except for the settings that each run names. Costs are sums up to the "
        "end of each event: time in s on one thread, particles times steps, steps, particles; "
        "0: not measured. Made by validation.laboratory.lab_records.record()."
    )
    lines = ",\n".join(f"    {json.dumps(run)}" for run in runs)
    write_text(path, f'{{\n  "about": {json.dumps(about)},\n  "runs": [\n{lines}\n  ]\n}}\n')
