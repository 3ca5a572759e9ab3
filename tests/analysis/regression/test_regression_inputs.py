"""Regression on other inputs than a panel's: any parameters that a study varied."""

import numpy as np
import pandas as pd
import pytest

from snowshed import InputError
from snowshed.analysis.regression import CrossValidation, predict, read_rows, regress
from snowshed.analysis.regression.model_file import load_model
from snowshed.cli.main import main

INPUTS = ("snow.cohesion", "panel.friction")


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    """Stacks of a panel that grow with the cohesion and shrink with the friction."""
    rows = [
        {
            "hash": "1", "snow.cohesion": c, "panel.friction": f, "panel.tilt": 50.0, "seed": 1,
            "event": event, "height_m": event * (0.1 + 0.2 * c - 0.05 * f), "length_m": 1.0 + c,
            "ended": "rest", "error": "", "version": "0.1.0", "dimension": 2, "dx": 0.01,
        }
        for c in (0.0, 0.1, 0.2, 0.3) for f in (0.1, 0.3, 0.5) for event in (1, 2, 3)
    ]  # fmt: skip
    file = tmp_path_factory.mktemp("inputs") / "rows.csv"
    pd.DataFrame(rows).to_csv(file, index=False)
    return file


@pytest.fixture(scope="module")
def regressed(table):
    rows = read_rows(table, inputs=INPUTS)
    assert rows.inputs.shape == (36, 3) and rows.names == ("event", *INPUTS)
    scheme = CrossValidation(rounds=1, folds=3, inner_folds=2)
    folder = table.parent / "out"
    reports = regress(rows, folder, models=["gaussian-process", "linear"], scheme=scheme, jobs=1)
    assert "snow.cohesion" in reports[0].expression
    return folder


def test_predictions_take_the_inputs_of_the_model(regressed):
    file = regressed / "model.npz"
    assert load_model(file).names == ("event", *INPUTS)
    panels = {"snow.cohesion": [0.05, 0.25], "panel.friction": 0.2}
    prediction = predict(inputs=panels, events=2, model=file)
    expected = 2 * (0.1 + 0.2 * np.array([0.05, 0.25]) - 0.05 * 0.2)
    assert prediction.array("height")[:, 1] == pytest.approx(expected, rel=0.03)
    assert prediction.settings["panel.tilt"] == "50.0"
    frame = pd.DataFrame({**panels, "events": 2}, index=["weak", "strong"])
    assert predict(frame, model=file).table["panel"].unique().tolist() == ["weak", "strong"]


def test_questions_with_other_inputs_are_refused(regressed):
    file = regressed / "model.npz"
    valid = {"snow.cohesion": 0.1, "panel.friction": 0.2}
    with pytest.raises(InputError, match=r"height: not an input of this model; allowed: snow\.co"):
        predict(height=2, inputs=valid, events=1, model=file)
    with pytest.raises(InputError, match=r"panel\.friction: missing; needed are snow\.cohesion"):
        predict(inputs={"snow.cohesion": 0.1}, events=1, model=file)
    with pytest.raises(InputError, match=r"cohesion factor 0\.5 is outside the data"):
        predict(inputs={"snow.cohesion": 0.5, "panel.friction": 0.2}, events=1, model=file)
    with pytest.raises(InputError, match=r"snow\.cohesion: not an input of this model"):
        predict(height=2, length=4, tilt=60, events=1, inputs={"snow.cohesion": 0.1})
    with pytest.raises(InputError, match=r"snow\.cohesion: nan is not a finite number"):
        predict(inputs={"snow.cohesion": np.nan, "panel.friction": 0.2}, events=1, model=file)


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ((), "inputs: none"),
        (("height",), "input: 'height' is not a parameter"),
        (("seeding.seed",), "input: 'seeding.seed' is not a parameter"),
        (("snow.cohesion", "snow.cohesion"), "each once"),
        (("snow.cohesion",), "panel.friction: the rows have different values"),
        (("snow.density", *INPUTS), "snow.density"),
    ],
)
def test_inputs_that_do_not_fit_the_table_are_refused(table, inputs, message):
    with pytest.raises(InputError, match=message.replace(".", r"\.")):
        read_rows(table, inputs=inputs)


def test_commands_accept_additional_inputs(table, tmp_path, capsys):
    out = str(tmp_path / "out")
    inputs = [word for name in INPUTS for word in ("--input", name)]
    quick = ["--kind", "linear", "--rounds", "1", "--folds", "3", "--inner-folds", "2"]
    assert main(["regress", str(table), *inputs, *quick, "--jobs", "1", "-o", out]) == 0
    assert (tmp_path / "out" / "height" / "predictions.png").is_file()
    capsys.readouterr()
    values = ["--input", "snow.cohesion=0.1", "--input", "panel.friction=0.3"]
    assert main(["predict", *values, "--events", "1", "--model", out + "/model.npz"]) == 0
    assert "Stack below the panel: β 0.1, panel friction 0.3" in capsys.readouterr().out
    assert main(["predict", "--input", "snow.cohesion", "--model", out + "/model.npz"]) == 2
    assert "snow.cohesion: not PATH=NUMBER" in capsys.readouterr().err
