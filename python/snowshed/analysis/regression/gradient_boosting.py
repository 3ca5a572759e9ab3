"""Gradient boosted trees beside the support vector machines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from snowshed.analysis.regression.kinds import (
    Choice,
    Development,
    Fitted,
    Parameters,
    median_absolute_error,
)
from snowshed.io.arrays import Floats
from snowshed.io.extras import require

DEPTHS = (2, 3, 4)
RATES = (0.1,)
MOST_TREES = 400
STEP = 10  # numbers of trees that are scored


@dataclass(frozen=True)
class GradientBoosting:
    """Boosted regression trees; depth and number of trees are chosen on the inner folds."""

    name: str = "gradient-boosting"
    title: str = "gradient boosting"
    cost_s: float = 5.0

    def search(self, development: Development) -> Choice:
        """Score each depth at every tenth number of trees."""
        grid = [(depth, rate) for depth in DEPTHS for rate in RATES]
        scores = np.array([self._scores(development, *point) for point in grid])
        best = np.unravel_index(np.argmin(scores), scores.shape)
        depth, rate = grid[best[0]]
        trees = (int(best[1]) + 1) * STEP
        parameters = {"depth": float(depth), "rate": rate, "trees": float(trees)}
        return Choice(parameters, float(scores[best]), len(grid) * len(development.splits))

    def fit(self, parameters: Parameters, inputs: Floats, targets: Floats) -> Fitted:
        """Train on all of the given rows."""
        model = _model(parameters["depth"], parameters["rate"], parameters["trees"])
        fitted: Fitted = model.fit(inputs, targets)
        return fitted

    def _scores(self, development: Development, depth: int, rate: float) -> Floats:
        """Return the mean score over the inner folds against the number of trees."""
        inputs, targets = development.inputs, development.targets
        scores = []
        for train, test in development.splits:
            model = _model(depth, rate, MOST_TREES).fit(inputs[train], targets[train])
            stages = list(model.staged_predict(inputs[test]))[STEP - 1 :: STEP]
            scores.append([median_absolute_error(stage - targets[test]) for stage in stages])
        return np.asarray(np.mean(scores, axis=0))


def _model(depth: float, rate: float, trees: float) -> Any:
    ensemble = require("sklearn.ensemble", "regression", "gradient boosting")
    return ensemble.GradientBoostingRegressor(
        max_depth=int(depth), learning_rate=rate, n_estimators=int(trees), random_state=0
    )
