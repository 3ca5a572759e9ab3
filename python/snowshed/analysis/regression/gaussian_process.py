"""A Gaussian process beside the support vector machines."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Optional

import numpy as np
from sklearn.base import BaseEstimator
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, Sum, WhiteKernel

from snowshed.analysis.regression.folds import ShuffledGroupKFold
from snowshed.analysis.regression.kernels import Expansion
from snowshed.base.arrays import Floats, Integers

#: Bounds of the hyper-parameters.
LENGTHS = (1e-2, 1e3)
AMPLITUDE = (1e-3, 1e5)
NOISE = (1e-7, 1e1)


@dataclass(frozen=True)
class GaussianProcess:
    """Squared exponential covariance with a length for each input, and white noise.

    Its hyper-parameters maximise the marginal likelihood, so that it needs no inner folds. As a
    predictor of the mean it is a sum of kernels like the support vector machines.

    Attributes
    ----------
    name, title, cost_s
        See `Kind`.
    """

    name: str = "gaussian-process"
    title: str = "Gaussian process"
    cost_s: float = 6.0

    def searcher(self, cv: ShuffledGroupKFold) -> LikelihoodSearch:
        """Return the search for the largest marginal likelihood; the folds are not needed."""
        return LikelihoodSearch()

    def estimator(self, parameters: Mapping[str, float]) -> GaussianProcessRegressor:
        """Return the process with these hyper-parameters, which training does not change."""
        lengths = [value for name, value in parameters.items() if name.startswith("length_")]
        covariance = _covariance(parameters["amplitude"], np.array(lengths), parameters["noise"])
        return GaussianProcessRegressor(covariance, alpha=0.0, optimizer=None)

    def expansion(self, model: GaussianProcessRegressor) -> Expansion:
        """Return the mean of a trained process as a sum of kernels."""
        signal = model.kernel_.k1
        rates = 0.5 / np.square(np.ravel(signal.k2.length_scale))
        weights = signal.k1.constant_value * model.alpha_
        return Expansion(model.X_train_, weights, 0.0, rates)


class LikelihoodSearch(BaseEstimator):
    """Search of the greatest marginal likelihood, with the interface of `GridSearchCV`.

    Attributes
    ----------
    best_params_
        ``amplitude`` and ``noise`` (variances), ``length_1``, ``length_2``, ... of the inputs.
    best_score_
        NaN: there are no folds to score on.
    best_estimator_
        The trained process.
    n_fits_
        1.
    """

    def fit(self, X: Floats, y: Floats, groups: Optional[Integers] = None) -> LikelihoodSearch:
        """Find the hyper-parameters of the rows, shapes (n, k) and (n,), and train with them."""
        model = GaussianProcessRegressor(_covariance(1.0, np.ones(X.shape[1]), 0.1), alpha=0.0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a length at its bound: the input has no effect
            model.fit(X, y)
        signal, noise = model.kernel_.k1, model.kernel_.k2
        lengths = np.ravel(signal.k2.length_scale)
        self.best_params_ = {
            "amplitude": float(signal.k1.constant_value),
            "noise": float(noise.noise_level),
            **{f"length_{number}": float(length) for number, length in enumerate(lengths, 1)},
        }
        self.best_score_, self.best_estimator_, self.n_fits_ = float("nan"), model, 1
        return self


def _covariance(amplitude: float, lengths: Floats, noise: float) -> Sum:
    signal = ConstantKernel(amplitude, AMPLITUDE) * RBF(lengths, LENGTHS)
    return signal + WhiteKernel(noise, NOISE)
