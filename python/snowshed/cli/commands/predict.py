"""The command ``snowshed predict``: slow modules are imported when it runs."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import click

from snowshed._core import InputError
from snowshed.cli.options.common import PATH
from snowshed.cli.options.number_texts import named_once
from snowshed.cli.output.terminal import narrow_table, say, wide_console, write_out

if TYPE_CHECKING:
    from snowshed.analysis.regression.predictor import Prediction
    from snowshed.snow.accuracy.mechanisms import Mechanisms

TARGET_TITLES = {"ratio": "height / length", "height": "height", "length": "length"}


@click.command()
@click.option("--height", type=float, help="Height of the panel's lower edge above ground [m].")
@click.option("--length", type=float, help="Length of the panel along the slope [m].")
@click.option("--tilt", type=float, help="Tilt of the panel from the horizontal [degrees].")
@click.option(
    "--input",
    "inputs",
    multiple=True,
    metavar="PATH=VALUE",
    help="Another input of the model, such as snow.cohesion=0.2. Repeatable.",
)
@click.option("--events", type=int, default=5, help="Number of slide-offs.  [default: 5]")
@click.option("--model", type=PATH, help="Model file of regress.  [default: the shipped model]")
@click.option(
    "--scheme",
    help="Scheme of the shipped model's simulations: thesis or objective.  [default: thesis]",
)
@click.option("--kind", help="Model: rbf, gaussian-process, linear.  [default: first available]")
@click.option(
    "--extrapolate",
    is_flag=True,
    help="Answer outside the data, too, and mark every answer.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def predict(
    height: Optional[float],
    length: Optional[float],
    tilt: Optional[float],
    inputs: Sequence[str],
    events: int,
    model: Optional[Path],
    scheme: Optional[str],
    kind: Optional[str],
    extrapolate: bool,
    as_json: bool,
) -> None:
    """Predict a stack's height and length, with their spread, without a simulation.

    Panels outside the range of the model's data are refused (exit code 2).

    \b
    Example:
      snowshed predict --height 2 --length 4 --tilt 60 --events 5
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.regression.predictor import predict as ask

    panel = {"height": height, "length": length, "tilt": tilt}
    asked: dict[str, Any] = {**panel, "events": events, "scheme": scheme}
    others = named_once("--input", map(_input, inputs))
    try:
        prediction = ask(**asked, inputs=others, model=model, kind=kind, extrapolate=extrapolate)
    except InputError as error:
        named = str(error).partition(":")[0] in asked
        raise type(error)(f"--{error}") if named else error from None
    for objection in prediction.objections:
        say(f"warning: EXTRAPOLATED, do not rely on it: {objection}", err=True)
    if as_json:
        write_out(prediction_json(prediction))
    else:
        title = f"Stack below the panel: {prediction.asked}\n{prediction.kind}, {prediction.title}"
        print_prediction(prediction, title)


def _input(text: str) -> tuple[str, float]:
    path, equals, value = text.partition("=")
    try:
        if not equals:
            raise ValueError
        return path, float(value)
    except ValueError:
        raise click.BadParameter(f"{text}: not PATH=NUMBER", param_hint="--input") from None


def print_prediction(prediction: Prediction, title: str) -> None:
    """Print the answers, one line per event, and mark extrapolated ones."""
    from snowshed.analysis.regression.rows import TARGETS
    from snowshed.snow.accuracy.mechanisms import Mechanisms
    from snowshed.snow.stack.quantities import measure_named

    rows = prediction.table
    targets = list(dict.fromkeys(rows["target"]))
    units = {target: f", {TARGETS[target]}" if TARGETS[target] else "" for target in targets}
    wide_console().print(f"{title}\n")
    headings = [f"{TARGET_TITLES[name]}{units[name]}" for name in targets]
    table = narrow_table("", ["event", *headings])
    for event, answers in rows.groupby("event"):
        cells = [
            f"{row['value']:.3f} ± {row['spread']:.3f}\n[{row['low']:.3f}, {row['high']:.3f}]"
            for row in (answers[answers["target"] == target].iloc[0] for target in targets)
        ]
        mark = "\nEXTRAPOLATED" if prediction.extrapolated else ""
        table.add_row(f"{event}{mark}", *cells)
    wide_console().print(table)
    label = measure_named(prediction.measure).label
    mechanisms = Mechanisms.of_texts(prediction.settings)
    settings = ", ".join([*_scene_settings(prediction), mechanisms.label])
    wide_console().print(f" The stack is {label}; {settings}.")
    wide_console().print(f" {_interval_text(prediction, mechanisms)}.")


def _interval_text(prediction: Prediction, mechanisms: Mechanisms) -> str:
    """Return what the intervals contain of scatter and of the error of the grid."""
    from snowshed.snow.accuracy.stack_errors import recorded_bias

    if prediction.grid_error:
        sources = filter(None, [prediction.grid_error, mechanisms.calibration_note])
        return (
            "68 % of the stacks on these cells lie within ±. The interval [ ] of 90 % also "
            f"contains the error of the grid: {'; '.join(sources)}"
        )
    bias = recorded_bias(
        int(prediction.settings.get("dimension", 2)),
        int(prediction.table["event"].max()),
        mechanisms,
    )
    return (
        "68 % of the stacks lie within ±, 90 % within [ ]. Neither contains the error of the "
        f"grid: {bias}"
    )


def _scene_settings(prediction: Prediction) -> list[str]:
    """Return the settings of the simulated scene, without those of the method."""
    return [
        f"{name} {value}"
        for name, value in prediction.settings.items()
        if "." in name or name in ("dimension", "dx", "trimming")
    ]


def prediction_json(prediction: Prediction) -> str:
    """Return the answers as JSON."""
    from snowshed.analysis.regression.rows import TARGETS

    content: dict[str, Any] = {
        "kind": prediction.kind,
        "title": prediction.title,
        "measure": prediction.measure,
        "settings": dict(prediction.settings),
        "grid_error": prediction.grid_error,
        "units": TARGETS,
        "extrapolated": prediction.extrapolated,
        "objections": list(prediction.objections),
        "predictions": prediction.table.drop(columns=["panel", "extrapolated"]).to_dict("records"),
    }
    return json.dumps(content, indent=1)
