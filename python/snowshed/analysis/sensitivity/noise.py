"""The noise of stacks: their deviation if only the placement of the particles differs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed.analysis.sensitivity.stored import TARGETS, StudyRuns
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats

if TYPE_CHECKING:
    import pandas as pd


@checked
def seeding_noise(stored: StudyRuns) -> pd.DataFrame:
    """Return the deviation between seedings, event by event.

    The deviation is pooled over all points with several seedings. Few seedings of many points give
    a reliable estimate; few seedings of one point do not.

    Returns
    -------
    pandas.DataFrame
        Index: ``event`` and ``target`` (height, length). Columns: ``noise_m``, the standard
        deviation in m; ``noise``, the same relative to the mean of the point; ``freedom``, the
        degrees of freedom of both. Without repetitions both are NaN.

    Examples
    --------
    >>> import pandas as pd
    >>> points = pd.DataFrame({"hash": ["a", "b"], "snow.cohesion": 0.1, "seeding.seed": [1, 2]})
    >>> rows = points.assign(event=1, height=[0.09, 0.11], length=[0.3, 0.3])
    >>> seeding_noise(StudyRuns("s", ["snow.cohesion"], points, rows)).loc[(1, "height")].round(4)
    noise_m    0.0141
    noise      0.1414
    freedom    1.0000
    Name: (1, height), dtype: float64
    """
    import pandas as pd

    scatter = []
    for event, rows in stored.rows.groupby("event"):
        points = rows.groupby(stored.parameters) if stored.parameters else rows.groupby("event")
        for target in TARGETS:
            means = points[target].transform("mean")
            freedom = len(rows) - points.ngroups
            residuals = rows[target] - means
            there = means > 0  # without a stack there is no relative noise
            relative = (residuals / means)[there].to_numpy()
            groups = int((points[target].mean() > 0).sum())
            scatter.append(
                {
                    "event": int(str(event)),
                    "target": target,
                    "noise_m": _deviation(residuals.to_numpy(), freedom),
                    "noise": _deviation(relative, len(relative) - groups),
                    "freedom": freedom,
                }
            )
    return pd.DataFrame(scatter).set_index(["event", "target"])


def noise_of(stored: StudyRuns, column: str) -> dict[tuple[Any, str], float]:
    """Return one column of `seeding_noise`, by event and target."""
    table = seeding_noise(stored).reset_index()
    return dict(zip(zip(table["event"], table["target"]), table[column]))


def _deviation(residuals: Floats, freedom: int) -> float:
    return float(np.sqrt(np.sum(residuals**2) / freedom)) if freedom else float("nan")
