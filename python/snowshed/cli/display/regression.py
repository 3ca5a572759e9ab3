"""The output of ``snowshed regress`` and ``snowshed predict``."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rich.table import Table

from snowshed.analysis.regression.pipeline import TargetReport
from snowshed.analysis.regression.rows import TARGETS
from snowshed.analysis.regression.summary import QUARTILES
from snowshed.cli.terminal import plain_table, wide_console
from snowshed.snow.stack.quantities import measure_named

if TYPE_CHECKING:
    from snowshed.analysis.regression.predictor import Prediction

TARGET_WORDS = {"ratio": "height / length", "height": "height", "length": "length"}


def print_reports(reports: Sequence[TargetReport]) -> None:
    """Print Tables 5.3.1 and 5.3.2 for each target."""
    for report in reports:
        unit = f", {TARGETS[report.target]}" if TARGETS[report.target] else ""
        wide_console().print(_error_table(report, unit))
        scatter = report.errors["seeding_scatter"].max()
        if scatter == scatter:
            wide_console().print(f" stacks of single seeds scatter by {scatter:.4f} about the mean")
        shown = _table(f"Quartiles of the predicted {report.target}{unit}", ["model", *QUARTILES])
        for model, row in report.quartiles.iterrows():
            shown.add_row(str(model), *(f"{row[name]:.3f}" for name in QUARTILES))
        wide_console().print(shown)
        for check in report.checks:
            wide_console().print(f" {check}")
        if report.expression:
            wide_console().print(f" {report.expression}\n")


def _error_table(report: TargetReport, unit: str) -> Table:
    thesis = bool(report.errors["thesis_error"].notna().any())
    headings = ["model", "all rows", *(["thesis"] if thesis else []), "not trained\non"]
    headings += ["unseen\npanels", "fits", "cpu time\ns"]
    shown = _table(f"Mean absolute error of the {report.target}{unit}", headings)
    for model, row in report.errors.iterrows():
        cells = [f"{row['mean_absolute_error']:.4f} ± {row['standard_deviation']:.4f}"]
        if thesis:
            known = row["thesis_error"] == row["thesis_error"]
            words = f"{row['thesis_error']:.3f} ± {row['thesis_deviation']:.3f}"
            cells.append(words if known else "")
        cells += [f"{row['held_out_error']:.4f}", _or_nothing(row["unseen_panel_error"])]
        cells += [f"{row['fits']:,.0f}", f"{row['cpu_s']:,.1f}"]
        shown.add_row(str(model), *cells)
    return shown


def _or_nothing(value: float) -> str:
    return f"{value:.4f}" if value == value else ""


def print_prediction(prediction: Prediction, title: str) -> None:
    """Print the answers, one line per event, marked where they are extrapolated."""
    rows = prediction.table
    targets = list(dict.fromkeys(rows["target"]))
    units = {target: f", {TARGETS[target]}" if TARGETS[target] else "" for target in targets}
    wide_console().print(f"{title}\n")
    shown = _table("", ["event", *(f"{TARGET_WORDS[name]}{units[name]}" for name in targets)])
    for event, answers in rows.groupby("event"):
        cells = [
            f"{one['value']:.3f} ± {one['spread']:.3f}\n[{one['low']:.3f}, {one['high']:.3f}]"
            for one in (answers[answers["target"] == target].iloc[0] for target in targets)
        ]
        mark = "\nEXTRAPOLATED" if prediction.extrapolated else ""
        shown.add_row(f"{event}{mark}", *cells)
    wide_console().print(shown)
    label = measure_named(prediction.measure).label
    wide_console().print(" 68 % of the stacks lie within ±, 90 % within [ ].")
    wide_console().print(f" The stack is {'; '.join(filter(None, [label, _scene(prediction)]))}.")


def _scene(prediction: Prediction) -> str:
    """Return the simulated scene in words, without the settings of the method."""
    known = prediction.settings.items()
    told = [
        f"{name} {value}"
        for name, value in known
        if "." in name or name in ("dimension", "dx", "trimming")
    ]
    return ", ".join(told)


def prediction_json(prediction: Prediction) -> str:
    """Return the answers as JSON."""
    content: dict[str, Any] = {
        "kind": prediction.kind,
        "title": prediction.title,
        "measure": prediction.measure,
        "settings": dict(prediction.settings),
        "units": TARGETS,
        "extrapolated": prediction.extrapolated,
        "objections": list(prediction.objections),
        "predictions": prediction.table.drop(columns=["panel", "extrapolated"]).to_dict("records"),
    }
    return json.dumps(content, indent=1)


def _table(title: str, headings: Sequence[str]) -> Table:
    first, *numbers = headings
    table = plain_table(title, padding=(0, 1))
    table.add_column(first, no_wrap=True)
    for heading in numbers:
        table.add_column(heading, justify="right", no_wrap=True)
    return table
