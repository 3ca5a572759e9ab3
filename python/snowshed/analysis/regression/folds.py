"""The nested cross-validation of section 5.2.3: training, test and validation rows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from snowshed._core import InputError
from snowshed.analysis.regression.rows import StackRows
from snowshed.base.arguments import checked
from snowshed.base.arrays import Integers

Split = tuple[Integers, Integers]
SPLIT_UNITS = ("rows", "panels")


@dataclass(frozen=True)
class ShuffledGroupKFold:
    """Folds of whole groups in random order, with the interface of scikit-learn's splitters.

    scikit-learn's own `KFold` and `GroupKFold` shuffle by NumPy's old random numbers and so cannot
    give the folds of the published models. Published folds consist of rows, folds here of groups.

    Attributes
    ----------
    n_splits
        Number of folds.
    seeds
        Seeds of the random order.

    Examples
    --------
    >>> folds = ShuffledGroupKFold(2, (1,))
    >>> for train, test in folds.split(np.zeros((5, 1)), groups=[7, 7, 8, 9, 9]):
    ...     print(train.tolist(), test.tolist())
    [3, 4] [0, 1, 2]
    [0, 1, 2] [3, 4]
    """

    n_splits: int
    seeds: tuple[int, ...]

    def get_n_splits(
        self,
        X: Optional[ArrayLike] = None,
        y: Optional[ArrayLike] = None,
        groups: Optional[ArrayLike] = None,
    ) -> int:
        """Return the number of folds; the arguments are scikit-learn's and do not matter."""
        return self.n_splits

    def split(
        self, X: ArrayLike, y: Optional[ArrayLike] = None, groups: Optional[ArrayLike] = None
    ) -> Iterator[Split]:
        """Yield the rows to train on and the rows to test on, fold by fold.

        Parameters
        ----------
        X
            Shape (n, k); only n matters.
        y
            Does not matter.
        groups
            The group of each row, shape (n,); None: each row is a group.

        Yields
        ------
        tuple
            Indices of training and test rows, ascending. The numbers of groups in the folds differ
            by one at most.
        """
        of_row = np.arange(len(np.asarray(X))) if groups is None else np.asarray(groups)
        shuffled = np.random.default_rng(list(self.seeds)).permutation(np.unique(of_row))
        for fold in np.array_split(shuffled, self.n_splits):
            tested = np.isin(of_row, fold)
            yield np.flatnonzero(~tested), np.flatnonzero(tested)


@checked
@dataclass(frozen=True)
class CrossValidation:
    """Rounds of outer folds, each with inner folds.

    Attributes
    ----------
    rounds, folds, inner_folds
        Section 5.2.3: 10 repetitions of a 10-fold outer loop around a 5-fold inner loop.
    seed
        Random seed of the splits.
    by
        "rows", as in the thesis: rows are split, so that other events of a validation row's panel
        may be trained on. "panels": all events of a panel stay together, so that the validation
        score is that of an unseen panel.
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
        if self.by not in SPLIT_UNITS:
            raise InputError(f"by: {self.by!r} is unknown; allowed: {', '.join(SPLIT_UNITS)}")

    def check(self, rows: StackRows) -> None:
        """Raise an InputError if there are too few rows or panels for the number of folds."""
        panels = rows.panel_count
        if panels < 2:
            raise InputError("all rows are of one panel; at least 2 panels are needed")
        count = len(rows) if self.by == "rows" else panels
        if count < self.folds * self.inner_folds:
            raise InputError(
                f"{count} {self.by} are too few for {self.folds} x {self.inner_folds} folds; at "
                f"least {self.folds * self.inner_folds} are needed, or fewer folds"
            )

    def groups(self, rows: StackRows) -> Integers:
        """Return the group of each row, shape (n,); no fold splits a group."""
        return np.arange(len(rows)) if self.by == "rows" else rows.panels

    def outer(self, round_: int) -> ShuffledGroupKFold:
        """Return the folds that split all rows into development and validation sets."""
        return ShuffledGroupKFold(self.folds, (self.seed, round_))

    def inner(self, round_: int, fold: int) -> ShuffledGroupKFold:
        """Return the folds that split the development set of an outer fold."""
        return ShuffledGroupKFold(self.inner_folds, (self.seed, round_, fold))
