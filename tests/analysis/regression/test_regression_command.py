"""The commands, from the study's file to the prediction."""

import json

import numpy as np
import pandas as pd
import pytest
from synthetic_rows import few_inputs, smooth_length, synthetic_rows, thesis_inputs, write_table

from snowshed.analysis.regression import RegressionInterrupted, geometry_study, pipeline, predict
from snowshed.cli.main import main
from snowshed.study import Study

FEW = ["--rounds", "1", "--folds", "3", "--inner-folds", "2", "--jobs", "1"]


def run(*arguments):
    return main([str(argument) for argument in arguments])


@pytest.mark.parametrize("between", ["carry", "reseed"])
def test_the_geometry_study_is_the_thesis_data_set(tmp_path, between):
    assert run("geometry", "--between", between, "-o", tmp_path / "geometry.toml") == 0
    runs = [json.loads(planned.scene) for planned in Study.load(tmp_path / "geometry.toml").runs()]
    rows = {
        (event, scene["panel"]["height"], scene["panel"]["length"], scene["panel"]["tilt"])
        for scene in runs
        for event in range(1, scene["events"]["count"] + 1)
    }
    assert rows == {tuple(row) for row in thesis_inputs().tolist()}
    assert len(runs) == 122 and len(rows) == 610
    for scene in runs:
        assert scene["slab"]["length"] == scene["panel"]["length"]
        assert scene["slab"]["thickness"] == 0.05 and scene["numerics"]["dx"] == 0.01
        assert scene["dimension"] == 2 and scene["events"]["between"] == between
        assert scene["snow"]["preconsolidation_pressure"] == 7000
        assert (scene["snow"]["critical_state_slope"], scene["snow"]["cohesion"]) == (0.5, 0.2)


def test_the_trial_study_is_coarse(capsys):
    assert run("geometry", "--trial") == 0
    shown = capsys.readouterr().out
    assert shown == geometry_study(trial=True).to_toml() and "numerics.dx = 0.05" in shown
    assert run("geometry", "--trial", "--dx", "0.02") == 2
    assert "--dx has no effect with --trial" in capsys.readouterr().err
    assert run("geometry", "--between", "melt") == 2
    assert "'melt' is unknown; allowed: carry, reseed" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("library", "arguments"),
    [
        ("sklearn", ["rows.csv", "--kind", "linear"]),
        ("sklearn", ["rows.csv", "--kind", "gaussian-process"]),
        ("sklearn", ["rows.csv", "--kind", "gradient-boosting"]),
        ("threadpoolctl", ["rows.csv", "--kind", "linear"]),
        ("pyarrow", ["rows.parquet"]),
    ],
)
def test_without_a_library_the_error_says_what_to_install(
    tmp_path, capsys, monkeypatch, hide, library, arguments
):
    write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    hide(library)
    monkeypatch.chdir(tmp_path)
    assert run("regress", *arguments, "-o", "out", *FEW, "-q") == 2
    message = capsys.readouterr().err
    extra = "study" if library == "pyarrow" else "regression"
    assert f"needs {library}" in message and message.count("\n") == 1
    assert f'pip install "snowshed[{extra}]"' in message


@pytest.fixture(scope="module")
def regressed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("regressed")
    write_table(synthetic_rows(few_inputs(), noise=0.001), folder / "rows.csv")
    arguments = ["regress", folder / "rows.csv", "-o", folder / "out", *FEW, "-q"]
    assert run(*arguments, "--kind", "linear", "--kind", "gaussian-process") == 0
    return folder


def test_regress_writes_models_tables_and_figures(regressed):
    out = regressed / "out"
    scores = pd.read_csv(out / "scores.csv")
    assert len(scores) == 3 * 2 * 3 and (scores["validation_score"] > 0).all()
    for target in ("ratio", "height", "length"):
        errors = pd.read_csv(out / target / "errors.csv", index_col="model")
        assert errors.loc["gaussian-process", "held_out_error"] < errors.loc["linear"].iloc[0]
        assert (errors["fits"] > 0).all() and (errors["cpu_s"] > 0).all()
        quartiles = pd.read_csv(out / target / "quartiles.csv", index_col="model")
        relative = quartiles.loc["gaussian-process"] / quartiles.loc["data"]
        np.testing.assert_allclose(relative, 1, atol=0.1)
        for name in ("selection", "hyperparameters", "qq", "predictions", "cost"):
            assert (out / target / f"{name}.png").stat().st_size > 5000
        assert (out / target / "linear.txt").read_text().startswith(f"{target} = ")
    assert (out / "model.npz").is_file()


def test_the_linear_expression_agrees_with_the_linear_model(regressed):
    """Its terms, evaluated by hand, give the model's prediction."""
    text = (regressed / "out" / "length" / "linear.txt").read_text().strip().removesuffix(", m")
    offset, *terms = text.partition(" = ")[2].split()
    inputs = {"event": 2, "panel.height": 3.0, "panel.length": 2.0, "panel.tilt": 50.0}
    slopes = dict(zip(terms[1::2], map(float, terms[::2])))
    value = float(offset) + sum(slopes[name] * inputs[name] for name in inputs)
    model = regressed / "out" / "model.npz"
    table = predict(height=3, length=2, tilt=50, events=2, model=model, kind="linear").table
    answer = table[(table["target"] == "length") & (table["event"] == 2)]["value"].item()
    assert value == pytest.approx(answer, rel=1e-3)


def test_height_and_length_are_predicted_with_the_ratio(regressed):
    model = regressed / "out" / "model.npz"
    prediction = predict(height=2, length=3, tilt=50, events=2, model=model)
    table = prediction.table.set_index(["event", "target"])["value"]
    truth = smooth_length(np.array([[2, 2, 3, 50]]))[0]
    assert table[2, "length"] == pytest.approx(truth, rel=0.05)
    assert table[2, "ratio"] == pytest.approx(table[2, "height"] / table[2, "length"], rel=0.05)


def test_predict_prints_text_or_json(regressed, capsys):
    question = ["predict", "--height", 2, "--length", 4, "--tilt", 50, "--events", 3]
    question += ["--model", regressed / "out" / "model.npz"]
    assert run(*question) == 0
    shown = capsys.readouterr()
    assert "gaussian-process, rows, 96 rows" in shown.out and "±" in shown.out
    assert "EXTRAPOLATED" not in shown.out + shown.err
    assert run(*question, "--json") == 0
    answer = json.loads(capsys.readouterr().out)
    assert len(answer["predictions"]) == 9 and answer["extrapolated"] is False


def test_predict_refuses_panels_outside_the_data_unless_forced(regressed, capsys):
    question = ["predict", "--height", 9, "--length", 4, "--tilt", 50, "--events", 1]
    question += ["--model", regressed / "out" / "model.npz"]
    assert run(*question) == 2
    shown = capsys.readouterr()
    assert shown.out == "" and shown.err.count("\n") == 1
    assert "panel height 9 m is outside the data, which reach from 1 to 4 m" in shown.err
    assert run(*question, "--extrapolate") == 0
    shown = capsys.readouterr()
    assert "EXTRAPOLATED" in shown.out and "EXTRAPOLATED, do not rely on it" in shown.err
    assert run(*question, "--extrapolate", "--json") == 0
    assert json.loads(capsys.readouterr().out)["extrapolated"] is True


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["regress", "none.csv", "-o", "out"], "none.csv: No such file"),
        (["regress", "rows.csv"], "--output"),
        (["regress", "rows.csv", "-o", "out", "--target", "x"], "'x' is unknown; allowed: ratio"),
        (["regress", "rows.csv", "-o", "out", "--kind", "x"], "'x' is unknown; allowed: linear"),
        (["regress", "rows.csv", "-o", "out", "--measure", "x"], "allowed: stack, body"),
        (["regress", "rows.csv", "-o", "out", "--where", "x"], "x: not COLUMN=VALUE"),
        (["regress", "rows.csv", "-o", "out", "--where", "x=1"], "x: no such column"),
        (["regress", "rows.csv", "-o", "out", "--split", "x"], "allowed: rows, panels"),
        (["regress", "rows.csv", "-o", "out", "--jobs", "0"], "jobs: 0 is not positive"),
        (["regress", "rows.csv", "-o", "out", "--folds", "60"], "too few for 60 x 5 folds"),
        (["predict", "--height", "2", "--length", "2"], "--tilt"),
    ],
)
def test_bad_input_gives_one_line_code_2_and_no_files(
    regressed, tmp_path, monkeypatch, capsys, arguments, message
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rows.csv").write_bytes((regressed / "rows.csv").read_bytes())
    assert run(*arguments) == 2
    shown = capsys.readouterr()
    assert shown.out == "" and shown.err.startswith("error: ") and shown.err.count("\n") == 1
    assert message in shown.err
    assert [path.name for path in tmp_path.iterdir()] == ["rows.csv"]


def test_an_interrupt_ends_with_130_and_says_how_to_resume(
    regressed, tmp_path, monkeypatch, capsys
):
    def interrupted(*arguments, **options):
        raise RegressionInterrupted(tmp_path / "out")

    monkeypatch.setattr(pipeline, "cross_validate", interrupted)
    assert run("regress", regressed / "rows.csv", "-o", tmp_path / "out", *FEW) == 130
    assert "the same command resumes from" in capsys.readouterr().err
