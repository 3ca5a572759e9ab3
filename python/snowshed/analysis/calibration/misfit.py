"""Errors of simulated stacks against measured ones, and the ranking of parameter sets (4.2)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.calibration.comparison import SET, SimulatedStacks
from snowshed.analysis.sensitivity.fixed_parameter import rescaled
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats

if TYPE_CHECKING:
    import pandas as pd

#: Quantities that rank the sets in the thesis; head and tail are only scored.
RANKING_QUANTITIES = ("height", "length")


@checked
def rank_sets(stacks: SimulatedStacks, comparison: pd.DataFrame) -> pd.DataFrame:
    """Score every parameter set, and rank the sets by the mean rescaled RMSE, as section 4.1 does.

    Parameters
    ----------
    stacks
        The simulated stacks.
    comparison
        From `compare_stacks`.

    Returns
    -------
    pandas.DataFrame
        One row per complete set, the best first: ``rank``, ``set``, the parameters, and for each
        measured quantity ``..._relative_error`` (height and length only: mean of (measured -
        simulated) / measured, which may cancel), ``..._mean_error_m`` (mean of the absolute
        differences), ``..._rmse_m``, and for height and length ``..._rescaled`` (equation 3.4.1
        over the sets). ``rescaled_rmse``, the mean of ``..._rescaled``, ranks the sets;
        ``chi_square`` is the mean of ((measured - simulated) / uncertainty)^2.

    Raises
    ------
    InputError
        If neither height nor length was measured.
    """
    import pandas as pd

    measured = [q for q in RANKING_QUANTITIES if (comparison["quantity"] == q).any()]
    if not measured:
        raise InputError("neither height_m nor length_m was measured; the sets are ranked by these")
    scores = pd.DataFrame({"chi_square": _chi_square(comparison)})
    for quantity, rows in comparison.groupby("quantity", sort=False):
        for name, values in _scores(rows, relative=quantity in RANKING_QUANTITIES).items():
            scores[f"{quantity}_{name}"] = values
    for quantity in measured:
        scores[f"{quantity}_rescaled"] = rescaled(_column(scores, f"{quantity}_rmse_m"))
    scores["rescaled_rmse"] = scores[[f"{q}_rescaled" for q in measured]].mean(axis=1)
    ranked = stacks.sets.join(scores, how="inner").sort_values("rescaled_rmse", kind="stable")
    ranked = ranked.rename_axis(SET).reset_index()
    ranked.insert(0, "rank", np.arange(1, len(ranked) + 1))
    return ranked


def statistics(ranked: pd.DataFrame) -> pd.DataFrame:
    """Return minimum, maximum, mean and median of the RMSE over the sets, as Table 4.2.1."""
    columns = [f"{q}_rmse_m" for q in RANKING_QUANTITIES if f"{q}_rmse_m" in ranked]
    return ranked[columns].agg(["min", "max", "mean", "median"]).T.rename_axis("score")


def _column(table: pd.DataFrame, name: str) -> Floats:
    return np.asarray(table[name], dtype=float)


def _chi_square(rows: pd.DataFrame) -> pd.Series[float]:
    deviations = (rows["value"] - rows["simulated"]) / rows["uncertainty"]
    return (deviations**2).groupby(rows[SET]).mean()


def _scores(rows: pd.DataFrame, *, relative: bool) -> dict[str, pd.Series[float]]:
    """Return the scores of one quantity, each indexed by the set."""
    difference = rows["value"] - rows["simulated"]
    columns = {
        "mean_error_m": difference.abs().groupby(rows[SET]).mean(),
        "rmse_m": (difference**2).groupby(rows[SET]).mean() ** 0.5,
    }
    if relative:
        columns["relative_error"] = (difference / rows["value"]).groupby(rows[SET]).mean()
    return columns
