"""Simulated stacks beside measured ones: one row per parameter set and measurement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.calibration.measurements import QUANTITIES, Measurement, to_table
from snowshed.scene.scene import PathLike
from snowshed.study.factors import SEED

if TYPE_CHECKING:
    import pandas as pd

TILT = "panel.tilt"
SET = "set"  # the column that numbers parameter sets, from 1
#: Columns of a study's table by what counts as the stack.
MEASURES: Mapping[str, Mapping[str, str]] = {
    "stack": {quantity: f"{quantity}_m" for quantity in QUANTITIES},
    "body": {quantity: f"body_{quantity}_m" for quantity in QUANTITIES},
}


@dataclass(frozen=True)
class Simulated:
    """Simulated stacks of a study.

    Attributes
    ----------
    parameters
        Dotted paths of what is calibrated: all that varies but the panel's tilt and the seed.
    sets
        The parameter sets, one row each, indexed from 1; also those whose runs have failed.
    rows
        One row per run and event: ``set``, ``tilt``, ``event``, ``seed``, and the measures
        ``height``, ``length``, ``head``, ``tail`` in m.
    pending
        Runs of the study that are not computed yet; sets without any other run are not among
        these.
    """

    parameters: Sequence[str]
    sets: pd.DataFrame
    rows: pd.DataFrame
    pending: int = 0


def read_simulated(
    folder: PathLike, study: Optional[str] = None, measure: str = "stack"
) -> Simulated:
    """Read the stacks of a study from its store, as far as they are computed.

    Parameters
    ----------
    folder
        Where the store is.
    study
        Name of the study; not needed if the store holds but one.
    measure
        "stack": 97 % of the snow, as the thesis measures; "body": the largest connected body.

    Raises
    ------
    InputError
        If there is no such study, it varies nothing that could be calibrated, or it does not say
        the panel's tilt.
    """
    from snowshed.study.store import Store
    from snowshed.study.table import read_table

    if measure not in MEASURES:
        raise InputError(f"measure: {measure!r} is unknown; allowed: {', '.join(MEASURES)}")
    with Store.open(folder) as store:
        pending = sum(run.status == "pending" for run in store.runs(store.named(study)))
    try:
        return replace(simulated(read_table(folder, study), measure), pending=pending)
    except InputError as error:
        text = str(error)
        raise InputError(text if str(folder) in text else f"{folder}: {text}") from None


def simulated(table: pd.DataFrame, measure: str = "stack") -> Simulated:
    """Return the stacks in a study's table, as `snowshed.study.read_table` returns it."""
    from snowshed.study.table import varying_numbers

    if TILT not in table:
        raise InputError(f"no axis {TILT}; write axes.{TILT} = 40, also for a single tilt")
    axes = [str(path) for path in table if "." in str(path) and path not in (TILT, SEED)]
    varied = varying_numbers(table, axes, "calibration")
    columns = {column: quantity for quantity, column in MEASURES[measure].items()}
    if table[[*columns]].dropna().empty:
        raise InputError("nothing of it is computed yet; see `snowshed study status`")
    if not varied:
        raise InputError("nothing varies in it but tilt and seed, so that nothing is calibrated")
    rows = table[[*varied, TILT, "seed", "event", *columns]]
    rows = rows.rename(columns={**columns, TILT: "tilt"})
    rows[SET] = rows.groupby(varied, sort=False).ngroup() + 1
    sets = rows.drop_duplicates(SET).set_index(SET)[varied]
    rows = rows.dropna().drop(columns=varied).reset_index(drop=True)
    return Simulated(varied, sets, rows)


def compare(stacks: Simulated, measurements: Sequence[Measurement]) -> pd.DataFrame:
    """Return simulated beside measured values.

    Returns
    -------
    pandas.DataFrame
        One row per parameter set and measurement: ``set``, the fields of the measurement, and
        ``simulated`` (m), the mean over the seedings. A set that lacks one of the measured stacks
        (a run has failed or is not computed yet) has none at all.

    Raises
    ------
    InputError
        If the study has no run for a measured tilt or event, naming the measurement's line; or if
        no set has all stacks that were measured.
    """
    for one in measurements:
        _check_simulated(stacks, one)
    keys = [SET, "tilt", "event"]
    means = stacks.rows.groupby(keys)[list(QUANTITIES)].mean().reset_index()
    means = means.melt(keys, var_name="quantity", value_name="simulated")
    both = to_table(measurements).merge(means, on=["tilt", "event", "quantity"])
    counts = both.groupby(SET)["simulated"].transform("size")
    whole = both[counts == len(measurements)]
    if whole.empty:
        raise InputError(
            f"none of the {len(stacks.sets)} parameter sets has all stacks that were measured"
        )
    return whole.sort_values([SET, "line", "quantity"], ignore_index=True)


def _check_simulated(stacks: Simulated, one: Measurement) -> None:
    tilts = np.unique(stacks.rows["tilt"].to_numpy(float))
    if one.tilt not in tilts:
        listed = ", ".join(f"{tilt:g}" for tilt in tilts)
        raise InputError(
            f"tilt {one.tilt:g}, measured in line {one.line}: no such run; there are: {listed}"
        )
    last = int(stacks.rows["event"].max())
    if one.event > last:
        raise InputError(
            f"event {one.event}, measured in line {one.line}: its runs have {last} events"
        )
