"""The solvers of the epsilon-SVR against scikit-learn, and against the optimality conditions."""

import numpy as np
import pytest
from sklearn.model_selection import GridSearchCV, GroupKFold
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVR
from sklearn.utils.estimator_checks import parametrize_with_checks
from synthetic_rows import few_inputs, synthetic_rows

from snowshed import InputError
from snowshed.analysis.regression import EpsilonSVR, support_vectors
from snowshed.analysis.regression.folds import CrossValidation, ShuffledGroupKFold
from snowshed.analysis.regression.gradient_boosting import StagedGradientBoosting
from snowshed.analysis.regression.grid_kinds import EPSILON, GAMMA, rbf_svr
from snowshed.analysis.regression.grid_kinds import C as BOUNDS
from snowshed.analysis.regression.interior_point import solve
from snowshed.analysis.regression.kernels import kernel_matrix
from snowshed.analysis.regression.path_search import PathSearchCV
from snowshed.analysis.regression.scaling import Scaling
from snowshed.analysis.regression.support_vectors import fit_along_c
from snowshed.analysis.regression.task import FoldTask, compute

ROWS = synthetic_rows(few_inputs())
X = Scaling.of(ROWS.inputs).scaled(ROWS.inputs)
Y = ROWS.targets["ratio"]
Y = (Y - Y.mean()) / Y.std()


def kernel(gamma):
    return kernel_matrix(X, X, np.full(4, gamma) if gamma else np.array([]))


@pytest.mark.parametrize("gamma", [0, 1e-3, 0.1, 10])
@pytest.mark.parametrize("epsilon", [1e-3, 0.1, 1])
@pytest.mark.parametrize("c", [1e-3, 1, 100])
def test_interior_point_fits_agree_with_scikit_learn(gamma, epsilon, c):
    fit = solve(kernel(gamma), Y, c, epsilon, tolerance=1e-8)
    reference = SVR(kernel="precomputed", C=c, epsilon=epsilon, tol=1e-6).fit(kernel(gamma), Y)
    ours = kernel(gamma) @ fit.coefficients + fit.intercept
    theirs = reference.predict(kernel(gamma))
    # If no multiplier is between its bounds, any intercept in an interval is optimal.
    free = np.abs(reference.dual_coef_[0])
    shift = 0.0 if ((free > 1e-6 * c) & (free < 0.999 * c)).any() else np.mean(ours - theirs)
    np.testing.assert_allclose(ours - shift, theirs, atol=2e-4)


@pytest.mark.parametrize("c", [1e-3, 1, 1e4])
@pytest.mark.parametrize("gamma", [1e-4, 0.1, 100])
def test_interior_point_fits_are_optimal(gamma, c):
    """Multipliers are within bounds and balanced, and the duality gap is zero."""
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
def test_a_path_agrees_with_single_fits(gamma, epsilon):
    """Reused, quick and exact fits all equal the fit for their C."""
    for c, fit in zip(BOUNDS, fit_along_c(kernel(gamma), Y, epsilon, BOUNDS)):
        if epsilon == 100:
            middle = (Y.min() + Y.max()) / 2
            assert not fit.coefficients.any() and fit.intercept == pytest.approx(middle)
            continue
        single = solve(kernel(gamma), Y, c, epsilon, tolerance=1e-8)
        ours, theirs = (kernel(gamma) @ f.coefficients for f in (fit, single))
        assert np.abs(ours - theirs - np.mean(ours - theirs)).max() < 5e-3


def test_a_kernel_that_is_not_positive_is_refused():
    with pytest.raises(FloatingPointError, match="positive"):
        solve(-1e6 * np.eye(len(Y)), Y, 1e6, 0.1)


def test_points_that_do_not_converge_are_not_selected(monkeypatch):
    """Only points that libsvm solves quickly can be selected."""

    def diverge(*arguments):
        raise FloatingPointError("the fit did not converge")

    monkeypatch.setattr(support_vectors, "solve", diverge)
    fits = list(fit_along_c(kernel(0.01), Y, 1e-4, BOUNDS))
    assert np.isfinite(fits[0].intercept) and np.isnan(fits[-1].intercept)
    grid = {"epsilon": EPSILON, "C": BOUNDS}
    search = PathSearchCV(EpsilonSVR(gamma=0.01), grid, cv=ShuffledGroupKFold(2, (1,))).fit(X, Y)
    scores = search.cv_results_["mean_test_score"]
    assert np.isneginf(scores).any() and search.best_score_ == scores.max() > -np.inf
    monkeypatch.setattr(support_vectors, "_libsvm", lambda *arguments: None)
    with pytest.raises(InputError, match="C 10000, gamma 1 does not converge"):
        EpsilonSVR(epsilon=1e-4, C=1e4, gamma=1.0).fit(X, Y)


@parametrize_with_checks([EpsilonSVR("rbf"), EpsilonSVR("linear")])
def test_it_passes_the_checks_of_scikit_learn(estimator, check):
    check(estimator)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"kernel": "cubic"}, "kernel: 'cubic' is unknown; allowed: linear, rbf"),
        ({"C": 0}, "C: 0 is not positive"),
        ({"epsilon": -1}, "epsilon: -1 is not zero or positive"),
        ({"gamma": 0.0}, "gamma: 0.0 is not positive"),
    ],
)
def test_impossible_parameters_are_refused(parameters, message):
    with pytest.raises(InputError, match=message):
        EpsilonSVR(**parameters).fit(X, Y)


def test_it_works_in_a_pipeline_and_a_grid_search_of_scikit_learn():
    grid = {"epsilonsvr__C": [0.1, 10.0], "epsilonsvr__epsilon": [0.01, 0.1]}
    pipeline = make_pipeline(StandardScaler(), EpsilonSVR(gamma=0.1))
    search = GridSearchCV(pipeline, grid, cv=GroupKFold(4), scoring="neg_median_absolute_error")
    search.fit(ROWS.inputs, Y, groups=ROWS.panels)
    assert search.best_params_["epsilonsvr__C"] == 10.0 and search.best_score_ > -0.2


def test_grid_is_the_thesis_grid():
    assert (EPSILON[0], EPSILON[-1], len(EPSILON)) == (1e-4, 1e2, 7)
    assert (BOUNDS[0], BOUNDS[-1], len(BOUNDS)) == (1e-3, 1e4, 8)
    assert (GAMMA[0], GAMMA[-1], len(GAMMA)) == (1e-4, 1e2, 7)


GRIDS = {
    "linear": (EpsilonSVR("linear"), {"epsilon": [0.01, 0.1, 1.0], "C": [0.01, 1.0, 10.0]}),
    "rbf": (EpsilonSVR(), {"gamma": [0.01, 0.1], "epsilon": [0.01, 0.1], "C": [0.1, 10.0]}),
    "trees": (
        StagedGradientBoosting(random_state=0),
        {"max_depth": [1, 3], "n_estimators": [5, 20, 40]},
    ),
}


@pytest.mark.parametrize("name", GRIDS)
def test_path_search_and_grid_search_of_scikit_learn_agree(name):
    """Every point of the grid, on the same folds; fits may stop at different tolerances."""
    model, grid = GRIDS[name]
    folds = ShuffledGroupKFold(3, (1, 0, 0))
    ours = PathSearchCV(model, grid, cv=folds).fit(X, Y, ROWS.panels)
    plain = SVR(kernel=model.kernel, gamma=1.0, tol=1e-5) if name != "trees" else model
    theirs = GridSearchCV(plain, grid, cv=folds, scoring="neg_median_absolute_error")
    theirs.fit(X, Y, groups=ROWS.panels)
    expected = {
        tuple(sorted(point.items())): score
        for point, score in zip(theirs.cv_results_["params"], theirs.cv_results_["mean_test_score"])
    }
    results = ours.cv_results_
    assert len(results["params"]) == len(expected)
    for point, score in zip(results["params"], results["mean_test_score"]):
        assert score == pytest.approx(expected[tuple(sorted(point.items()))], rel=0.02)
    assert ours.best_params_ == theirs.best_params_
    np.testing.assert_allclose(ours.predict(X), theirs.predict(X), atol=5e-3)
    assert ours.n_fits_ == 3 * (2 if name == "trees" else len(expected))


def test_the_grid_of_the_rbf_kernel_needs_196_000_fits():
    assert np.prod([len(values) for values in rbf_svr().grid.values()]) * 5 * 100 == 196_000


def test_the_expansion_predicts_like_the_support_vector_machine():
    model = EpsilonSVR(epsilon=0.01, C=10.0, gamma=0.1).fit(X, Y)
    reference = SVR(C=10.0, epsilon=0.01, gamma=0.1, tol=1e-6).fit(X, Y)
    question = np.array([[0.1, -0.3, 0.7, 0.2]])
    expected = reference.predict(question)
    np.testing.assert_allclose(model.expansion_.predict(question), expected, atol=5e-3)


@pytest.mark.slow
def test_the_thesis_comparison_of_kernels_holds_for_synthetic_rows():
    """One outer fold of the full search on 610 rows: Table 5.3.2's errors and their ratio."""
    rows = synthetic_rows()
    values = rows.targets["ratio"]
    errors = {
        name: np.abs(
            compute(FoldTask("ratio", name, 0, 0), rows, CrossValidation()).predictions - values
        )
        for name in ("linear", "rbf")
    }
    assert errors["rbf"].mean() <= 0.004
    assert errors["linear"].mean() >= 2.5 * errors["rbf"].mean()
