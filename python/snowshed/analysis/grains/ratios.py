"""Ratios of the stresses of variants to those of the base, sample by sample, with their scatter."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.grains.variants import BASE
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats

if TYPE_CHECKING:
    import pandas as pd

#: Figures that variants are compared by: peak below 5 % strain, and means between two strains.
STRESSES = {
    "strength_pa": "brittle (peak below 5 %)",
    "mean_stress_5_10_pa": "5 to 10 %",
    "mean_stress_10_15_pa": "10 to 15 %",
    "mean_stress_25_30_pa": "25 to 30 %",
}
CONFIDENCE = 0.95


@dataclass(frozen=True)
class LogMean:
    """The mean of logarithms, with its standard error from the scatter between samples.

    Attributes
    ----------
    mean
        NaN without a value.
    error
        NaN with fewer than two.
    count
        Number of values in the mean.
    """

    mean: float
    error: float
    count: int

    @classmethod
    def of(cls, values: Sequence[float]) -> LogMean:
        """Return the mean of the logarithms of the positive values."""
        positive = np.array([value for value in values if np.isfinite(value) and value > 0])
        if not positive.size:
            return cls(np.nan, np.nan, 0)
        logs = np.log(positive)
        error = float(logs.std(ddof=1) / np.sqrt(len(logs))) if len(logs) > 1 else np.nan
        return cls(float(logs.mean()), error, len(logs))

    @property
    def value(self) -> float:
        """The geometric mean."""
        return float(np.exp(self.mean))

    def interval(self) -> tuple[float, float]:
        """Return the 95 % interval of the geometric mean, by Student's t; NaN if not known."""
        if self.count < 2:
            return np.nan, np.nan
        from scipy import stats

        half = float(stats.t.ppf(0.5 + CONFIDENCE / 2, self.count - 1)) * self.error
        return float(np.exp(self.mean - half)), float(np.exp(self.mean + half))


@checked
def compare_variants(table: pd.DataFrame) -> pd.DataFrame:
    """Return the stresses of each variant relative to the base.

    Ratios are taken sample by sample, so that samples that differ from each other do not blur them.
    Means are geometric. Stresses that are not positive are left out.

    Parameters
    ----------
    table
        From `Comparison.table`.

    Returns
    -------
    pandas.DataFrame
        ``variant``, ``varied``, ``stress`` (one of `STRESSES`), ``samples``; ``value_pa``, the
        geometric mean, and ``scatter``, the standard deviation of its logarithm between samples;
        ``ratio`` to the base with ``low`` and ``high``, its 95 % interval by Student's t; and
        ``distinct``: whether 1 is outside (None with a single sample, and for the base).

    Raises
    ------
    InputError
        If the base is not computed, or has no stress.

    Examples
    --------
    >>> import pandas as pd
    >>> rows = [("base", 0, 10.0), ("base", 1, 20.0), ("soft", 0, 5.0), ("soft", 1, 11.0)]
    >>> table = pd.DataFrame(rows, columns=["variant", "sample", "strength_pa"])
    >>> found = compare_variants(table.assign(varied=table["variant"]))
    >>> found["ratio"].round(3).tolist(), found["distinct"].tolist()
    ([1.0, 0.524], [None, True])
    """
    import pandas as pd

    if BASE not in set(table["variant"]):
        raise InputError("no test of the base is computed yet")
    base = table.loc[table["variant"] == BASE, [name for name in STRESSES if name in table]]
    if not (base.astype(float) > 0).any(axis=None):
        raise InputError("the tests of the base have no stress; did the plates touch the snow?")
    rows = []
    for variant in dict.fromkeys(table["variant"]):
        own = table[table["variant"] == variant]
        for stress in (name for name in STRESSES if name in table):
            values = own.set_index("sample")[stress].astype(float)
            logs = LogMean.of(values.tolist())
            ratio = LogMean.of(paired_ratios(table, variant, stress).tolist())
            low, high = ratio.interval()
            has_scatter = variant != BASE and ratio.count > 1
            rows.append(
                {
                    "variant": variant,
                    "varied": own["varied"].iloc[0],
                    "stress": stress,
                    "samples": ratio.count,
                    "value_pa": logs.value,
                    "scatter": logs.error * np.sqrt(logs.count),
                    "ratio": ratio.value,
                    "low": low,
                    "high": high,
                    "distinct": bool(not low <= 1.0 <= high) if has_scatter else None,
                }
            )
    return pd.DataFrame(rows)


def paired_ratios(table: pd.DataFrame, variant: str, stress: str, base: str = BASE) -> Floats:
    """Return a variant's stress over another variant's, for each sample that has both, (n,)."""
    first, other = (
        table[table["variant"] == name].set_index("sample")[stress].astype(float)
        for name in (variant, base)
    )
    both = [sample for sample in first.index if sample in other.index]
    top, bottom = first.loc[both].to_numpy(), other.loc[both].to_numpy()
    positive = (top > 0) & (bottom > 0)
    return np.asarray(top[positive] / bottom[positive])
