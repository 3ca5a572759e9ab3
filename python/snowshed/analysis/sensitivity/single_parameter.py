"""The single-parameter sensitivity index S of section 3.3."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.sensitivity.noise import noise_of
from snowshed.analysis.sensitivity.parameter_values import PAIRS
from snowshed.analysis.sensitivity.stored import TARGETS, StudyRuns
from snowshed.base.arguments import checked

if TYPE_CHECKING:
    import pandas as pd

STANDARD_ERRORS_95 = 1.96  # standard errors on either side: 95 %


@checked
def local_index(stored: StudyRuns) -> pd.DataFrame:
    """Return S = ((R_a - R_n)/R_n) / ((P_a - P_n)/P_n), equation 3.3.1, per parameter and event.

    R is the height or length of the stack, as the mean over the seedings. P_n and P_a are the
    nominal and the altered value of Table 3.3.1 if the study has both, otherwise the lowest and the
    highest value of the study. All other parameters are equal. If the study has several such pairs
    of points, S is the mean over them.

    Returns
    -------
    pandas.DataFrame
        ``parameter``, ``event``, ``target``, ``nominal``, ``altered``, ``response_nominal_m``,
        ``response_altered_m``, ``pairs``, ``s``; ``standard_error`` of S by the seeding noise;
        ``distinct``: whether S differs from zero by more than 1.96 standard errors (None if noise
        is not known).

    Raises
    ------
    InputError
        If no two runs differ in exactly one parameter.

    Examples
    --------
    >>> import pandas as pd
    >>> points = pd.DataFrame({"hash": ["a", "b"], "snow.cohesion": [0.1, 0.2], "seeding.seed": 1})
    >>> rows = points.assign(event=1, height=[0.10, 0.15], length=[0.3, 0.3])
    >>> local_index(StudyRuns("s", ["snow.cohesion"], points, rows))["s"].round(6).tolist()
    [0.5, 0.0]
    """
    import pandas as pd

    noise = noise_of(stored, "noise")
    indices = [
        {**_index(pairs, pair, target, noise[event, target]), **names}
        for parameter in stored.parameters
        for pair in [_pair(stored, parameter)]
        if pair[0] != pair[1]
        for event, rows in stored.rows.groupby("event")
        for pairs in [list(_pairs(stored, rows, parameter, pair))]
        if pairs
        for target in TARGETS
        for names in [{"parameter": parameter, "event": event, "target": target}]
    ]
    if not indices:
        raise InputError("no two of its runs differ in one parameter alone, which S needs")
    columns = ["parameter", "event", "target"]
    table = pd.DataFrame(indices)
    return table[[*columns, *(name for name in table if name not in columns)]]


def _pair(stored: StudyRuns, parameter: str) -> tuple[float, float]:
    values = np.unique(stored.rows[parameter].to_numpy(float))
    pair = PAIRS.get(parameter, (np.nan, np.nan))
    if not all(np.isclose(values, value, rtol=1e-9).any() for value in pair):
        pair = (float(values[0]), float(values[-1]))
    if pair[0] == 0:
        raise InputError(f"{parameter}: S is not defined at the nominal value 0")
    return pair


def _pairs(
    stored: StudyRuns, rows: pd.DataFrame, parameter: str, pair: tuple[float, float]
) -> Iterator[tuple[pd.DataFrame, pd.DataFrame]]:
    """Yield the rows at the nominal and at the altered value, for each choice of all others."""
    others = [path for path in stored.parameters if path != parameter]
    for _, alike in rows.groupby(others) if others else [((), rows)]:
        at = [alike[np.isclose(alike[parameter], value, rtol=1e-9)] for value in pair]
        if len(at[0]) and len(at[1]):
            yield at[0], at[1]


def _index(
    pairs: list[tuple[pd.DataFrame, pd.DataFrame]],
    pair: tuple[float, float],
    target: str,
    noise: float,
) -> dict[str, Any]:
    change = (pair[1] - pair[0]) / pair[0]
    responses = np.array([[low[target].mean(), two[target].mean()] for low, two in pairs])
    counts = np.array([[len(low), len(two)] for low, two in pairs])
    nominal, altered = responses.T
    with np.errstate(divide="ignore", invalid="ignore"):  # where there is no stack: NaN
        scores = (altered - nominal) / nominal / change
        variances = (altered / nominal / change * noise) ** 2 * (1 / counts).sum(axis=1)
    error = float(np.sqrt(variances.sum()) / len(pairs))
    score = float(scores.mean())
    return {
        "nominal": pair[0],
        "altered": pair[1],
        "response_nominal_m": float(nominal.mean()),
        "response_altered_m": float(altered.mean()),
        "pairs": len(pairs),
        "s": score,
        "standard_error": error,
        "distinct": abs(score) > STANDARD_ERRORS_95 * error if np.isfinite(error) else None,
    }
