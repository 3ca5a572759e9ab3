"""The epsilon-SVR of section 5.2.1 as an estimator of scikit-learn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike
from sklearn.base import BaseEstimator, RegressorMixin
from sklearn.utils.validation import check_is_fitted, validate_data

from snowshed._core import InputError
from snowshed.analysis.regression.kernels import Expansion, kernel_matrix
from snowshed.analysis.regression.support_vectors import NotConvergedError, fit_along_c, fit_one
from snowshed.base.arrays import Floats

KERNELS = ("linear", "rbf")


class EpsilonSVR(RegressorMixin, BaseEstimator):
    """Support vector regression with an epsilon-insensitive loss.

    It solves the same problem as scikit-learn's `SVR`, and can be used in its pipelines and
    searches. Where libsvm would need millions of iterations (large C, few inputs), an interior
    point method takes over.

    Parameters
    ----------
    kernel
        "rbf", ``exp(-gamma |x - x'|^2)``, or "linear", ``x . x'``.
    C
        Bound of the multipliers, positive: how much an error beyond the tube costs.
    epsilon
        Half width of the tube in which errors cost nothing, in the target's unit.
    gamma
        Rate of the RBF kernel, positive; the linear kernel has none.

    Attributes
    ----------
    expansion_
        The fitted function, a sum of kernels (5.2.11).
    n_features_in_
        Number of inputs.

    References
    ----------
    Smola, A. J., Schölkopf, B.: A tutorial on support vector regression. Statistics and Computing
    14 (2004), 199-222.

    Examples
    --------
    >>> x = np.linspace(0, 3, 20)[:, None]
    >>> model = EpsilonSVR(C=100.0, epsilon=0.001).fit(x, np.sin(x[:, 0]))
    >>> round(float(model.predict([[1.0]])[0]), 2)
    0.84
    """

    #: Hyper-parameters that `path_predictions` varies.
    path_parameters = ("epsilon", "C")

    def __init__(
        self, kernel: str = "rbf", C: float = 1.0, epsilon: float = 0.1, gamma: float = 1.0
    ) -> None:
        self.kernel = kernel
        self.C = C
        self.epsilon = epsilon
        self.gamma = gamma

    def fit(self, X: ArrayLike, y: ArrayLike) -> EpsilonSVR:
        """Fit the function to rows.

        Parameters
        ----------
        X
            Inputs, shape (n, k).
        y
            Targets, shape (n,).

        Raises
        ------
        InputError
            If a parameter is out of range, or the fit does not converge.
        """
        self._check()
        points, targets = validate_data(self, X, y, y_numeric=True, dtype=np.float64)
        targets = np.asarray(targets, dtype=np.float64)
        rates = self._rates(points)
        solution = fit_one(kernel_matrix(points, points, rates), targets, self.epsilon, self.C)
        if np.isnan(solution.intercept):
            raise NotConvergedError(f"the {self._description()} does not converge on these rows")
        self.expansion_ = Expansion(points, solution.coefficients, solution.intercept, rates)
        return self

    def predict(self, X: ArrayLike) -> Floats:
        """Return the function's values, shape (n,), at inputs of shape (n, k)."""
        check_is_fitted(self)
        return self.expansion_.predict(validate_data(self, X, dtype=np.float64, reset=False))

    def path_predictions(
        self, X: Floats, y: Floats, at: Floats, grid: Mapping[str, Sequence[float]]
    ) -> Iterator[Floats]:
        """Fit every epsilon and C of a grid, and yield the predictions of each fit.

        All fits share the kernel matrix. For one epsilon, `fit_along_c` reuses a fit where it can.

        Parameters
        ----------
        X, y
            Training rows, shapes (n, k) and (n,).
        at
            Inputs to predict, shape (m, k).
        grid
            Values of "epsilon" and of "C", the latter ascending.

        Yields
        ------
        numpy.ndarray
            Shape (m,), for each epsilon and, within it, each C; NaN where a fit did not converge.
        """
        rates = self._rates(X)
        kernel = np.asfortranarray(kernel_matrix(X, X, rates))
        across = kernel_matrix(at, X, rates)
        for epsilon in grid["epsilon"]:
            for fit in fit_along_c(kernel, y, epsilon, grid["C"]):
                yield across @ fit.coefficients + fit.intercept

    def path_fits(self, grid: Mapping[str, Sequence[float]]) -> int:
        """Return the number of models behind `path_predictions`."""
        return len(grid["epsilon"]) * len(grid["C"])

    def _check(self) -> None:
        if self.kernel not in KERNELS:
            raise InputError(f"kernel: {self.kernel!r} is unknown; allowed: {', '.join(KERNELS)}")
        for name, good, allowed in (
            ("C", self.C > 0, "positive"),
            ("epsilon", self.epsilon >= 0, "zero or positive"),
            ("gamma", self.gamma > 0, "positive"),
        ):
            if not good:
                raise InputError(f"{name}: {getattr(self, name)!r} is not {allowed}")

    def _rates(self, X: Floats) -> Floats:
        return np.full(X.shape[1] if self.kernel == "rbf" else 0, float(self.gamma))

    def _description(self) -> str:
        names = ("epsilon", "C", "gamma") if self.kernel == "rbf" else ("epsilon", "C")
        values = ", ".join(f"{name} {getattr(self, name):g}" for name in names)
        return f"SVR with {self.kernel} kernel, {values}"
