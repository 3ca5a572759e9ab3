"""Claims of chapter 4, judged without the measured stacks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from reproductions.common.hypothesis_tests import (
    CONFIRMED,
    CONTRADICTED,
    UNDECIDED,
    Claim,
    Finding,
)
from reproductions.frischholz2023.printed import CALIBRATED
from snowshed.base.formatting import percent
from snowshed.scene.labels import settings_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd

#: Share of the best sets that should contain a known snow.
BEST_PART = 0.25


@dataclass(frozen=True)
class Recovery:
    """The search for a known snow with its own synthetic stacks.

    Attributes
    ----------
    ranked
        From `snowshed.analysis.calibration.rank_sets`: one row per parameter set, the best first.
    ranges
        From `snowshed.analysis.calibration.Posterior.ranges`.
    """

    ranked: pd.DataFrame
    ranges: pd.DataFrame


def is_ranked_well(data: Recovery) -> Finding:
    """Test whether the ranking finds the snow that made the synthetic stacks."""
    true_rows = data.ranked
    for path, value in CALIBRATED.items():
        true_rows = true_rows[(true_rows[path] / value - 1).abs() < 1e-9]
    if true_rows.empty:
        raise LookupError("the calibrated snow among the parameter sets")
    rank, count = int(true_rows["rank"].iloc[0]), len(data.ranked)
    best = settings_text({path: data.ranked[path].iloc[0] for path in CALIBRATED})
    verdict = CONTRADICTED
    if rank == 1:
        verdict = CONFIRMED
    elif rank <= max(1, round(BEST_PART * count)):
        verdict = UNDECIDED
    return Finding(verdict, f"the true snow has rank {rank} of {count}; the first is {best}")


def is_in_the_ranges(data: Recovery) -> Finding:
    """Test whether the 95 % ranges of the posterior hold the true snow.

    At least one of the three ranges misses the true value by chance in about one of seven draws of
    the errors (1 - 0.95^3).

    The true p0 and beta lie on the grid's boundary, which a quantile range never reaches. Ranges
    marked open are therefore extended to it.
    """
    outside = [
        row["parameter"]
        for row in data.ranges.to_dict("records")
        if not _lower(row) <= CALIBRATED[row["parameter"]] <= _upper(row)
    ]
    widths = (data.ranges["upper_95"] - data.ranges["lower_95"]) / (
        data.ranges["high"] - data.ranges["low"]
    )
    text = f"{len(data.ranges) - len(outside)} of {len(data.ranges)} parameters inside"
    verdict = (CONFIRMED, UNDECIDED, CONTRADICTED)[min(len(outside), 2)]
    return Finding(
        verdict, f"{text}; the ranges are {percent(widths.mean(), 2)} of the grid on average"
    )


def _lower(row: Mapping[Any, Any]) -> float:
    return float(row["low"] if row["open"] in ("below", "both") else row["lower_95"])


def _upper(row: Mapping[Any, Any]) -> float:
    return float(row["high"] if row["open"] in ("above", "both") else row["upper_95"])


def is_the_laboratory(data: Recovery) -> Finding:
    """Return an undecided finding: the thesis shows the measured stacks only in figures."""
    text = "the thesis shows the measured stacks only in figures, so no comparison is possible"
    return Finding(UNDECIDED, text)


CALIBRATION: tuple[Claim[Recovery], ...] = (
    Claim(
        "Table 4.3.1",
        "The laboratory's snow is M 0.5, p₀ 7 kPa, β 0.2.",
        "needs the measured stacks",
        is_the_laboratory,
    ),
    Claim(
        "4.1",
        "The mean rescaled RMSE finds the snow (on synthetic stacks).",
        "the true triplet has rank 1; undecided if it is among the best quarter (one draw of the "
        "errors, no noise)",
        is_ranked_well,
    ),
    Claim(
        "beyond the thesis",
        "The posterior finds the snow (on synthetic stacks).",
        "the true values of all parameters lie in their 95 % ranges, which extend to the end of "
        "the grid if they are open; undecided if one does not (one draw of the errors, no noise)",
        is_in_the_ranges,
    ),
)
