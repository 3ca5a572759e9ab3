"""Section 5.3: the two support vector regressions of H/L."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from snowshed._core import InputError
from snowshed.analysis.regression.summary import QUARTILES, THESIS_ERRORS, THESIS_QUARTILES
from snowshed.io.csv_table import read_csv
from snowshed.plot.html_page import Grid, Picture
from thesis.claims.hypothesis_tests import judge
from thesis.claims.regression import (
    REGRESSION,
    VALIDATION_SCORE,
    Regressed,
    validation,
)
from thesis.regression_stage import KINDS, TARGET
from thesis.reproduction import Reproduction
from thesis.section import SAVED_DPI, Section

TEXT = (
    "ε-SVR of H/L with a linear and an RBF kernel, hyper-parameters in powers of ten, chosen and "
    "scored by nested cross-validation (5.2.3): {rounds} rounds of {folds} outer and {inner} inner "
    "folds over {rows} rows; the thesis has 10 rounds of 10 and 5 over 610.",
    "The thesis gives the error of H/L in metres; it has no unit.",
)
ERRORS = ("mean_absolute_error", "standard_deviation", "held_out_error")
NAMES = {"rbf": "RBF", "linear": "linear"}
FIGURES = {
    "selection": ("Scores over the rounds", "As Figure 5.3.1."),
    "hyperparameters": ("Hyper-parameters", "As Figure 5.3.2."),
    "qq": ("Predictions over data, both sorted", "As Figure 5.3.3."),
    "predictions": ("Predictions and data", "As Figure 5.3.4."),
}


def build(found: Reproduction) -> Section:
    """Return the section; raises InputError if the regression is not done."""
    state = found.regression.state()
    folder = found.regression.results()
    if not state.finished:
        raise InputError(f"regression: {state.in_words()}")
    rows = found.rows.read()
    data = read_regressed(folder, len(rows), rows.panel_count)
    scheme = found.size.folds
    numbers = {"rounds": scheme.rounds, "folds": scheme.folds, "inner": scheme.inner_folds}
    text = [line.format(rows=data.rows, **numbers) for line in TEXT]
    formula = _text(folder / TARGET / "linear.txt")
    text.append(f"The mean linear model here: {formula}.")
    tables = [
        ("Table 5.3.1: quartiles of the predicted H/L", quartiles_grid(data)),
        ("Table 5.3.2: mean absolute error of H/L", errors_grid(data)),
    ]
    pictures = [
        Picture.read(folder / TARGET / f"{name}.png", title, caption, dpi=SAVED_DPI)
        for name, (title, caption) in FIGURES.items()
        if (folder / TARGET / f"{name}.png").is_file()
    ]
    claims = judge(REGRESSION, data)
    return Section("regression", "Regression (5.2, 5.3)", text, tables, pictures, claims)


def read_regressed(folder: Path, rows: int, panels: int) -> Regressed:
    """Read what `snowshed.analysis.regression.regress` has written.

    Raises
    ------
    InputError
        If a table is damaged, naming it.
    """
    scores = _by_model(folder / "scores.csv", ("development_score", "validation_score", "C"))
    errors = _by_model(folder / TARGET / "errors.csv", ERRORS)
    quartiles = _by_model(folder / TARGET / "quartiles.csv", QUARTILES, ("data", *KINDS))
    return Regressed(rows, panels, scores.reset_index(), errors, quartiles)


def _by_model(file: Path, columns: Sequence[str], models: Sequence[str] = KINDS) -> pd.DataFrame:
    """Read a table that has numbers in these columns, and rows of these models."""
    table = read_csv(file)
    for name in columns:
        if name not in table or table[name].dtype.kind not in "if":
            raise InputError(f"{file}: damaged: no numbers in a column {name}")
    if "model" not in table or not set(models) <= set(table["model"]):
        raise InputError(f"{file}: damaged: not a row of each model ({', '.join(models)})")
    return table.set_index("model")


def quartiles_grid(data: Regressed) -> Grid:
    """Return Table 5.3.1."""
    rows = [["data, here", *_numbers(data.quartiles.loc["data", list(QUARTILES)])]]
    for model in KINDS:
        rows.append([f"{NAMES[model]}, thesis", *_numbers(THESIS_QUARTILES[model])])
        rows.append(
            [f"{NAMES[model]}, here", *_numbers(data.quartiles.loc[model, list(QUARTILES)])]
        )
    return Grid(["model", *QUARTILES], rows, "l" + "r" * len(QUARTILES))


def errors_grid(data: Regressed) -> Grid:
    """Return Table 5.3.2, with the scores on rows that were not trained on."""
    rows = []
    for model in KINDS:
        score = f"about {VALIDATION_SCORE}" if model == "rbf" else ""
        rows.append([f"{NAMES[model]}, thesis", *_numbers(THESIS_ERRORS[model]), "", score])
        row = data.errors.loc[model]
        ours = _numbers([row["mean_absolute_error"], row["standard_deviation"]], 4)
        held_out = _numbers([row["held_out_error"]], 4)
        rows.append([f"{NAMES[model]}, here", *ours, *held_out, validation(data, model).in_words()])
    head = ["model", "mean absolute error", "standard deviation", "on rows not trained on"]
    return Grid([*head, "median absolute error, validation"], rows, "lrrrr")


def _text(file: Path) -> str:
    try:
        return file.read_bytes().decode("utf-8").strip()
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: damaged: {error}") from None


def _numbers(values: object, digits: int = 3) -> list[str]:
    return [f"{float(value):.{digits}f}" for value in values]  # type: ignore[attr-defined]
