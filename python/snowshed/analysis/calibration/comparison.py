"""Simulated stacks beside measured ones: one row per parameter set and measurement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.calibration.measurements import Measurement, to_table
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.snow.stack.quantities import QUANTITIES
from snowshed.study.factors import SEED
from snowshed.study.stack_table import StackTable, as_numbers

if TYPE_CHECKING:
    import pandas as pd

TILT = "panel.tilt"
SET = "set"  # the column that numbers parameter sets, from 1


@dataclass(frozen=True)
class SimulatedStacks:
    """Simulated stacks of a study.

    Attributes
    ----------
    parameters
        Dotted paths of the calibrated parameters: all that vary, except the panel's tilt and the
        seed.
    sets
        The parameter sets, one row each, indexed from 1; also those whose runs have failed.
    rows
        One row per run and event: ``set``, ``tilt``, ``event``, ``seed``, and the measures
        ``height``, ``length``, ``head``, ``tail`` in m.
    pending
        Number of runs that are not computed yet, except sets without any computed run.
    """

    parameters: Sequence[str]
    sets: pd.DataFrame
    rows: pd.DataFrame
    pending: int = 0


@checked
def read_simulated_stacks(
    folder: PathLike, study: Optional[str] = None, measure: str = "stack"
) -> SimulatedStacks:
    """Read the stacks of the computed runs of a study from its store.

    Parameters
    ----------
    folder
        Folder of the store, or a table that ``snowshed study export`` wrote.
    study
        Name of the study; not needed if the store holds only one.
    measure
        "stack": 97 % of the snow, as the thesis measures; "body": the largest connected body.

    Raises
    ------
    InputError
        If there is no such study, no parameter varies in it, or the panel's tilt is not among its
        axes.
    """
    table = StackTable.read(folder, study)
    try:
        return replace(simulated(table.frame, measure), pending=table.pending)
    except InputError as error:
        raise InputError(f"{folder}: {error}") from None


def simulated(frame: pd.DataFrame, measure: str = "stack") -> SimulatedStacks:
    """Return the stacks in a study's table, as `snowshed.study.read_table` returns it."""
    if TILT not in frame:
        raise InputError(f"no axis {TILT}; write axes.{TILT} = 40, also for a single tilt")
    table = StackTable.of(frame)
    axes = [path for path in table.axes if path not in (TILT, SEED)]
    varied = table.varying(axes, "calibration")
    if not varied:
        raise InputError("only tilt and seed vary in it, so nothing can be calibrated")
    measured = table.measured(measure, QUANTITIES)
    numbers = as_numbers(frame, varied)  # "40" and "40.0" are the same
    numbered = numbers.assign(**{SET: numbers.groupby(varied, sort=False).ngroup() + 1})
    sets = numbered.drop_duplicates(SET).set_index(SET)[varied].astype(float)
    rows = measured.assign(**{SET: numbered[SET]}).rename(columns={TILT: "tilt"})
    return SimulatedStacks(
        varied, sets, rows[["tilt", "seed", "event", *QUANTITIES, SET]].reset_index(drop=True)
    )


@checked
def compare_stacks(stacks: SimulatedStacks, measurements: Sequence[Measurement]) -> pd.DataFrame:
    """Return simulated beside measured values.

    Returns
    -------
    pandas.DataFrame
        One row per parameter set and measurement: ``set``, the fields of the measurement, and
        ``simulated`` (m), the mean over the seedings. A set is left out if one of the measured
        stacks is missing, because a run has failed or is not computed yet.

    Raises
    ------
    InputError
        If the study has no run for a measured tilt or event (the message has the measurement's
        line or row), or if no set has all measured stacks.
    """
    for measurement in measurements:
        _check_simulated(stacks, measurement)
    keys = [SET, "tilt", "event"]
    means = stacks.rows.groupby(keys)[list(QUANTITIES)].mean().reset_index()
    means = means.melt(keys, var_name="quantity", value_name="simulated")
    both = to_table(measurements).merge(means, on=["tilt", "event", "quantity"])
    counts = both.groupby(SET)["simulated"].transform("size")
    complete = both[counts == len(measurements)]
    if complete.empty:
        raise InputError(f"none of the {len(stacks.sets)} parameter sets has all measured stacks")
    return complete.sort_values([SET, "line", "quantity"], ignore_index=True)


def _check_simulated(stacks: SimulatedStacks, measurement: Measurement) -> None:
    tilts = np.unique(stacks.rows["tilt"].to_numpy(float))
    if measurement.tilt not in tilts:
        listed = ", ".join(f"{tilt:g}" for tilt in tilts)
        raise InputError(
            f"tilt {measurement.tilt:g}{_place(measurement)}: no such run; there are: {listed}"
        )
    last = int(stacks.rows["event"].max())
    if measurement.event > last:
        raise InputError(
            f"event {measurement.event}{_place(measurement)}: its runs have {last} events"
        )


def _place(measurement: Measurement) -> str:
    return f", measured in {measurement.place}" if measurement.place else ""
