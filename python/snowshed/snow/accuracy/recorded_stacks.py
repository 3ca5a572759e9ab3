"""Recorded stacks: the errors of the laboratory's stacks on several grids and with several schemes.

The size of cells counts relative to the thickness of the slab, because the number of cells across
the slab decides how well it bends and breaks.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional

from snowshed.methods.mpm.settings import MpmSettings
from snowshed.snow.accuracy.measurements import CaseSettings, MeasuredSolution, Value, to_table
from snowshed.snow.accuracy.solutions import (
    SEEDING_SETTINGS,
    assured_errors,
    rows_of,
    settings_key,
    solutions,
)

CASE = "stack_convergence"
QUANTITIES = ("height", "length")
PRESET = "lab-50"  # preset whose slab the stacks are made of
PRESET_THICKNESS = 0.02  # of that slab, m
ORDER_IN = MpmSettings.RESOLUTION  # the setting that refines the grid


@dataclass(frozen=True)
class RecordedStack:
    """Recorded errors of stacks made with the same settings.

    Attributes
    ----------
    errors
        Relative error of a single stack in each of `QUANTITIES`, assured by all finer runs.
    biases
        Relative deviation of the mean stack from the reference in each; positive: too large.
    spreads
        Standard deviation of each over random seedings, relative to the mean; empty if unknown.
    wall_s
        Time of the solution, s.
    machine
        Processor on which it was measured.
    """

    settings: CaseSettings
    errors: Sequence[float]
    biases: Sequence[float]
    spreads: Sequence[float]
    wall_s: float
    machine: str = ""

    @property
    def error(self) -> float:
        """The largest of the errors."""
        return max(self.errors)


def recorded_stacks(measurements: Iterable[MeasuredSolution]) -> list[RecordedStack]:
    """Return the recorded stacks."""
    mine = [m for m in measurements if m.case == CASE and not m.failure]
    table = to_table(mine)

    def by_settings(quantity: str, order_in: Optional[str]) -> dict[Hashable, float]:
        recorded = solutions(rows_of(table, CASE, quantity))
        return {
            settings_key(o.settings): e
            for o, e in zip(recorded, assured_errors(recorded, order_in))
        }

    errors = [by_settings(name, ORDER_IN) for name in QUANTITIES]
    spreads = [by_settings(f"{name}_spread", None) for name in QUANTITIES]
    biases = _biases(mine)
    machines = {settings_key(m.settings, without=SEEDING_SETTINGS): m.machine for m in mine}
    return [
        RecordedStack(
            settings=solution.settings,
            errors=[of_each[key] for of_each in errors],
            biases=[biases[key][name] for name in QUANTITIES],
            spreads=[of_each[key] for of_each in spreads if key in of_each],
            wall_s=solution.wall_s,
            machine=machines[key],
        )
        for solution in solutions(rows_of(table, CASE, QUANTITIES[0]))
        if all((key := settings_key(solution.settings)) in of_each for of_each in errors)
    ]


def _biases(measurements: Iterable[MeasuredSolution]) -> dict[Hashable, dict[str, float]]:
    return {
        settings_key(measurement.settings, without=SEEDING_SETTINGS): {
            m.quantity: m.value / m.exact - 1 for m in measurement.measured if m.exact
        }
        for measurement in measurements
    }


def slab_thickness(data: Mapping[str, Any]) -> Optional[float]:
    """Return the thickness of the thinnest slab of a resolved scene, m; None without a slab."""
    if data.get("slab") is None:
        return None
    slab = data["slab"]
    events = {layer["event"] for layer in slab["layers"]}
    of_each = [
        sum(layer["thickness"] for layer in slab["layers"] if layer["event"] in (0, event))
        for event in (events - {0} or {1})
    ]
    return float(slab["thickness"] or min(of_each))


def nearest(stacks: Sequence[RecordedStack], wanted: Mapping[str, Value]) -> list[RecordedStack]:
    """Return the stacks with the nearest settings; earlier settings have priority."""
    chosen = list(stacks)
    for name, value in wanted.items():
        recorded = {stack.settings[name] for stack in chosen if name in stack.settings}
        if recorded:
            best = min(recorded, key=lambda other: (_distance(other, value), other))
            chosen = [stack for stack in chosen if stack.settings.get(name) == best]
    return chosen


def circumstances(data: Mapping[str, Any]) -> dict[str, Value]:
    """Return the criteria for recorded runs: dimension, and the number and kind of events."""
    events = data["events"]
    return {
        "dimension": data["dimension"],
        "between": events["between"],
        "events": events["count"],
    }


def _distance(value: Value, other: Value) -> float:
    if isinstance(value, str) or isinstance(other, str):
        return float(value != other)
    return abs(value - other)
