"""Section 5.3: the two support vector regressions of H/L."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from reproductions.common.hypothesis_tests import judge
from reproductions.common.section import Content
from reproductions.frischholz2023.claims.regression import (
    REGRESSION,
    VALIDATION_SCORE,
    RegressionResults,
    validation,
)
from reproductions.frischholz2023.printed import (
    THESIS_ERRORS,
    THESIS_QUARTILES,
    THESIS_ROWS,
    thesis_relative_error,
)
from reproductions.frischholz2023.regression_stage import KINDS, TARGET, Part
from reproductions.frischholz2023.stages import ThesisComputation
from reproductions.frischholz2023.tables import SAVED_DPI
from snowshed._core import InputError
from snowshed.analysis.regression.rows import StackRows, read_rows
from snowshed.analysis.regression.summary import QUARTILES, quartiles
from snowshed.base.formatting import percent
from snowshed.io.csv_table import read_csv
from snowshed.plot.html_page import HtmlTable, Picture
from snowshed.snow.stack.quantities import MEASURES

TEXT = (
    "ε-SVR of H/L with a linear and an RBF kernel, hyper-parameters in powers of ten, chosen and "
    "scored by nested cross-validation (5.2.3): {rounds} rounds of {folds} outer and {inner} inner "
    "folds over {rows} rows; the thesis has 10 rounds of 10 and 5 over {thesis_rows}.",
    "The thesis gives the error of H/L in metres; it has no unit. The same error is a "
    "larger share of H/L if stacks are flatter, so its share of the median prediction is listed, "
    "too.",
)
MEANS = (
    "Each row of the thesis is one stack. Rows here are means of up to {seeds} stacks that differ "
    "in their seeds, and scatter less. So the first stack of each row is regressed as well as the "
    "means, and claims are judged on it."
)
ERRORS = ("mean_absolute_error", "standard_deviation", "held_out_error")
NAMES = {"rbf": "RBF", "linear": "linear"}
FIGURES = {
    "selection": ("Scores over the rounds", "As Figure 5.3.1."),
    "hyperparameters": ("Hyper-parameters", "As Figure 5.3.2."),
    "qq": ("Predictions over data, both sorted", "As Figure 5.3.3."),
    "predictions": ("Predictions and data", "As Figure 5.3.4."),
}


def build(work: ThesisComputation) -> Content:
    """Return the content; raises InputError if the regression is not done."""
    state = work.regression.state()
    if not state.finished:
        raise InputError(f"regression: {state.text()}")
    parts = work.regression.parts()
    data = {rows_label(part.rows): _part_results(part) for part in parts}
    single, scheme = next(iter(data.values())), parts[0].scheme
    numbers = {"rounds": scheme.rounds, "folds": scheme.folds, "inner": scheme.inner_folds}
    text = [line.format(rows=single.rows, thesis_rows=THESIS_ROWS, **numbers) for line in TEXT]
    if len(parts) > 1:
        text.append(MEANS.format(seeds=parts[-1].rows.most_seeds))
    formula = _read_text(parts[0].folder / TARGET / "linear.txt")
    text.append(f"The mean linear model of the {next(iter(data))}: {formula}.")
    tables = [
        ("Table 5.3.1: quartiles of the predicted H/L", quartiles_grid(data)),
        ("Quartiles of the rows' H/L, by the definition of the stack", rows_grid(work.rows.file)),
        ("Table 5.3.2: mean absolute error of H/L", errors_grid(data)),
    ]
    folder = parts[0].folder / TARGET
    pictures = [
        Picture.read(folder / f"{name}.png", title, caption, dpi=SAVED_DPI)
        for name, (title, caption) in FIGURES.items()
        if (folder / f"{name}.png").is_file()
    ]
    claims = judge(REGRESSION, single)
    return Content(text, tables, pictures, claims)


def rows_label(rows: StackRows) -> str:
    """Return a label for rows of one seed, or for means."""
    return "rows of one seed" if rows.most_seeds == 1 else f"means of up to {rows.most_seeds} seeds"


def _part_results(part: Part) -> RegressionResults:
    return read_results(part.folder, len(part.rows), part.rows.panel_count)


def read_results(folder: Path, rows: int, panels: int) -> RegressionResults:
    """Return the results that `snowshed.analysis.regression.regress` has written.

    Raises
    ------
    InputError
        If a table is damaged.
    """
    scores = _by_model(folder / "scores.csv", ("development_score", "validation_score", "C"))
    errors = _by_model(folder / TARGET / "errors.csv", ERRORS)
    quartiles = _by_model(folder / TARGET / "quartiles.csv", QUARTILES, ("data", *KINDS))
    return RegressionResults(rows, panels, scores.reset_index(), errors, quartiles)


def _by_model(file: Path, columns: Sequence[str], models: Sequence[str] = KINDS) -> pd.DataFrame:
    """Read a table that has numbers in these columns, and rows of these models."""
    table = read_csv(file)
    for name in columns:
        if name not in table or table[name].dtype.kind not in "if":
            raise InputError(f"{file}: damaged: no numbers in a column {name}")
    if "model" not in table or not set(models) <= set(table["model"]):
        raise InputError(f"{file}: damaged: not a row of each model ({', '.join(models)})")
    return table.set_index("model")


def quartiles_grid(data: Mapping[str, RegressionResults]) -> HtmlTable:
    """Return the quartiles of the predictions (Table 5.3.1), and of the rows."""
    rows = []
    for model in KINDS:
        rows.append([f"{NAMES[model]}, thesis", "predictions", *_numbers(THESIS_QUARTILES[model])])
        for name, regressed in data.items():
            ours = _numbers(regressed.quartiles.loc[model, list(QUARTILES)])
            rows.append([f"{NAMES[model]}, here", f"predictions, {name}", *ours])
    for name, regressed in data.items():
        rows.append(["(rows)", name, *_numbers(regressed.quartiles.loc["data", list(QUARTILES)])])
    return HtmlTable(["model", "of", *QUARTILES], rows, "ll" + "r" * len(QUARTILES))


def rows_grid(file: Path) -> HtmlTable:
    """Return the quartiles of H/L of a table's rows by each measure that it has."""
    rows = []
    for measure in MEASURES.values():
        if measure.name == "stack":  # the same as one of the measures by trimming rule
            continue
        try:
            measured = read_rows(file, measure.name)
        except InputError:  # the table is older than the measure
            continue
        for of_one in (measured.of_one_seed(), *([measured] if measured.most_seeds > 1 else [])):
            numbers = _numbers(quartiles(of_one.targets[TARGET]))
            rows.append([measure.label, rows_label(of_one), *numbers])
    return HtmlTable(["the stack is", "of", *QUARTILES], rows, "ll" + "r" * len(QUARTILES))


def errors_grid(data: Mapping[str, RegressionResults]) -> HtmlTable:
    """Return Table 5.3.2, with errors relative to the median and on rows not trained on."""
    rows = []
    for model in KINDS:
        score = f"about {VALIDATION_SCORE}" if model == "rbf" else ""
        printed = [*_numbers(THESIS_ERRORS[model]), percent(thesis_relative_error(model), 2)]
        rows.append([f"{NAMES[model]}, thesis", "rows of one seed", *printed, "", score])
        for name, regressed in data.items():
            row = regressed.errors.loc[model]
            ours = _numbers([row["mean_absolute_error"], row["standard_deviation"]], 4)
            error, median = (
                regressed.errors["mean_absolute_error"][model],
                regressed.quartiles["Q2"][model],
            )
            part = float(error) / float(median)
            held_out = _numbers([row["held_out_error"]], 4)
            score = validation(regressed, model).text()
            rows.append([f"{NAMES[model]}, here", name, *ours, percent(part, 2), *held_out, score])
    head = ["model", "of", "mean absolute error", "standard deviation", "of the median prediction"]
    head += ["on rows not trained on", "median absolute error, validation"]
    return HtmlTable(head, rows, "ll" + "r" * 5)


def _read_text(file: Path) -> str:
    try:
        return file.read_bytes().decode("utf-8").strip()
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: damaged: {error}") from None


def _numbers(values: object, digits: int = 3) -> list[str]:
    return [f"{float(value):.{digits}f}" for value in values]  # type: ignore[attr-defined]
