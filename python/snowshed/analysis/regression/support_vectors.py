"""epsilon-SVR for many parameters on one training set, as a grid search needs it."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import Optional

import numpy as np
from sklearn.svm import SVR

from snowshed._core import InputError
from snowshed.analysis.regression.interior_point import SupportVectors, solve
from snowshed.base.arrays import Floats

#: Largest number of iterations of libsvm; beyond it the interior point method is faster.
LIBSVM_ITERATIONS = 2500
LIBSVM_TOLERANCE = 1e-4  # of the targets' standard deviation; scikit-learn's default is 1e-3
#: A multiplier closer to its bound than this share of it counts as at the bound.
AT_BOUND = 1e-3


class NotConvergedError(InputError):
    """A fit that does not converge with its parameters."""


def fit_along_c(
    kernel: Floats, y: Floats, epsilon: float, c_values: Sequence[float]
) -> Iterator[SupportVectors]:
    """Fit an epsilon-SVR for each of several C, cheaper than one by one.

    scikit-learn's SVR (libsvm) solves the quick cases, an interior point method the others. If no
    multiplier reaches its bound, a larger bound changes nothing, and the fit is reused; if the tube
    contains all targets, the flattest function is a constant.

    Parameters
    ----------
    kernel
        Kernel matrix of the training set, shape (n, n).
    y
        Targets, shape (n,).
    epsilon
        Half width of the tube.
    c_values
        Values of C, ascending.

    Yields
    ------
    SupportVectors
        A fit for each C; the numbers of a fit that did not converge are NaN.
    """
    if np.ptp(y) <= 2 * epsilon:
        middle = SupportVectors(np.zeros(len(y)), float(y.min() + y.max()) / 2)
        yield from [middle] * len(c_values)
        return
    quick, fit, earlier = True, None, 0.0
    for c in c_values:
        if fit is None or not np.abs(fit.coefficients).max() <= (1 - AT_BOUND) * earlier:
            solution = _libsvm(kernel, y, c, epsilon) if quick else None
            quick = solution is not None
            fit = solution or _exact(kernel, y, c, epsilon)
        earlier = c
        yield fit


def fit_one(kernel: Floats, y: Floats, epsilon: float, c: float) -> SupportVectors:
    """Fit an epsilon-SVR for one C; see `fit_along_c`."""
    return next(fit_along_c(kernel, y, epsilon, [c]))


def _exact(kernel: Floats, y: Floats, c: float, epsilon: float) -> SupportVectors:
    try:
        return solve(kernel, y, c, epsilon)
    except FloatingPointError:  # a failed point: the search continues without it
        return SupportVectors(np.full(len(y), np.nan), float("nan"))


def _libsvm(kernel: Floats, y: Floats, c: float, epsilon: float) -> Optional[SupportVectors]:
    """Return scikit-learn's fit, or None if it would take long."""
    model = SVR(
        kernel="precomputed",
        C=c,
        epsilon=epsilon,
        max_iter=LIBSVM_ITERATIONS,
        tol=LIBSVM_TOLERANCE,
        cache_size=50,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # convergence is checked below
        model.fit(kernel, y)
    if model.fit_status_ != 0:
        return None
    coefficients = np.zeros(len(y))
    coefficients[model.support_] = model.dual_coef_[0]
    return SupportVectors(coefficients, float(model.intercept_[0]))
