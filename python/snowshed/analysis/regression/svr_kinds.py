"""Linear and RBF epsilon-SVR with the grid search of section 5.2.3."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.regression.kernels import Expansion, kernel_matrix
from snowshed.analysis.regression.kinds import (
    Choice,
    Development,
    Parameters,
    median_absolute_error,
)
from snowshed.analysis.regression.support_vectors import fit_along_c, fit_one
from snowshed.io.arrays import Floats

#: The grid of section 5.2.3: powers of ten.
EPSILON = tuple(10.0**power for power in range(-4, 3))
C = tuple(10.0**power for power in range(-3, 5))
GAMMA = tuple(10.0**power for power in range(-4, 3))


@dataclass(frozen=True)
class SupportVectorRegression:
    """epsilon-SVR with one of the two kernels.

    Attributes
    ----------
    name, title, cost_s
        See `Kind`.
    gammas
        Of the RBF kernel; empty: the linear kernel.
    """

    name: str
    title: str
    cost_s: float
    gammas: tuple[float, ...]

    def search(self, development: Development) -> Choice:
        """Score every point of the grid on every inner fold; the kernel is shared."""
        rates = [self._rates(gamma, development.inputs) for gamma in self.gammas or (0.0,)]
        scores = np.zeros((len(rates), len(EPSILON), len(C)))
        for number, rate in enumerate(rates):
            kernel = kernel_matrix(development.inputs, development.inputs, rate)
            mean = np.mean(list(self._fold_scores(development, kernel)), axis=0)
            scores[number] = np.where(np.isnan(mean), np.inf, mean)  # NaN: did not converge
        best = np.unravel_index(np.argmin(scores), scores.shape)
        gamma = {"gamma": self.gammas[best[0]]} if self.gammas else {}
        parameters = {"epsilon": EPSILON[best[1]], "C": C[best[2]], **gamma}
        return Choice(parameters, float(scores[best]), scores.size * len(development.splits))

    def fit(self, parameters: Parameters, inputs: Floats, targets: Floats) -> Expansion:
        """Train on all of the given rows."""
        rates = self._rates(parameters.get("gamma", 0.0), inputs)
        kernel = kernel_matrix(inputs, inputs, rates)
        found = fit_one(kernel, targets, parameters["epsilon"], parameters["C"])
        if np.isnan(found.intercept):
            chosen = ", ".join(f"{name} {value:g}" for name, value in parameters.items())
            raise InputError(f"the {self.title} with {chosen} does not converge on these rows")
        return Expansion(inputs, found.coefficients, found.intercept, rates)

    def _rates(self, gamma: float, inputs: Floats) -> Floats:
        return np.full(inputs.shape[1] if self.gammas else 0, gamma)

    def _fold_scores(self, development: Development, kernel: Floats) -> Iterator[Floats]:
        """Yield for each inner fold the scores over epsilon and C."""
        targets = development.targets
        for train, test in development.splits:
            own = np.asfortranarray(kernel[np.ix_(train, train)])
            other = kernel[np.ix_(test, train)]
            yield np.array(
                [
                    [
                        median_absolute_error(
                            other @ fit.coefficients + fit.intercept - targets[test]
                        )
                        for fit in fit_along_c(own, targets[train], epsilon, C)
                    ]
                    for epsilon in EPSILON
                ]
            )


def linear_svr() -> SupportVectorRegression:
    """Return the kind with the linear kernel."""
    return SupportVectorRegression("linear", "linear SVR", 2.0, ())


def rbf_svr() -> SupportVectorRegression:
    """Return the kind with the RBF kernel."""
    return SupportVectorRegression("rbf", "RBF SVR", 10.0, GAMMA)
