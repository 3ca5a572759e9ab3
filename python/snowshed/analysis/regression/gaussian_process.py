"""A Gaussian process beside the support vector machines."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from snowshed.analysis.regression.kernels import Expansion, kernel_matrix
from snowshed.analysis.regression.kinds import Choice, Development, Parameters
from snowshed.io.arrays import Floats
from snowshed.io.extras import require

LENGTHS = (1e-2, 1e3)
AMPLITUDE = (1e-3, 1e5)
NOISE = (1e-7, 1e1)


@dataclass(frozen=True)
class GaussianProcess:
    """Squared exponential covariance with a length for each input, and white noise.

    Its hyper-parameters maximise the marginal likelihood of the development set, so that it needs
    no inner folds. As a predictor of the mean it is a sum of kernels like the others.
    """

    name: str = "gaussian-process"
    title: str = "Gaussian process"
    cost_s: float = 6.0

    def search(self, development: Development) -> Choice:
        """Maximise the marginal likelihood."""
        gp = require("sklearn.gaussian_process", "regression", "Gaussian process regression")
        inputs, targets = development.inputs, development.targets
        kernels = gp.kernels
        lengths = np.ones(inputs.shape[1])
        covariance = kernels.ConstantKernel(1.0, AMPLITUDE) * kernels.RBF(lengths, LENGTHS)
        covariance += kernels.WhiteKernel(0.1, NOISE)
        model = gp.GaussianProcessRegressor(covariance, alpha=0.0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that a length is at its bound: the input is no matter
            model.fit(inputs[development.rows], targets[development.rows])
        signal, noise = model.kernel_.k1, model.kernel_.k2
        found = {
            "amplitude": float(signal.k1.constant_value),
            "noise": float(noise.noise_level),
            **{f"length_{i}": float(x) for i, x in enumerate(np.ravel(signal.k2.length_scale), 1)},
        }
        return Choice(found, float("nan"), 1)

    def fit(self, parameters: Parameters, inputs: Floats, targets: Floats) -> Expansion:
        """Return the mean of the process, given all of the rows."""
        linalg: Any = require("scipy.linalg", "regression", "Gaussian process regression")
        lengths = [parameters[f"length_{i}"] for i in range(1, inputs.shape[1] + 1)]
        rates = 0.5 / np.square(lengths)
        covariance = parameters["amplitude"] * kernel_matrix(inputs, inputs, rates)
        np.einsum("ii->i", covariance)[...] += parameters["noise"]
        weights = linalg.cho_solve(linalg.cho_factor(covariance), targets)
        return Expansion(inputs, parameters["amplitude"] * weights, 0.0, rates)
