"""The nested cross-validation of section 5.2.3: which rows train, test and validate."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.regression.rows import StackRows
from snowshed.io.arrays import Integers

Split = tuple[Integers, Integers]
BY = ("rows", "panels")


@dataclass(frozen=True)
class CrossValidation:
    """Rounds of outer folds, each with inner folds.

    Attributes
    ----------
    rounds, folds, inner_folds
        Section 5.2.3: 10 repetitions of a 10-fold outer loop around a 5-fold inner loop.
    seed
        Of the random splits.
    by
        "rows", as in the thesis: rows are split, so that other events of a validation row's panel
        may be trained on. "panels": all events of a panel stay together, so that the validation
        score is that of a panel never seen.
    """

    rounds: int = 10
    folds: int = 10
    inner_folds: int = 5
    seed: int = 1
    by: str = "rows"

    def __post_init__(self) -> None:
        for name, least in (("rounds", 1), ("folds", 2), ("inner_folds", 2), ("seed", 0)):
            if getattr(self, name) < least:
                raise InputError(f"{name}: {getattr(self, name)} is below {least}")
        if self.by not in BY:
            raise InputError(f"by: {self.by!r} is unknown; allowed: {', '.join(BY)}")

    def check(self, rows: StackRows) -> None:
        """Raise an InputError if there are too few rows or panels for so many folds."""
        panels = rows.panel_count
        if panels < 2:
            raise InputError("all rows are of one panel; at least 2 panels are needed")
        count = len(rows) if self.by == "rows" else panels
        if count < self.folds * self.inner_folds:
            raise InputError(
                f"{count} {self.by} are too few for {self.folds} x {self.inner_folds} folds; at "
                f"least {self.folds * self.inner_folds} are needed, or fewer folds"
            )

    def outer(self, rows: StackRows, round_: int) -> list[Split]:
        """Return (development, validation) rows for each outer fold of a round."""
        everything = np.arange(len(rows))
        return list(self._split(rows, everything, self.folds, [self.seed, round_]))

    def inner(self, rows: StackRows, development: Integers, round_: int, fold: int) -> list[Split]:
        """Return (training, test) rows for each inner fold."""
        key = [self.seed, round_, fold]
        return list(self._split(rows, development, self.inner_folds, key))

    def _split(
        self, rows: StackRows, among: Integers, folds: int, key: list[int]
    ) -> Iterator[Split]:
        units = among if self.by == "rows" else rows.panels[among]
        for rest in shuffled_parts(np.unique(units), folds, key):
            held_out = np.isin(units, rest)
            yield among[~held_out], among[held_out]


def shuffled_parts(units: Integers, folds: int, key: list[int]) -> list[Integers]:
    """Return a random partition into parts whose sizes differ by one at most.

    Examples
    --------
    >>> parts = shuffled_parts(np.arange(7), 3, [1])
    >>> [len(part) for part in parts], sorted(np.concatenate(parts).tolist())
    ([3, 2, 2], [0, 1, 2, 3, 4, 5, 6])
    """
    return np.array_split(np.random.default_rng(key).permutation(units), folds)
