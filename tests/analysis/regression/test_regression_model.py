"""Models: files, predictions, and their spread and domain."""

import contextlib
import json
import pickle
import zipfile
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from synthetic_rows import few_inputs, smooth_ratio, synthetic_rows, thesis_inputs

from snowshed import InputError
from snowshed.analysis.regression import OutsideDataError, load_model, predict, save_model
from snowshed.analysis.regression.ensemble import Ensemble
from snowshed.analysis.regression.kinds import kinds
from snowshed.analysis.regression.model_file import Member, StackModel
from snowshed.analysis.regression.rows import stack_rows
from snowshed.analysis.regression.scaling import Scaling
from snowshed.analysis.regression.spread import (
    INTERVAL_SHARE,
    SPREAD_SHARE,
    Spread,
    predict_unseen_panels,
    stack_spread,
)
from snowshed.analysis.regression.threads import one_thread
from snowshed.cli.commands.predict import print_prediction
from snowshed.snow.stack.quantities import MEASURES

NOISE = 0.003
PARAMETERS = {"epsilon": 0.01, "C": 100.0, "gamma": 0.1}


def ensemble_model(rows, target="ratio", rounds=2, folds=5):
    """Return an RBF model as `regress` makes it, but with given parameters."""
    kind = kinds()["rbf"]
    inputs = Scaling.of(rows.inputs).scaled(rows.inputs)
    values = rows.targets[target]
    scaled = (values - values.mean()) / values.std()
    choices = [{**PARAMETERS, "epsilon": epsilon} for epsilon in np.linspace(0.005, 0.05, folds)]
    models = [kind.estimator(parameters).fit(inputs, scaled).expansion_ for parameters in choices]
    ensemble = Ensemble(
        inputs,
        np.array([model.coefficients for model in models]),
        np.array([model.intercept for model in models]),
        np.full((folds, 4), PARAMETERS["gamma"]),
    )
    held_out = predict_unseen_panels(kind, [choices] * rounds, rows, target)
    deviation = ensemble.predict(inputs).std(axis=0) * values.std()
    spread = stack_spread(rows, target, held_out, deviation)
    return Member(ensemble, float(values.mean()), float(values.std()), spread)


def stack_model(rows):
    with one_thread():
        members = {("ratio", "rbf"): ensemble_model(rows)}
    return StackModel(rows.inputs, members, "made up", "stack")


@pytest.fixture(scope="module")
def model():
    return stack_model(synthetic_rows(noise=NOISE))


@pytest.fixture(scope="module")
def model_of_means():
    """A model of rows that are means of four stacks."""
    return stack_model(synthetic_rows(np.tile(thesis_inputs(), (4, 1)), noise=NOISE))


@pytest.fixture
def file(model, tmp_path):
    save_model(model, tmp_path / "model.npz")
    return tmp_path / "model.npz"


def test_a_model_is_read_back_from_its_file(model, file):
    loaded = load_model(file)
    assert (loaded.title, loaded.measure, loaded.targets, loaded.kinds) == (
        "made up",
        "stack",
        ["ratio"],
        ["rbf"],
    )
    ours, theirs = model.members["ratio", "rbf"], loaded.members["ratio", "rbf"]
    assert theirs.spread == ours.spread
    question = Scaling.of(model.inputs).scaled(np.array([[2.0, 2.5, 3.0, 50.0]]))
    np.testing.assert_array_equal(
        theirs.ensemble.predict(question), ours.ensemble.predict(question)
    )


def test_a_prediction_is_near_the_formula(file):
    prediction = predict(height=2.5, length=5, tilt=55, events=5, model=file)
    assert not prediction.extrapolated and prediction.kind == "rbf"
    truth = smooth_ratio(np.array([[event, 2.5, 5, 55] for event in range(1, 6)]))
    errors = np.abs(prediction.table["value"] - truth)
    assert (errors < 2.5 * NOISE).all()
    assert (prediction.table["spread"] < 2.5 * NOISE).all() and (
        prediction.table["spread"] > 0.5 * NOISE
    ).all()
    assert (prediction.table["low"] < prediction.table["value"]).all()


def test_a_model_predicts_like_its_file(model, file):
    questions = {"height": 2.5, "length": 5, "tilt": 55, "events": 3}
    pd.testing.assert_frame_equal(
        predict(model=model, **questions).table, predict(model=file, **questions).table
    )


def test_settings_shared_by_all_rows_are_stored(model, tmp_path):
    settings = {"panel.friction": "0.8", "dx": "0.025", "trimming": "outermost_first"}
    described = replace(model, settings=settings, measure="body")
    save_model(described, tmp_path / "described.npz")
    prediction = predict(height=2, length=2, tilt=40, events=1, model=tmp_path / "described.npz")
    assert (prediction.settings, prediction.measure) == (described.settings, "body")


def test_a_model_without_trimming_rule_uses_equal_pace(model, tmp_path, capsys):
    """A file without a trimming rule means equal_pace; every measure can be printed."""
    save_model(replace(model, settings={"dx": "0.025"}), tmp_path / "old.npz")
    prediction = predict(height=2, length=2, tilt=40, events=1, model=tmp_path / "old.npz")
    assert prediction.settings["trimming"] == "equal_pace"
    for measure in MEASURES:
        print_prediction(replace(prediction, measure=measure), "Stack")
        shown = " ".join(capsys.readouterr().out.split())
        assert MEASURES[measure].label in shown and "trimming equal_pace" in shown


@pytest.mark.parametrize(
    ("settings", "text"),
    [
        ({"dx": "0.025"}, "scheme thesis were"),
        ({"scheme": "objective", "transfer": "affine_flip"}, "scheme objective were"),
        ({"transfer": "affine_flip"}, "no runs are recorded for scheme thesis with affine flip"),
    ],
)
def test_the_error_of_the_grid_follows_from_the_scheme(model, tmp_path, capsys, settings, text):
    save_model(replace(model, settings=settings), tmp_path / "model.npz")
    prediction = predict(height=2, length=2, tilt=40, events=1, model=tmp_path / "model.npz")
    print_prediction(prediction, "Stack")
    assert text in " ".join(capsys.readouterr().out.split())


def test_no_prediction_is_negative(model):
    """A model below zero predicts zero, and so do the ends of its interval."""
    ((key, member),) = model.members.items()
    below = replace(model, members={key: replace(member, mean=-10.0)})
    table = predict(height=2, length=2, tilt=40, events=2, model=below).table
    assert (table[["value", "low", "high"]] == 0).all(axis=None)


@pytest.mark.parametrize("fixture", ["model", "model_of_means"])
def test_spread_and_interval_contain_their_share_of_stacks(fixture, request):
    """New panels inside the data have new noise."""
    model = request.getfixturevalue(fixture)
    rng = np.random.default_rng(5)
    inside = rng.uniform((2, 0.5, 40), (4, 8, 70), (300, 3))
    questions = np.column_stack([rng.integers(1, 6, 300), inside])
    stacks = smooth_ratio(questions) + rng.normal(0, NOISE, 300)
    member = model.members["ratio", "rbf"]
    scaled = Scaling.of(model.inputs).scaled(questions)
    predictions = member.ensemble.predict(scaled) * member.deviation + member.mean
    mean, deviation = predictions.mean(axis=0), predictions.std(axis=0)
    for part in (SPREAD_SHARE, INTERVAL_SHARE):
        width = member.spread.half_width(mean, deviation, part)
        share = np.mean(np.abs(stacks - mean) <= width)
        assert part - 0.07 < share < part + 0.09


def test_spread_grows_where_noise_grows():
    rng = np.random.default_rng(1)
    predictions = rng.uniform(1, 10, 4000)
    errors = rng.normal(0, 0.1 * predictions)
    spread = Spread.of(errors, predictions, np.zeros(4000))
    width = spread.half_width(np.array([1.0, 10.0]), np.zeros(2))
    np.testing.assert_allclose(width, (0.1, 1.0), rtol=0.1)  # 68 % of normal errors: a deviation


def test_rows_of_a_panel_are_left_out_together():
    """Rows of a panel share its offset, so only leaving out all of them reveals it."""
    rows = synthetic_rows(few_inputs(), noise=0.0)
    rng = np.random.default_rng(2)
    offset = rng.normal(0, 0.01, rows.panels.max() + 1)[rows.panels]
    length = rows.targets["length"]
    shifted = stack_rows(rows.inputs, (rows.targets["ratio"] + offset) * length, length)
    held_out = predict_unseen_panels(kinds()["rbf"], [[PARAMETERS] * 8] * 2, shifted, "ratio")
    assert np.abs(held_out - shifted.targets["ratio"]).mean() > 0.006


@pytest.mark.parametrize(
    ("question", "message"),
    [
        ({"height": 5.0}, "panel height 5 m is outside the data, which reach from 1 to 4 m"),
        ({"events": 6}, "event 6 is outside the data"),
        ({"height": 1.0, "tilt": 65}, "not together"),
    ],
)
def test_panels_outside_the_data_are_refused_unless_forced(file, question, message):
    arguments = {"height": 2.0, "length": 9.0, "tilt": 40, "events": 5, "model": file, **question}
    with pytest.raises(OutsideDataError, match=message):
        predict(**arguments)
    forced = predict(**arguments, extrapolate=True)
    assert forced.extrapolated and message in forced.objections[0]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"height": -1}, "height: -1 is not a positive length"),
        ({"length": float("nan")}, "length: nan is not"),
        ({"tilt": 90}, "tilt: 90 is outside the allowed range"),
        ({"events": 0}, "events: 0 is outside the allowed range"),
        ({"events": 1.5}, "events: 1.5 is not a whole number"),
        ({"height": None}, "height: missing; needed are height, length, tilt, events"),
        ({"height": "tall"}, "height: 'tall'; needed: a number"),
        ({"height": [[2, 3]]}, r"height\[0\]: \[2, 3\]; needed: a number"),
        ({"height": []}, "no panels"),
        ({"height": [2, 3], "tilt": [40, 50, 60]}, "tilt: 3 values, but height has 2"),
        ({"height": [2, -1]}, "panel 1, height: -1 is not a positive length"),
        ({"height": [2] * 21, "events": 1000}, "21000 events of all panels; at most 20000"),
        ({"kind": "linear"}, "the model holds no 'linear'; it has: rbf"),
    ],
)
def test_impossible_questions_are_refused(file, values, message):
    with pytest.raises(InputError, match=message):
        predict(**{"height": 2, "length": 2, "tilt": 40, "events": 1, "model": file, **values})


PANELS = {"height": [2.0, 3.0, 4.0], "length": [2.0, 4.0, 1.0], "events": [2, 5, 1]}


def test_arrays_and_tables_are_predicted_like_single_panels(file):
    """A number holds for all panels; the columns of a table may be in any order."""
    several = predict(**PANELS, tilt=50, model=file)
    table = pd.DataFrame(PANELS | {"tilt": 50})[["tilt", "events", "length", "height"]]
    labelled = predict(table.set_axis(["a", "b", "c"]), model=file)
    assert list(dict.fromkeys(labelled.table["panel"])) == ["a", "b", "c"]
    for number, label in enumerate("abc"):
        single = {name: values[number] for name, values in PANELS.items()}
        expected = predict(**single, tilt=50, model=file).table.drop(columns="panel")
        for prediction, panel in ((several, number), (labelled, label)):
            rows = prediction.table[prediction.table["panel"] == panel].drop(columns="panel")
            pd.testing.assert_frame_equal(rows.reset_index(drop=True), expected, rtol=1e-9)
    array = labelled.array("ratio")
    assert array.shape == (3, 5) and np.isfinite(array).sum() == 8
    np.testing.assert_array_equal(array[0, :2], labelled.table["value"][:2])
    for wrong in ({"target": "height"}, {"target": "ratio", "column": "panel"}):
        with pytest.raises(InputError, match="is unknown; allowed: "):
            several.array(**wrong)


def test_panels_outside_the_data_are_named_and_marked(file):
    panels = {"height": [2.0, 9.0, 3.0, 2.0], "length": 2.0, "tilt": [40, 40, 50, 89], "events": 1}
    with pytest.raises(OutsideDataError) as refused:
        predict(**panels, model=file)
    message = str(refused.value)
    assert message.startswith("2 of 4 panels lie outside the data: panel 1: panel height 9 m is")
    assert "; panel 3: panel tilt 89° is outside the data" in message
    forced = predict(**panels, model=file, extrapolate=True)
    assert forced.table["extrapolated"].tolist() == [False, True, False, True]
    assert [text[:8] for text in forced.objections] == ["panel 1:", "panel 3:"]
    many = predict(height=[9.0] * 8, length=2, tilt=40, events=1, model=file, extrapolate=True)
    assert len(many.objections) == 8
    with pytest.raises(OutsideDataError, match=r"panel 4: .*; and 3 more panels; no model"):
        predict(height=[9.0] * 8, length=2, tilt=40, events=1, model=file)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda t: t.drop(columns="tilt"),
            "tilt: missing; needed are height, length, tilt, events",
        ),
        (lambda t: t.rename(columns={"tilt": "tlit"}), "column 'tlit' is unknown; allowed: height"),
        (lambda t: t.assign(friction=0.3), "column 'friction' is unknown; allowed: height"),
        (lambda t: t.set_axis([7, 7]), "index must be unique; it holds 7 twice"),
        (lambda t: t[["tilt", *t]], "column 'tilt' occurs twice"),
        (lambda t: t.assign(height=[2, np.nan]), "panel 1, height: nan is not a positive length"),
        (lambda t: t.to_numpy(), "panels: a value of type ndarray; needed: DataFrame"),
    ],
)
def test_tables_without_valid_panels_are_refused(file, change, message):
    table = pd.DataFrame({"height": [2.0, 3.0], "length": 2.0, "tilt": 40.0, "events": 2})
    with pytest.raises(InputError, match=message):
        predict(change(table), model=file)
    with pytest.raises(InputError, match="tilt: not allowed beside a table of panels"):
        predict(table, tilt=40, model=file)


def altered(file, change, tmp_path):
    with np.load(file) as archive:
        arrays = dict(archive)
    facts = json.loads(str(arrays["facts"]))
    change(arrays, facts)
    arrays["facts"] = np.array(json.dumps(facts))
    np.savez(tmp_path / "bad.npz", **arrays)
    return tmp_path / "bad.npz"


ENSEMBLE = "ratio/rbf"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda a, f: a.pop("inputs"), "inputs: missing"),
        (lambda a, f: a.pop(f"{ENSEMBLE}/rates"), f"{ENSEMBLE}/rates: missing"),
        (
            lambda a, f: a.update({f"{ENSEMBLE}/coefficients": np.zeros((10, 3))}),
            rf"{ENSEMBLE}/coefficients: float64 numbers of shape \(10, 3\); must be float64",
        ),
        (
            lambda a, f: a.update({f"{ENSEMBLE}/intercepts": np.full(5, np.nan)}),
            f"{ENSEMBLE}/intercepts: holds values that are not finite",
        ),
        (lambda a, f: a.update({f"{ENSEMBLE}/rates": -np.ones((5, 4))}), "rates: negative"),
        (lambda a, f: a.update(inputs=a["inputs"].astype("U8")), "inputs: <U8 numbers"),
        (lambda a, f: f.update(format="cake"), "facts: not a snowshed stack model"),
        (lambda a, f: f.update(format_version=99), "format_version: 99; this snowshed reads 1"),
        (lambda a, f: f.update(inputs=["event"]), "inputs: .*must be event and parameters"),
        (lambda a, f: f.update(measure="guess"), "measure: 'guess' is unknown"),
        (lambda a, f: f.update(title=3), "title: missing, or not str"),
        (lambda a, f: f.update(members={}), "members: none"),
        (lambda a, f: f["members"].update({"speed/rbf": {}}), "members.speed/rbf: unknown target"),
        (
            lambda a, f: f["members"][ENSEMBLE].update(deviation=0),
            f"members.{ENSEMBLE}.deviation: 0 is not a positive number",
        ),
        (
            lambda a, f: f["members"][ENSEMBLE]["spread"].update(factors=[[0.5, 1]]),
            f"members.{ENSEMBLE}.spread.factors: must be given, and not negative",
        ),
    ],
)
def test_bad_models_are_refused_by_key(file, tmp_path, change, message):
    bad = altered(file, change, tmp_path)
    with pytest.raises(InputError, match="bad.npz: .*" + message):
        load_model(bad)


def test_files_that_are_not_models_are_refused(file, tmp_path):
    (tmp_path / "cut.npz").write_bytes(file.read_bytes()[:2000])
    (tmp_path / "text.npz").write_text("model")
    (tmp_path / "pickle.npz").write_bytes(pickle.dumps({"coefficients": [1]}))
    for name in ("cut", "text", "pickle"):
        with pytest.raises(InputError, match=f"{name}.npz: damaged, or not a model"):
            load_model(tmp_path / f"{name}.npz")
    with pytest.raises(InputError, match="No such file"):
        load_model(tmp_path / "none.npz")


class Trap:
    def __reduce__(self):
        return (pytest.fail, ("code of a model file was executed",))


def test_nothing_in_a_file_is_executed(file, tmp_path):
    with np.load(file) as archive:
        arrays = dict(archive)
    arrays["inputs"] = np.array([Trap()], dtype=object)
    np.savez(tmp_path / "trap.npz", **arrays)
    with pytest.raises(InputError, match=r"trap.npz: inputs: .*allow_pickle=False"):
        load_model(tmp_path / "trap.npz")


def test_a_file_that_unpacks_to_too_much_is_refused(file, monkeypatch):
    monkeypatch.setattr("snowshed.analysis.regression.model_file.MAX_BYTES", 1000)
    with pytest.raises(InputError, match="at most 1000 are allowed"):
        load_model(file)


def test_damaged_files_are_refused_or_read_as_a_model(file, tmp_path):
    """Random bytes anywhere in the archive, or inside one of its arrays, raise no other error."""
    original, rng = file.read_bytes(), np.random.default_rng(0)
    for attempt in range(60):
        with zipfile.ZipFile(file) as archive:
            parts = {name: bytearray(archive.read(name)) for name in archive.namelist()}
        damaged = bytearray(original)
        part = parts[str(rng.choice(sorted(parts)))] if attempt % 2 else damaged
        for index in rng.integers(0, min(len(part), 400), 3):
            part[index] = rng.integers(256)
        if attempt % 2:
            with zipfile.ZipFile(tmp_path / "bad.npz", "w") as archive:
                for name, content in parts.items():
                    archive.writestr(name, bytes(content))
        else:
            (tmp_path / "bad.npz").write_bytes(bytes(damaged))
        with contextlib.suppress(InputError):
            assert load_model(tmp_path / "bad.npz").targets == ["ratio"]
