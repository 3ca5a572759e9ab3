"""The kinds of model whose hyper-parameters a grid search chooses, section 5.2.3."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Optional, Union

from sklearn.base import clone

from snowshed.analysis.regression.folds import ShuffledGroupKFold
from snowshed.analysis.regression.gradient_boosting import StagedGradientBoosting
from snowshed.analysis.regression.kernels import Expansion
from snowshed.analysis.regression.path_search import Grid, PathSearchCV
from snowshed.analysis.regression.svr import EpsilonSVR

Model = Union[EpsilonSVR, StagedGradientBoosting]

#: The grid of section 5.2.3: powers of ten.
EPSILON = tuple(10.0**power for power in range(-4, 3))
C = tuple(10.0**power for power in range(-3, 5))
GAMMA = tuple(10.0**power for power in range(-4, 3))
#: Grid of the boosted trees.
DEPTHS = (2, 3, 4)
TREES = tuple(range(10, 401, 10))


@dataclass(frozen=True)
class GridKind:
    """A kind of model with a grid of hyper-parameters.

    Attributes
    ----------
    name, title, cost_s
        See `Kind`.
    model
        The estimator, with the common parameters of all points of the grid.
    grid
        Values of each hyper-parameter.
    """

    name: str
    title: str
    cost_s: float
    model: Model
    grid: Grid

    def searcher(self, cv: ShuffledGroupKFold) -> PathSearchCV:
        """Return the search of the grid on these folds."""
        return PathSearchCV(self.model, self.grid, cv=cv)

    def estimator(self, parameters: Mapping[str, float]) -> Model:
        """Return the model with these hyper-parameters, not trained."""
        model: Model = clone(self.model).set_params(**parameters)
        return model

    def expansion(self, model: object) -> Optional[Expansion]:
        """Return a trained model as a sum of kernels, if it is one."""
        return model.expansion_ if isinstance(model, EpsilonSVR) else None


def linear_svr() -> GridKind:
    """Return the support vector regression with linear kernel."""
    grid = {"epsilon": EPSILON, "C": C}
    return GridKind("linear", "linear SVR", 2.0, EpsilonSVR("linear"), grid)


def rbf_svr() -> GridKind:
    """Return the support vector regression with RBF kernel."""
    grid = {"epsilon": EPSILON, "C": C, "gamma": GAMMA}
    return GridKind("rbf", "RBF SVR", 10.0, EpsilonSVR("rbf"), grid)


def gradient_boosting() -> GridKind:
    """Return the boosted trees, with their depth and number to be chosen."""
    grid = {"max_depth": DEPTHS, "n_estimators": TREES}
    model = StagedGradientBoosting(learning_rate=0.1, random_state=0)
    return GridKind("gradient-boosting", "gradient boosting", 5.0, model, grid)
