"""Folds, the nested cross-validation over them, and its files."""

import signal
from dataclasses import replace

import numpy as np
import pytest
from synthetic_rows import few_inputs, synthetic_rows

from snowshed import InputError
from snowshed.analysis.regression import CrossValidation, RegressionInterrupted, nested, regress
from snowshed.analysis.regression.fold_result import FoldResult
from snowshed.analysis.regression.folds import ShuffledGroupKFold
from snowshed.analysis.regression.kinds import kinds, kinds_named
from snowshed.analysis.regression.nested import cross_validate
from snowshed.analysis.regression.scaling import Scaling
from snowshed.analysis.regression.task import FoldTask, compute

ROWS = synthetic_rows(few_inputs())
X = ROWS.inputs
SMALL = CrossValidation(rounds=2, folds=3, inner_folds=2)
LINEAR = kinds_named(["linear"])


@pytest.mark.parametrize("by", ["rows", "panels"])
def test_every_row_is_validated_once_per_round_and_tested_once_per_fold(by):
    scheme = CrossValidation(rounds=1, folds=4, inner_folds=3, by=by)
    groups = scheme.groups(ROWS)
    outer = list(scheme.outer(0).split(ROWS.inputs, groups=groups))
    np.testing.assert_array_equal(
        np.sort(np.concatenate([validation for _, validation in outer])), np.arange(len(ROWS))
    )
    for fold, (development, validation) in enumerate(outer):
        assert not set(development) & set(validation)
        assert len(development) + len(validation) == len(ROWS)
        inner = [
            (development[train], development[test])
            for train, test in scheme.inner(0, fold).split(
                ROWS.inputs[development], groups=groups[development]
            )
        ]
        tested = np.sort(np.concatenate([test for _, test in inner]))
        np.testing.assert_array_equal(tested, np.sort(development))
        for train, test in inner:
            assert not set(train) & set(test) and set(train) | set(test) == set(development)
            if by == "panels":
                assert not set(ROWS.panels[train]) & set(ROWS.panels[test])


def test_rounds_differ_and_repeat():
    first, second, repeated = (next(SMALL.outer(round_).split(X))[1] for round_ in (0, 1, 0))
    assert set(first) != set(second)
    np.testing.assert_array_equal(first, repeated)


def test_the_folds_are_those_of_the_published_models():
    """Folds are parts of NumPy's permutation: other folds give other models of the same rows."""
    panels = np.repeat([3, 5, 8, 9], 3)
    for groups, units in ((None, range(12)), (panels, [3, 5, 8, 9])):
        of_row = np.arange(12) if groups is None else groups
        parts = np.array_split(np.random.default_rng([1, 0]).permutation(list(units)), 3)
        folds = list(ShuffledGroupKFold(3, (1, 0)).split(X[:12], groups=groups))
        assert len(folds) == len(parts)
        for (train, test), part in zip(folds, parts):
            assert set(of_row[test]) == set(part) and set(train) == set(range(12)) - set(test)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"rounds": 0}, "rounds: 0 is below 1"),
        ({"folds": 1}, "folds: 1 is below 2"),
        ({"by": "events"}, "by: 'events' is unknown; allowed: rows, panels"),
    ],
)
def test_impossible_folds_are_refused(values, message):
    with pytest.raises(InputError, match=message):
        CrossValidation(**values)


def test_too_few_rows_are_refused(tmp_path):
    with pytest.raises(InputError, match="32 panels are too few for 10 x 5 folds; at least 50"):
        regress(ROWS, tmp_path / "out", scheme=CrossValidation(by="panels"))
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", list(kinds()))
def test_each_kind_predicts_held_out_rows(name):
    """Scores are those of the predictions, and far better than those of the median."""
    rows = synthetic_rows(few_inputs(), noise=0.001)
    values = rows.targets["ratio"]
    result = compute(FoldTask("ratio", name, 0, 0), rows, CrossValidation(folds=3, inner_folds=2))
    errors = np.abs(result.held_out - values[result.validation])
    assert result.validation_score == pytest.approx(np.median(errors))
    baseline = np.median(np.abs(values - np.median(values)))
    assert result.validation_score < baseline * (0.6 if name == "linear" else 0.35)
    inputs = Scaling.of(rows.inputs).scaled(rows.inputs)
    scaled = (values - values.mean()) / values.std()
    final = kinds()[name].estimator(result.parameters).fit(inputs, scaled)
    expected = final.predict(inputs) * values.std() + values.mean()
    np.testing.assert_allclose(result.predictions, expected)
    if result.expansion is not None:
        scaled = result.expansion.predict(inputs)
        np.testing.assert_allclose(scaled * values.std() + values.mean(), expected)


def test_a_result_is_read_back_from_its_file(tmp_path):
    result = compute(FoldTask("height", "linear", 0, 1), ROWS, SMALL)
    result.save(tmp_path / "a" / "b.npz")
    loaded = FoldResult.load(tmp_path / "a" / "b.npz", result.expansion.points)
    assert loaded.parameters == result.parameters and loaded.fits == result.fits
    np.testing.assert_array_equal(loaded.predictions, result.predictions)
    np.testing.assert_array_equal(loaded.held_out, result.held_out)
    np.testing.assert_array_equal(loaded.expansion.coefficients, result.expansion.coefficients)
    assert FoldResult.load(tmp_path / "none.npz", result.expansion.points) is None
    (tmp_path / "cut.npz").write_bytes((tmp_path / "a" / "b.npz").read_bytes()[:500])
    assert FoldResult.load(tmp_path / "cut.npz", result.expansion.points) is None


def run(folder, scheme=SMALL, **options):
    return cross_validate(ROWS, folder, targets=["ratio"], kinds=LINEAR, scheme=scheme, **options)


def predictions(results):
    return {task: result.predictions.tolist() for task, result in results.items()}


def test_an_interrupted_regression_resumes(tmp_path, monkeypatch):
    uninterrupted = run(tmp_path / "uninterrupted")
    computed = []

    def compute_then_interrupt(task, rows, scheme):
        computed.append(task)
        if len(computed) == 3:
            signal.raise_signal(signal.SIGINT)
        return compute(task, rows, scheme)

    monkeypatch.setattr(nested, "compute", compute_then_interrupt)
    with pytest.raises(RegressionInterrupted, match="the same command resumes"):
        run(tmp_path / "parts")
    written = list((tmp_path / "parts").rglob("*.npz"))
    assert len(computed) == 3 and len(written) == 3
    leftover = written[0].with_name(".partial-0123456789abcdef-000-000.npz")
    leftover.touch()  # as a killed process leaves it
    reports = []
    resumed = run(tmp_path / "parts", progress=reports.append)
    assert len(computed) == 6 and not leftover.exists()
    assert predictions(resumed) == predictions(uninterrupted)
    assert (reports[0].done, reports[-1].done, reports[-1].count) == (3, 6, 6)
    assert reports[-1].fraction == pytest.approx(1)


def test_rounds_can_be_added(tmp_path):
    run(tmp_path / "out", scheme=replace(SMALL, rounds=1))
    reports = []
    extended = run(tmp_path / "out", progress=reports.append)
    assert (reports[0].done, reports[-1].count) == (3, 6)
    assert predictions(extended) == predictions(run(tmp_path / "at_once"))
    with pytest.raises(InputError, match="with other folds"):
        run(tmp_path / "out", scheme=replace(SMALL, folds=4))


def test_processes_give_the_same_results(tmp_path):
    serial, parallel = run(tmp_path / "one"), run(tmp_path / "two", jobs=2)
    assert predictions(serial) == predictions(parallel)


def test_a_folder_of_something_else_is_refused(tmp_path):
    run(tmp_path / "out")
    (tmp_path / "damaged").mkdir()
    (tmp_path / "damaged" / "regression.json").write_bytes(b"\xff\x00")
    with pytest.raises(InputError, match=r"regression\.json: damaged: "):
        run(tmp_path / "damaged")
    with pytest.raises(InputError, match="holds a regression of another table, with other folds"):
        cross_validate(
            synthetic_rows(few_inputs(), seed=2),
            tmp_path / "out",
            targets=["ratio"],
            kinds=LINEAR,
            scheme=SMALL,
        )
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis.txt").touch()
    with pytest.raises(InputError, match="not empty, and holds no regression"):
        run(tmp_path / "full")
