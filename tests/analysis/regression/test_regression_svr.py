"""The solvers of the epsilon-SVR against scikit-learn, and against the optimality conditions."""

import numpy as np
import pytest
from made_up_rows import few_inputs, made_up_rows
from sklearn.svm import SVR

from snowshed import InputError
from snowshed.analysis.regression import support_vectors
from snowshed.analysis.regression.folds import CrossValidation
from snowshed.analysis.regression.interior_point import solve
from snowshed.analysis.regression.kernels import Expansion, kernel_matrix
from snowshed.analysis.regression.kinds import Development
from snowshed.analysis.regression.scaling import Scaling
from snowshed.analysis.regression.support_vectors import fit_along_c
from snowshed.analysis.regression.svr_kinds import (
    EPSILON,
    GAMMA,
    SupportVectorRegression,
    linear_svr,
    rbf_svr,
)
from snowshed.analysis.regression.svr_kinds import C as BOUNDS
from snowshed.analysis.regression.task import Task, compute

ROWS = made_up_rows(few_inputs())
X = Scaling.of(ROWS.inputs).scaled(ROWS.inputs)
Y = ROWS.targets["ratio"]
Y = (Y - Y.mean()) / Y.std()


def kernel(gamma):
    return kernel_matrix(X, X, np.full(4, gamma) if gamma else np.array([]))


@pytest.mark.parametrize("gamma", [0, 1e-3, 0.1, 10])
@pytest.mark.parametrize("epsilon", [1e-3, 0.1, 1])
@pytest.mark.parametrize("c", [1e-3, 1, 100])
def test_interior_point_fits_are_those_of_scikit_learn(gamma, epsilon, c):
    fit = solve(kernel(gamma), Y, c, epsilon, tolerance=1e-8)
    reference = SVR(kernel="precomputed", C=c, epsilon=epsilon, tol=1e-6).fit(kernel(gamma), Y)
    ours = kernel(gamma) @ fit.coefficients + fit.intercept
    theirs = reference.predict(kernel(gamma))
    # Where no multiplier is between its bounds the intercept may lie anywhere in an interval.
    free = np.abs(reference.dual_coef_[0])
    shift = 0.0 if ((free > 1e-6 * c) & (free < 0.999 * c)).any() else np.mean(ours - theirs)
    np.testing.assert_allclose(ours - shift, theirs, atol=2e-4)


@pytest.mark.parametrize("c", [1e-3, 1, 1e4])
@pytest.mark.parametrize("gamma", [1e-4, 0.1, 100])
def test_interior_point_fits_are_optimal(gamma, c):
    """Multipliers within bounds and balanced; no other function has a smaller objective."""
    epsilon = 0.05
    fit = solve(kernel(gamma), Y, c, epsilon, tolerance=1e-9)
    beta = fit.coefficients
    assert np.abs(beta).max() <= c * (1 + 1e-9)
    assert abs(beta.sum()) < 1e-6 * np.abs(beta).sum()
    image = kernel(gamma) @ beta
    loss = np.maximum(np.abs(image + fit.intercept - Y) - epsilon, 0).sum()
    primal = 0.5 * beta @ image + c * loss
    dual = -0.5 * beta @ image + Y @ beta - epsilon * np.abs(beta).sum()
    assert primal - dual < 1e-6 * abs(primal) + 1e-9


@pytest.mark.parametrize("gamma", [0, 1e-2, 1, 100])
@pytest.mark.parametrize("epsilon", [1e-4, 0.1, 100])
def test_a_path_gives_each_fit(gamma, epsilon):
    """Reused, quick and exact fits are all the fits of their C."""
    for c, fit in zip(BOUNDS, fit_along_c(kernel(gamma), Y, epsilon, BOUNDS)):
        if epsilon == 100:
            middle = (Y.min() + Y.max()) / 2
            assert not fit.coefficients.any() and fit.intercept == pytest.approx(middle)
            continue
        alone = solve(kernel(gamma), Y, c, epsilon, tolerance=1e-8)
        ours, theirs = (kernel(gamma) @ f.coefficients for f in (fit, alone))
        assert np.abs(ours - theirs - np.mean(ours - theirs)).max() < 5e-3


def test_a_kernel_that_is_none_is_refused():
    with pytest.raises(FloatingPointError, match="positive"):
        solve(-1e6 * np.eye(len(Y)), Y, 1e6, 0.1)


def test_points_that_do_not_converge_are_not_elected(monkeypatch):
    """Nothing beyond what libsvm solves quickly."""

    def diverge(*arguments):
        raise FloatingPointError("the fit did not converge")

    monkeypatch.setattr(support_vectors, "solve", diverge)
    fits = list(fit_along_c(kernel(0.01), Y, 1e-4, BOUNDS))
    assert np.isfinite(fits[0].intercept) and np.isnan(fits[-1].intercept)
    kind = SupportVectorRegression("rbf", "RBF SVR", 1, (0.01,))
    half = np.arange(len(Y)) % 2 == 0
    splits = [(np.flatnonzero(half), np.flatnonzero(~half))]
    choice = kind.search(Development(X, Y, np.arange(len(Y)), splits))
    assert np.isfinite(choice.score)
    monkeypatch.setattr(support_vectors, "_libsvm", lambda *arguments: None)
    with pytest.raises(InputError, match="C 10000, gamma 1 does not converge"):
        kind.fit({"epsilon": 1e-4, "C": 1e4, "gamma": 1.0}, X, Y)


def test_grid_is_the_thesis_grid():
    assert (EPSILON[0], EPSILON[-1], len(EPSILON)) == (1e-4, 1e2, 7)
    assert (BOUNDS[0], BOUNDS[-1], len(BOUNDS)) == (1e-3, 1e4, 8)
    assert (GAMMA[0], GAMMA[-1], len(GAMMA)) == (1e-4, 1e2, 7)


@pytest.mark.parametrize("kind", [linear_svr(), SupportVectorRegression("rbf", "RBF", 1, (0.1,))])
def test_search_finds_what_a_plain_grid_search_finds(kind):
    """Scores of scikit-learn's SVR, one by one, at the chosen point and at others."""
    scheme = CrossValidation(folds=2, inner_folds=3)
    development, _ = scheme.outer(ROWS, 0)[0]
    splits = scheme.inner(ROWS, development, 0, 0)
    choice = kind.search(Development(X, Y, development, splits))
    options = {"kernel": "rbf", "gamma": 0.1} if kind.gammas else {"kernel": "linear"}

    def score(c, epsilon):
        found = []
        for train, test in splits:
            model = SVR(C=c, epsilon=epsilon, **options).fit(X[train], Y[train])
            found.append(np.median(np.abs(model.predict(X[test]) - Y[test])))
        return np.mean(found)

    own = score(choice.parameters["C"], choice.parameters["epsilon"])
    assert choice.score == pytest.approx(own, rel=0.05)
    for c, epsilon in [(0.1, 0.1), (10, 0.01), (1, 1), (10, 0.1)]:
        assert choice.score <= score(c, epsilon) * 1.05
    assert choice.fits == 3 * 56


def test_the_grid_of_the_rbf_kernel_is_counted():
    assert len(rbf_svr().gammas) * len(EPSILON) * len(BOUNDS) * 5 * 100 == 196_000


def test_an_expansion_is_the_support_vector_machine():
    kind = rbf_svr()
    model = kind.fit({"epsilon": 0.01, "C": 10.0, "gamma": 0.1}, X, Y)
    assert isinstance(model, Expansion)
    reference = SVR(C=10.0, epsilon=0.01, gamma=0.1, tol=1e-6).fit(X, Y)
    question = np.array([[0.1, -0.3, 0.7, 0.2]])
    np.testing.assert_allclose(model.predict(question), reference.predict(question), atol=5e-3)


@pytest.mark.slow
def test_the_thesis_comparison_of_kernels_on_rows_like_its_own():
    """One outer fold of the full search on 610 rows: Table 5.3.2's errors and their ratio."""
    rows = made_up_rows()
    values = rows.targets["ratio"]
    errors = {
        name: np.abs(
            compute(Task("ratio", name, 0, 0), rows, CrossValidation()).predictions - values
        )
        for name in ("linear", "rbf")
    }
    assert errors["rbf"].mean() <= 0.004
    assert errors["linear"].mean() >= 2.5 * errors["rbf"].mean()
