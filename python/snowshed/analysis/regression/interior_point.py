"""The dual problem of the epsilon-SVR, (5.2.9) and (5.2.10), by an interior point method.

libsvm's decomposition changes two multipliers at a time. With a large C and few inputs it takes
millions of such changes; here a dozen Newton steps suffice, each a Cholesky factorisation of a
matrix of the size of the training set, for any parameters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import lapack

from snowshed.base.arrays import Floats

MAX_STEPS = 80
INTERIOR = 0.995  # largest share of the distance to the boundary in a step
MIN_STEP = 1e-8  # smallest step that makes progress
ROUNDING = 1e-12  # of the largest diagonal element of the kernel
DIVERGENCE_RATIO = 1e6  # a residual above this many times the smallest one ends the fit
MAX_RESIDUAL = 1e-2  # largest relative residual of a fit
MIN_OBJECTIVE = 1e-3  # added to the objective in the relative gap


@dataclass(frozen=True)
class SupportVectors:
    """A regression function f(x) = sum_i coefficients_i k(x_i, x) + intercept (5.2.11).

    Attributes
    ----------
    coefficients
        alpha_i - alpha_i^*, shape (n,).
    intercept
        b.
    """

    coefficients: Floats
    intercept: float


@dataclass
class _Bounds:
    """Multipliers alpha (or alpha^*) in (0, C), slacks C - alpha, and multipliers of both bounds.

    The slack is kept beside the value because the difference C - value would lose its digits.
    """

    value: Floats
    room: Floats
    lower: Floats
    upper: Floats


@dataclass
class _Move:
    """A Newton step of all unknowns."""

    alpha: _Bounds
    alpha_star: _Bounds
    intercept: float


def solve(
    kernel: Floats, y: Floats, c: float, epsilon: float, *, tolerance: float = 1e-5
) -> SupportVectors:
    """Fit an epsilon-SVR exactly.

    The Newton system is reduced to one positive definite matrix, kernel plus a diagonal, as in the
    appendix of Smola and Schölkopf (2004); predictor and corrector (Mehrotra) share its factors.

    Parameters
    ----------
    kernel
        k(x_i, x_j), shape (n, n), positive semidefinite.
    y
        Targets, shape (n,).
    c, epsilon
        Bound of the multipliers, and half width of the tube in which errors cost nothing.
    tolerance
        Tolerance of the relative gap between primal and dual objective.

    Raises
    ------
    FloatingPointError
        If the kernel is not positive semidefinite, or the fit does not converge.

    Examples
    --------
    >>> x = np.array([0.0, 1.0, 2.0])
    >>> line = solve(np.outer(x, x), 2 * x, c=100.0, epsilon=0.0)
    >>> [round(float(value), 4) for value in np.outer(x, x) @ line.coefficients + line.intercept]
    [0.0, 2.0, 4.0]
    """
    return _Iteration(kernel, y, c, epsilon).run(tolerance)


class _Iteration:
    """The unknowns of one fit, and the factors of the Newton system."""

    def __init__(self, kernel: Floats, y: Floats, c: float, epsilon: float) -> None:
        self._factorise, self._substitute = lapack.dpotrf, lapack.dpotrs
        self._kernel = np.asfortranarray(kernel)
        self._matrix = np.empty_like(self._kernel)
        # Rounding may make eigenvalues of a singular kernel negative; the next step corrects this.
        self._rounding = ROUNDING * float(np.abs(np.diagonal(kernel)).max())
        self._y, self._c, self._epsilon = y, c, epsilon
        start = np.full(len(y), min(0.5 * c, 1.0))
        slack = np.full(len(y), max(float(np.std(y)), epsilon, 1e-12))
        self._alpha = _Bounds(start, c - start, slack, slack)
        self._star = _Bounds(start, c - start, slack, slack)
        self._intercept = float(np.median(y))

    def run(self, tolerance: float) -> SupportVectors:
        """Iterate to the tolerance, or until rounding prevents further progress."""
        best, solution = np.inf, self._function()
        for _ in range(MAX_STEPS):
            residual = self._residuals()
            if residual < best:
                best, solution = residual, self._function()
            if residual <= tolerance or residual > DIVERGENCE_RATIO * best or not self._step():
                break
        if not best <= MAX_RESIDUAL:
            raise FloatingPointError(
                f"the fit did not converge: C {self._c:g}, epsilon {self._epsilon:g}"
            )
        return solution

    def _function(self) -> SupportVectors:
        return SupportVectors(self._alpha.value - self._star.value, self._intercept)

    def _residuals(self) -> float:
        """Evaluate the optimality conditions, and return their largest relative residual."""
        beta = self._alpha.value - self._star.value
        image = self._kernel @ beta
        error = image + self._intercept - self._y
        self._dual = error + self._epsilon - self._alpha.lower + self._alpha.upper
        self._dual_star = -error + self._epsilon - self._star.lower + self._star.upper
        self._balance = float(beta.sum())
        loss = np.maximum(np.abs(error) - self._epsilon, 0.0).sum()
        goal = 0.5 * float(beta @ image) + self._c * float(loss)
        infeasible = max(np.abs(self._dual).max(), np.abs(self._dual_star).max())
        self._gap = self._products(self._alpha) + self._products(self._star)
        return float(max(self._gap / (MIN_OBJECTIVE + abs(goal)), infeasible))

    def _products(self, bounds: _Bounds) -> float:
        return float(bounds.value @ bounds.lower + bounds.room @ bounds.upper)

    def _step(self) -> bool:
        """Take a predictor-corrector step; return whether rounding still lets it advance."""
        self._factors()
        count = 4 * len(self._y)
        zero = np.zeros_like(self._y)
        flat = _Bounds(zero, zero, zero, zero)
        predictor = self._direction(0.0, _Move(flat, flat, 0.0))
        part = self._longest(predictor)
        ahead = self._products_after(self._alpha, predictor.alpha, part)
        ahead += self._products_after(self._star, predictor.alpha_star, part)
        centring = (ahead / self._gap) ** 3 * self._gap / count
        move = self._direction(centring, predictor)
        part = INTERIOR * self._longest(move)
        if not part > MIN_STEP:
            return False
        self._alpha = _moved(self._alpha, move.alpha, part)
        self._star = _moved(self._star, move.alpha_star, part)
        self._intercept += part * move.intercept
        return True

    def _factors(self) -> None:
        a, b = self._curvature(self._alpha), self._curvature(self._star)
        self._a, self._b, self._diagonal = a, b, a * b / (a + b)
        self._matrix[...] = self._kernel
        np.einsum("ii->i", self._matrix)[...] += np.maximum(self._diagonal, self._rounding)
        self._factor, failed = self._factorise(self._matrix, lower=1, clean=0)
        if failed:
            raise FloatingPointError("the kernel matrix is not positive semidefinite")
        self._ones = self._solve(np.ones_like(self._y))

    def _solve(self, right: Floats) -> Floats:
        solution: Any = self._substitute(self._factor, right, lower=1)[0]
        return np.asarray(solution)

    def _curvature(self, bounds: _Bounds) -> Floats:
        return bounds.lower / bounds.value + bounds.upper / bounds.room

    def _direction(self, centring: float, earlier: _Move) -> _Move:
        """Return the Newton step towards products of `centring`, corrected by an earlier one."""
        lower, upper = self._aims(self._alpha, earlier.alpha, centring)
        lower_star, upper_star = self._aims(self._star, earlier.alpha_star, centring)
        p = -self._dual + lower - upper
        q = -self._dual_star + lower_star - upper_star
        right = self._diagonal * (p / self._a - q / self._b)
        free = self._solve(right)
        intercept = (float(free.sum()) + self._balance) / float(self._ones.sum())
        beta = free - intercept * self._ones
        image = right - self._diagonal * beta  # of the kernel, intercept included
        step, step_star = (p - image) / self._a, (q + image) / self._b
        return _Move(
            self._with_bounds(self._alpha, step, lower, upper),
            self._with_bounds(self._star, step_star, lower_star, upper_star),
            intercept,
        )

    def _aims(self, now: _Bounds, earlier: _Bounds, centring: float) -> tuple[Floats, Floats]:
        """Return the change of the bounds' multipliers at constant alpha."""
        lower = (centring - earlier.value * earlier.lower) / now.value - now.lower
        upper = (centring - earlier.room * earlier.upper) / now.room - now.upper
        return lower, upper

    def _with_bounds(self, now: _Bounds, step: Floats, lower: Floats, upper: Floats) -> _Bounds:
        return _Bounds(
            step,
            -step,
            lower - now.lower / now.value * step,
            upper + now.upper / now.room * step,
        )

    def _longest(self, move: _Move) -> float:
        """Return the longest step, up to 1, that keeps everything positive."""
        pairs = [
            pair
            for now, change in ((self._alpha, move.alpha), (self._star, move.alpha_star))
            for pair in (
                (now.value, change.value),
                (now.room, change.room),
                (now.lower, change.lower),
                (now.upper, change.upper),
            )
        ]
        return min([1.0, *(float(-1.0 / min((d / x).min(), -1e-300)) for x, d in pairs)])

    def _products_after(self, now: _Bounds, move: _Bounds, part: float) -> float:
        return self._products(_moved(now, move, part))


def _moved(now: _Bounds, move: _Bounds, part: float) -> _Bounds:
    return _Bounds(
        now.value + part * move.value,
        now.room + part * move.room,
        now.lower + part * move.lower,
        now.upper + part * move.upper,
    )
