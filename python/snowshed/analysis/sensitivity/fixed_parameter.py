"""Single-parameter fixation (section 3.4): one parameter is fixed, the others of its group vary."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.sensitivity.noise import noise_of
from snowshed.analysis.sensitivity.parameter_values import GROUPS
from snowshed.analysis.sensitivity.stored import TARGETS, StudyRuns
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats

if TYPE_CHECKING:
    import pandas as pd


def rescaled(values: Floats) -> Floats:
    """Return x' = (x - min x) / (max x - min x), equation 3.4.1; zeros if all values are equal.

    Examples
    --------
    >>> rescaled(np.array([2.0, 3.0, 6.0])).tolist()
    [0.0, 0.25, 1.0]
    """
    span = float(np.max(values) - np.min(values))
    return np.asarray((values - np.min(values)) / (span or 1.0))


def groups_of(stored: StudyRuns) -> dict[str, list[str]]:
    """Return the groups of varied parameters; "other" holds the parameters not in the thesis."""
    groups = {
        name: [path for path in paths if path in stored.parameters]
        for name, paths in GROUPS.items()
    }
    grouped = [path for paths in GROUPS.values() for path in paths]
    groups["other"] = [path for path in stored.parameters if path not in grouped]
    return {name: paths for name, paths in groups.items() if paths}


@checked
def fixation_table(stored: StudyRuns) -> pd.DataFrame:
    """Return mean and deviation at each value of each parameter, over all values of the others.

    While a group of parameters varies, the parameters of the other groups are fixed at the values
    for which the study has the most points. If several values have equally many, all of them are
    used. The seedings of a point count as one, by their mean.

    Returns
    -------
    pandas.DataFrame
        ``group``, ``parameter``, ``value``, ``event``, ``target``; ``points``: number of points;
        ``mean_m``, ``deviation_m``, ``lowest_m``, ``highest_m``; ``mean`` and ``deviation`` of the
        rescaled target (3.4.1, over the group and all events); ``noise``: the standard deviation of
        the mean of one point from the seeding, also rescaled; NaN if unknown.

    Raises
    ------
    InputError
        If nothing varies.
    """
    import pandas as pd

    noise = noise_of(stored, "noise_m")
    tables = [
        _group(stored, name, group, target, noise)
        for name, group in groups_of(stored).items()
        for target in TARGETS
    ]
    if not tables:
        raise InputError("no parameter varies in it")
    return pd.concat(tables, ignore_index=True)


def _group(
    stored: StudyRuns,
    name: str,
    group: list[str],
    target: str,
    noise: Mapping[tuple[Any, str], float],
) -> pd.DataFrame:
    """Return the rows of one group and target."""
    import pandas as pd

    rows = _with_others_kept(stored, group)
    keys = [*stored.parameters, "event"]
    points = rows.groupby(keys)[target].agg(["mean", "count"]).reset_index()
    points["rescaled"] = rescaled(points["mean"].to_numpy(float))
    span = float(points["mean"].max() - points["mean"].min()) or 1.0
    rows_of_values = []
    for parameter in group:
        for (value, event), held in points.groupby([parameter, "event"]):
            rows_of_values.append(
                {
                    "group": name,
                    "parameter": parameter,
                    "value": value,
                    "event": event,
                    "target": target,
                    "points": len(held),
                    "mean_m": held["mean"].mean(),
                    "deviation_m": held["mean"].std(),
                    "lowest_m": held["mean"].min(),
                    "highest_m": held["mean"].max(),
                    "mean": held["rescaled"].mean(),
                    "deviation": held["rescaled"].std(),
                    "noise": noise[event, target] / span / np.sqrt(held["count"].mean()),
                }
            )
    return pd.DataFrame(rows_of_values)


def _with_others_kept(stored: StudyRuns, group: Sequence[str]) -> pd.DataFrame:
    """Return the rows at those values of all other parameters that have the most points."""
    others = [path for path in stored.parameters if path not in group]
    if not others:
        return stored.rows
    counts = stored.points.drop_duplicates(stored.parameters).groupby(others).size()
    most = counts[counts == counts.max()].reset_index()[others]
    return stored.rows.merge(most, on=others)
