"""Kernels of section 5.2.1, and functions that are sums of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from snowshed.base.arrays import Floats

#: Smaller kernel values are set to zero: arithmetic with denormal numbers is slow.
UNDERFLOW = 1e-100


def kernel_matrix(first: Floats, other: Floats, rates: Floats) -> Floats:
    """Return k(x, x') for all pairs.

    Parameters
    ----------
    first, other
        Points, shapes (m, k) and (n, k).
    rates
        Shape (k,): exp(-sum_d rates_d (x_d - x'_d)^2), the RBF kernel whose gamma may differ from
        input to input; empty: the linear kernel x . x'.

    Returns
    -------
    numpy.ndarray
        Shape (m, n).

    Examples
    --------
    >>> x = np.array([[0.0], [1.0]])
    >>> kernel_matrix(x, x, np.array([])).tolist()
    [[0.0, 0.0], [0.0, 1.0]]
    >>> kernel_matrix(x, x, np.array([np.log(2)])).round(6).tolist()
    [[1.0, 0.5], [0.5, 1.0]]
    """
    if len(rates) == 0:
        return np.asarray(first @ other.T)
    squares = np.zeros((len(first), len(other)))
    for rate, a, b in zip(rates, first.T, other.T):
        squares += rate * (a[:, None] - b[None, :]) ** 2
    values = np.exp(-squares)
    values[values < UNDERFLOW] = 0.0
    return np.asarray(values)


@dataclass(frozen=True)
class Expansion:
    """f(x) = sum_i coefficients_i k(x_i, x) + intercept (5.2.11).

    Attributes
    ----------
    points
        x_i, shape (n, k), standardised.
    coefficients
        Shape (n,).
    intercept
        b.
    rates
        As for `kernel_matrix`.
    """

    points: Floats
    coefficients: Floats
    intercept: float
    rates: Floats

    def predict(self, inputs: Floats) -> Floats:
        """Return f at points of shape (m, k): shape (m,)."""
        kernel = kernel_matrix(inputs, self.points, self.rates)
        return np.asarray(kernel @ self.coefficients + self.intercept)
