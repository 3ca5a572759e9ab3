"""The kinds of model that are compared, by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Optional, Protocol

from snowshed._core import InputError
from snowshed.analysis.regression.folds import ShuffledGroupKFold
from snowshed.analysis.regression.kernels import Expansion
from snowshed.base.arrays import Floats, Integers
from snowshed.base.extras import require

Parameters = Mapping[str, float]


class Regressor(Protocol):
    """An estimator of scikit-learn, or one with its interface."""

    def fit(self, X: Floats, y: Floats) -> Regressor:
        """Train on inputs, shape (n, k), and targets, shape (n,)."""

    def predict(self, X: Floats) -> Floats:
        """Return predictions, shape (m,), for inputs of shape (m, k)."""


class Searcher(Protocol):
    """A search of hyper-parameters, with the interface of scikit-learn's `GridSearchCV`."""

    best_params_: Parameters
    best_score_: float
    best_estimator_: Regressor
    n_fits_: int

    def fit(self, X: Floats, y: Floats, groups: Optional[Integers] = None) -> Searcher:
        """Choose hyper-parameters, and train with them on all of the rows."""


class Kind(Protocol):
    """A kind of model: the choice of its hyper-parameters, and its training."""

    @property
    def name(self) -> str:
        """Name of the kind in files and options."""

    @property
    def title(self) -> str:
        """Name of the kind in figures and tables."""

    @property
    def cost_s(self) -> float:
        """Approximate time of one outer fold of 600 rows, s, to estimate the remaining time."""

    def searcher(self, cv: ShuffledGroupKFold) -> Searcher:
        """Return a search of hyper-parameters on these inner folds."""

    def estimator(self, parameters: Parameters) -> Regressor:
        """Return the model with these hyper-parameters, not trained."""

    def expansion(self, model: Regressor) -> Optional[Expansion]:
        """Return a trained model as a sum of kernels, if it is one."""


def kinds() -> dict[str, Kind]:
    """Return all kinds by name; the kinds of the thesis come first.

    Raises
    ------
    InputError
        If scikit-learn (extra ``regression``) is not installed.
    """
    require("sklearn", "regression", "regression")  # imported late: these modules import this one
    from snowshed.analysis.regression import grid_kinds
    from snowshed.analysis.regression.gaussian_process import GaussianProcess

    every: list[Kind] = [
        grid_kinds.linear_svr(),
        grid_kinds.rbf_svr(),
        GaussianProcess(),
        grid_kinds.gradient_boosting(),
    ]
    return {kind.name: kind for kind in every}


def kinds_named(names: Sequence[str]) -> dict[str, Kind]:
    """Return the named kinds; all kinds if no name is given.

    Raises
    ------
    InputError
        If there is no such kind, or scikit-learn is not installed.
    """
    every = kinds()
    for name in names:
        if name not in every:
            raise InputError(f"model: {name!r} is unknown; allowed: {', '.join(every)}")
    return {name: kind for name, kind in every.items() if not names or name in names}
