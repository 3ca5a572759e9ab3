"""Predictions: height, length and ratio of a stack, with their spread, inside the data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Optional, Union

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.regression.dataset import model_file
from snowshed.analysis.regression.geometry import SCHEMES
from snowshed.analysis.regression.grid_error import PanelGridError, recorded_grid_error
from snowshed.analysis.regression.model_file import StackModel, load_model
from snowshed.analysis.regression.questions import Numbers, Questions
from snowshed.analysis.regression.scaling import Scaling
from snowshed.analysis.regression.spread import INTERVAL_SHARE, SPREAD_SHARE
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.base.callers import argument
from snowshed.base.paths import PathLike
from snowshed.scene.labels import settings_text

if TYPE_CHECKING:
    import pandas as pd

MAX_NAMED_PANELS = 5  # panels that a refusal names


class OutsideDataError(InputError):
    """A question lies outside the data of the model that should answer it."""


@checked
@dataclass(frozen=True)
class Prediction:
    """Answers for the events of one or more panels.

    Attributes
    ----------
    table
        One row per panel, event and target: ``panel`` (its label in the table that was asked, or
        its number from 0), ``event``, ``target``, ``value``, ``spread`` (half width that holds
        68 % of the stacks), ``low`` and ``high`` (between which 90 % lie, with the error of the
        grid), ``models`` (standard deviation of the models), in m, or 1 for the ratio;
        ``grid_factor``: factor of the grid's error in either direction, 1 if nothing is recorded
        for the model's grid; ``extrapolated``: whether the panel lies outside the data.
    kind, title
        The kind of model, and the title of its data.
    measure, settings
        Measure of the snow, and common settings of the data, as in `StackModel`.
    grid_error
        Source of the error of the grid in the intervals; empty if they leave it out.
    objections
        Reasons why panels lie outside the data; empty if all lie inside.
    asked
        The inputs of the first panel, as text.
    """

    table: pd.DataFrame
    kind: str
    title: str
    measure: str
    settings: Mapping[str, str]
    grid_error: str = ""
    objections: tuple[str, ...] = ()
    asked: str = ""

    @property
    def extrapolated(self) -> bool:
        """True if a panel lies outside the data."""
        return bool(self.objections)

    def array(self, target: str, column: str = "value") -> Floats:
        """Return a column of the table for one target as an array.

        Parameters
        ----------
        target
            "ratio", "height" or "length".
        column
            Column of `table`.

        Returns
        -------
        numpy.ndarray
            Shape (panels, events), in the order that was asked; NaN beyond the last event of a
            panel that has fewer than others.

        Raises
        ------
        InputError
            If the table has no such target or column.
        """
        targets = list(dict.fromkeys(self.table["target"]))
        if target not in targets:
            raise InputError(f"target: {target!r} is unknown; allowed: {', '.join(targets)}")
        numbers = [str(name) for name in self.table.select_dtypes("float")]
        if column not in numbers:
            raise InputError(f"column: {column!r} is unknown; allowed: {', '.join(numbers)}")
        rows = self.table[self.table["target"] == target]
        wide = rows.pivot(index="panel", columns="event", values=column)
        return wide.reindex(rows["panel"].unique()).to_numpy(float)


@checked
def predict(
    panels: Optional[pd.DataFrame] = None,
    *,
    height: Optional[Numbers] = None,
    length: Optional[Numbers] = None,
    tilt: Optional[Numbers] = None,
    events: Optional[Numbers] = None,
    inputs: Optional[Mapping[str, Numbers]] = None,
    model: Union[PathLike, StackModel, None] = None,
    scheme: Optional[str] = None,
    kind: Optional[str] = None,
    extrapolate: bool = False,
) -> Prediction:
    """Predict the stacks below panels after each of several events.

    Parameters
    ----------
    panels
        One row for each panel, with the columns ``height``, ``length``, ``tilt`` and ``events``,
        or the other inputs of the model, in any order. Other columns are refused.
    height, length
        Instead of a table: height of the panel's lower edge above the ground, and length of the
        panel along the slope, m. Each of height, length, tilt and events is a number, or a sequence
        or array with a value for each panel.
    tilt
        Tilt of the panel from the horizontal, degrees.
    events
        Number of slide-offs, 1 or more; the stack after each of them is predicted.
    inputs
        Values of further inputs of the model by their paths, such as "snow.cohesion".
    model
        A model file of ``snowshed regress``, or its content from `load_model`, which saves reading
        it for every question. [default: the model in the package]
    scheme
        Scheme of the MPM with which the stacks of the model in the package were computed:
        "thesis" or "objective". [default: thesis]
    kind
        "rbf", "gaussian-process" or "linear"; None: the first of these that the file holds.
    extrapolate
        Whether to answer even if panels lie outside the data; such answers are marked.

    Raises
    ------
    OutsideDataError
        If a panel lies outside the data; it names the panels.
    InputError
        If there is no such model, a model is given with a scheme, or a column or value is not
        possible.

    Examples
    --------
    >>> found = predict(height=2, length=4, tilt=60, events=1).table
    >>> found["target"].tolist()
    ['ratio', 'height', 'length']
    >>> predict(height=2, length=[2, 4, 6], tilt=60, events=5).array("height").shape
    (3, 5)
    """
    if model is not None and scheme is not None:
        raise InputError("scheme: has no effect with a given model, whose data have a scheme")
    if not isinstance(model, StackModel):
        model = _packaged_model(scheme or SCHEMES[0]) if model is None else load_model(model)
    named = {"height": height, "length": length, "tilt": tilt, "events": events, **(inputs or {})}
    questions = Questions.of(panels, named, model.names)
    kind = model.kinds[0] if kind is None else kind
    if kind not in model.kinds:
        raise InputError(f"kind: the model holds no {kind!r}; it has: {', '.join(model.kinds)}")
    outside = _objections(model, questions)
    if outside and not extrapolate:
        raise OutsideDataError(_refusal(outside, questions))
    grid_error = recorded_grid_error(model)
    table = _answers(model, kind, questions, grid_error)
    table["extrapolated"] = np.isin(table["panel"], [questions.labels[n] for n in outside])
    reasons = tuple(text for number in outside for text in _reasons(outside, number, questions))
    asked = settings_text(dict(zip(model.names[1:], questions.inputs[0, 1:])))
    source = grid_error.sentence if grid_error else ""
    return Prediction(
        table, kind, model.title, model.measure, model.settings, source, reasons, asked
    )


@cache
def _packaged_model(scheme: str) -> StackModel:
    return load_model(model_file(scheme))


def _objections(model: StackModel, questions: Questions) -> dict[int, list[str]]:
    """Return the reasons for panels outside the data, by their numbers."""
    starts = np.flatnonzero(np.diff(questions.panel)) + 1
    objections = map(model.domain.objections, np.split(questions.inputs, starts))
    return {number: texts for number, texts in enumerate(objections) if texts}


def _reasons(outside: Mapping[int, list[str]], number: int, questions: Questions) -> list[str]:
    """Return the objections to a panel, with its label if there are other panels."""
    if len(questions.labels) == 1:
        return outside[number]
    return [f"panel {questions.labels[number]}: {text}" for text in outside[number]]


def _refusal(outside: Mapping[int, list[str]], questions: Questions) -> str:
    count = len(questions.labels)
    subject = "the question lies" if count == 1 else f"{len(outside)} of {count} panels lie"
    shown = [
        text
        for number in list(outside)[:MAX_NAMED_PANELS]
        for text in _reasons(outside, number, questions)
    ]
    if len(outside) > MAX_NAMED_PANELS:
        shown.append(f"and {len(outside) - MAX_NAMED_PANELS} more panels")
    this = "this panel" if len(outside) == 1 else "these panels"
    return (
        f"{subject} outside the data: {'; '.join(shown)}; no model is reliable there. Simulate "
        f"{this} (snowshed panel), or force an answer with {argument('extrapolate', True)}"
    )


def _answers(
    model: StackModel, kind: str, questions: Questions, grid_error: Optional[PanelGridError]
) -> pd.DataFrame:
    """Return the answers of one kind of model, the targets of an event below each other."""
    import pandas as pd

    scaled = Scaling.of(model.inputs).scaled(questions.inputs)
    targets = [target for target in model.targets if (target, kind) in model.members]
    events = questions.inputs[:, 0]
    factors = {
        target: grid_error.factors(target, events) if grid_error else np.ones(len(events))
        for target in targets
    }
    parts = [_columns(model, target, kind, scaled, factors[target]) for target in targets]
    rows, count = len(scaled), len(targets)
    columns = {name: np.stack([part[name] for part in parts], axis=1).ravel() for name in parts[0]}
    return pd.DataFrame(
        {
            "panel": questions.labels.take(np.repeat(questions.panel, count)),
            "event": np.repeat(events.astype(int), count),
            "target": targets * rows,
            **columns,
        }
    )


def _columns(
    model: StackModel, target: str, kind: str, scaled: Floats, grid_factor: Floats
) -> dict[str, Floats]:
    """Return the numbers of one target, each with a value for every event.

    A stack may be larger or smaller by the factor of the grid.
    """
    member = model.members[target, kind]
    predicted = member.ensemble.predict(scaled) * member.deviation + member.mean
    value, deviation = predicted.mean(axis=0), predicted.std(axis=0)
    spread = member.spread.half_width(value, deviation, SPREAD_SHARE)
    reach = member.spread.half_width(value, deviation, INTERVAL_SHARE)
    return {
        # Lengths and ratios are not negative, but a linear model may be.
        "value": np.maximum(value, 0.0),
        "spread": spread,
        "low": np.maximum(value - np.hypot(reach, value * (1.0 - 1.0 / grid_factor)), 0.0),
        "high": np.maximum(value + np.hypot(reach, value * (grid_factor - 1.0)), 0.0),
        "models": deviation,
        "grid_factor": grid_factor,
    }
