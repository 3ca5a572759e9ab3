"""Published results of a regression of the same panels, printed beside our own.

They come with the data set, in ``data/published.json``.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pandas as pd

FILE = Path(__file__).with_name("data") / "published.json"
# Bounds within which our results agree with the published ones.
MAX_RBF_ERROR = 0.004  # mean absolute error of the RBF kernel
MIN_LINEAR_OVER_RBF = 2.5  # the linear kernel's error over that of the RBF kernel
MAX_QUARTILE_DEVIATION = 0.20  # relative deviation of a quartile


@dataclass(frozen=True)
class Published:
    """Published results for the ratio of height to length.

    Attributes
    ----------
    rows
        Number of rows of the data set; results for another number are not comparable.
    quartiles
        Quartiles of the predictions of each kind of model; the last one is the largest value.
    errors
        Mean absolute error of each kind of model, and its standard deviation.
    """

    rows: int
    quartiles: Mapping[str, tuple[float, ...]]
    errors: Mapping[str, tuple[float, float]]

    def relative_error(self, kind: str) -> float:
        """Return the mean absolute error over the median prediction.

        Examples
        --------
        >>> round(published().relative_error("rbf"), 3)
        0.043
        """
        return self.errors[kind][0] / self.quartiles[kind][1]


@lru_cache
def published() -> Published:
    """Return the published results."""
    data = json.loads(FILE.read_text(encoding="utf-8"))
    quartiles = {kind: tuple(values) for kind, values in data["quartiles"].items()}
    errors = {kind: (mean, deviation) for kind, (mean, deviation) in data["errors"].items()}
    return Published(data["rows"], quartiles, errors)


def compare_with_published(quartiles: pd.DataFrame, errors: pd.DataFrame) -> list[str]:
    """Return sentences that say whether results for the ratio agree with the published ones.

    Parameters
    ----------
    quartiles, errors
        From `snowshed.analysis.regression.summary.quartile_table` and `error_table`.
    """
    known = published()
    checks = []
    error = errors["mean_absolute_error"]
    if "rbf" in error:
        rbf = float(error["rbf"])
        checks.append((rbf <= MAX_RBF_ERROR, f"RBF error {rbf:.4f}, "
                       f"at most {MAX_RBF_ERROR}"))  # fmt: skip
        part, most = float(errors["relative_error"]["rbf"]), known.relative_error("rbf")
        checks.append((part <= most, f"RBF error {part:.1%} of the median prediction, "
                       f"at most {most:.1%}"))  # fmt: skip
        if "linear" in error:
            times = float(error["linear"]) / rbf
            checks.append((times >= MIN_LINEAR_OVER_RBF, f"linear error {times:.1f} times the "
                           f"RBF's, at least {MIN_LINEAR_OVER_RBF}"))  # fmt: skip
    for kind in (kind for kind in known.quartiles if kind in quartiles.index):
        ours = quartiles.loc[kind].to_numpy(dtype=float)
        off = float(np.abs(ours / np.array(known.quartiles[kind]) - 1).max())
        checks.append((off <= MAX_QUARTILE_DEVIATION, f"{kind} quartiles off by up to {off:.0%} "
                       f"from Table 5.3.1, at most {MAX_QUARTILE_DEVIATION:.0%}"))  # fmt: skip
    lines = [f"{'holds' if good else 'DOES NOT HOLD'}: {words}" for good, words in checks]
    most = int(errors["most_seeds"].max())
    if most > 1:
        lines.append(
            f"note: the rows are means of up to {most} stacks, the thesis's are single stacks, "
            "which scatter more; --one-seed compares like with like"
        )
    return lines
