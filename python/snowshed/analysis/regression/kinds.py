"""The kinds of model that are compared, by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, Sequence

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.regression.folds import Split
from snowshed.io.arrays import Floats, Integers

Parameters = Mapping[str, float]


@dataclass(frozen=True)
class Development:
    """What a model may be chosen and trained on.

    Attributes
    ----------
    inputs, targets
        All rows, standardised: shapes (n, k) and (n,).
    rows
        The rows of the development set.
    splits
        Its inner folds.
    """

    inputs: Floats
    targets: Floats
    rows: Integers
    splits: Sequence[Split]


@dataclass(frozen=True)
class Choice:
    """What a search found.

    Attributes
    ----------
    parameters
        Hyper-parameters of the best model.
    score
        Its median absolute error, mean over the inner folds; NaN if the search needs none.
    fits
        Models that were fitted for it.
    """

    parameters: Parameters
    score: float
    fits: int


class Fitted(Protocol):
    """A trained model."""

    def predict(self, inputs: Floats) -> Floats:
        """Return predictions, shape (m,), for standardised inputs of shape (m, k)."""


class Kind(Protocol):
    """A kind of model: how its hyper-parameters are chosen, and how it is trained."""

    @property
    def name(self) -> str:
        """Its name in files and options."""

    @property
    def title(self) -> str:
        """Its name in figures and tables."""

    @property
    def cost_s(self) -> float:
        """Roughly how long one outer fold of 600 rows takes, s; for the time left."""

    def search(self, development: Development) -> Choice:
        """Choose hyper-parameters."""

    def fit(self, parameters: Parameters, inputs: Floats, targets: Floats) -> Fitted:
        """Train a model."""


def median_absolute_error(errors: Floats) -> float:
    """Return the score of section 5.2.4; smaller is better."""
    return float(np.median(np.abs(errors)))


def kinds() -> dict[str, Kind]:
    """Return all kinds by name, those of the thesis first."""
    from snowshed.analysis.regression.gaussian_process import GaussianProcess
    from snowshed.analysis.regression.gradient_boosting import GradientBoosting
    from snowshed.analysis.regression.svr_kinds import linear_svr, rbf_svr

    every: list[Kind] = [linear_svr(), rbf_svr(), GaussianProcess(), GradientBoosting()]
    return {kind.name: kind for kind in every}


def kinds_named(names: Sequence[str]) -> dict[str, Kind]:
    """Return some kinds by name.

    Raises
    ------
    InputError
        If there is no such kind.
    """
    every = kinds()
    for name in names:
        if name not in every:
            raise InputError(f"model: {name!r} is unknown; allowed: {', '.join(every)}")
    return {name: kind for name, kind in every.items() if not names or name in names}
