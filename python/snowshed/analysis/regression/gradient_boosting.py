"""Gradient boosted trees, fitted once for all sizes of the ensemble."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from sklearn.base import clone
from sklearn.ensemble import GradientBoostingRegressor

from snowshed.base.arrays import Floats


class StagedGradientBoosting(GradientBoostingRegressor):
    """scikit-learn's gradient boosting, whose search sees each stage of a single fit."""

    #: Hyper-parameters that `path_predictions` varies.
    path_parameters = ("n_estimators",)

    def path_predictions(
        self, X: Floats, y: Floats, at: Floats, grid: Mapping[str, Sequence[int]]
    ) -> Iterator[Floats]:
        """Train the largest ensemble of a grid; yield its predictions with fewer trees.

        Parameters
        ----------
        X, y
            Training rows, shapes (n, k) and (n,).
        at
            Inputs to predict, shape (m, k).
        grid
            Values of "n_estimators".

        Yields
        ------
        numpy.ndarray
            Shape (m,), for each number of trees.
        """
        trees = grid["n_estimators"]
        model = clone(self).set_params(n_estimators=max(trees)).fit(X, y)
        stages = list(model.staged_predict(at))
        for count in trees:
            yield np.asarray(stages[count - 1])

    def path_fits(self, grid: Mapping[str, Sequence[int]]) -> int:
        """Return the number of models that `path_predictions` fits: one."""
        return 1
