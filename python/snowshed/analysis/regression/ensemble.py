"""The models that the outer folds elected, as one predictor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from snowshed.analysis.regression.fold_result import FoldResult
from snowshed.analysis.regression.kernels import kernel_matrix
from snowshed.base.arrays import Floats


@dataclass(frozen=True)
class Ensemble:
    """Kernel models over the same points, (5.2.11), each with its own parameters.

    Attributes
    ----------
    points
        Standardised inputs of all rows, shape (n, k).
    coefficients
        Shape (m, n): zero where a model did not see the row.
    intercepts
        Shape (m,).
    rates
        Shape (m, k) for RBF kernels, (m, 0) for linear ones; see `kernel_matrix`.
    """

    points: Floats
    coefficients: Floats
    intercepts: Floats
    rates: Floats

    @classmethod
    def of(cls, results: Sequence[FoldResult]) -> Ensemble:
        """Return the ensemble of models that are sums of kernels."""
        models = [result.expansion for result in results if result.expansion is not None]
        return cls(
            models[0].points,
            np.stack([model.coefficients for model in models]),
            np.array([model.intercept for model in models]),
            np.stack([model.rates for model in models]),
        )

    def predict(self, inputs: Floats) -> Floats:
        """Return the prediction of each model for each point.

        Parameters
        ----------
        inputs
            Standardised, shape (q, k).

        Returns
        -------
        numpy.ndarray
            Shape (m, q), standardised.
        """
        predictions = np.empty((len(self.intercepts), len(inputs)))
        different, which = np.unique(self.rates, axis=0, return_inverse=True)
        for number, rates in enumerate(different):
            models = np.ravel(which) == number
            kernel = kernel_matrix(inputs, self.points, rates)
            predictions[models] = (
                self.coefficients[models] @ kernel.T + self.intercepts[models, None]
            )
        return predictions
