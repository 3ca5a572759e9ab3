"""Standardised columns (5.2.12): zero mean, unit variance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from snowshed.base.arrays import Floats


@dataclass(frozen=True)
class Scaling:
    """X' = (X - mean) / deviation, equation (5.2.12), column by column.

    Attributes
    ----------
    mean, deviation
        Shape (k,). A column that does not vary has the deviation 1.

    Examples
    --------
    >>> scaling = Scaling.of(np.array([[1.0, 5.0], [5.0, 5.0]]))
    >>> scaling.scaled(np.array([[3.0, 5.0], [5.0, 6.0]])).tolist()
    [[0.0, 0.0], [1.0, 1.0]]
    """

    mean: Floats
    deviation: Floats

    @classmethod
    def of(cls, columns: Floats) -> Scaling:
        """Return the scaling that standardises these columns, shape (n, k)."""
        deviation = columns.std(axis=0)
        return cls(columns.mean(axis=0), np.where(deviation > 0, deviation, 1.0))

    def scaled(self, columns: Floats) -> Floats:
        """Return columns of the same kind, standardised."""
        return np.asarray((columns - self.mean) / self.deviation)
