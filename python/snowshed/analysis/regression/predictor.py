"""Predictions: height, length and ratio of a stack, with their spread, inside the data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.regression.dataset import MODEL
from snowshed.analysis.regression.model_file import StackModel, load_model
from snowshed.analysis.regression.scaling import Scaling
from snowshed.analysis.regression.spread import INTERVAL, SPREAD
from snowshed.io.arrays import Floats
from snowshed.scene.scene import PathLike

if TYPE_CHECKING:
    import pandas as pd


class OutsideDataError(InputError):
    """A question lies outside the data of the model that should answer it."""


@dataclass(frozen=True)
class Prediction:
    """Answers for the events of one panel.

    Attributes
    ----------
    table
        One row per event and target: ``event``, ``target``, ``value``, ``spread`` (half width that
        holds 68 % of the stacks), ``low`` and ``high`` (between which 90 % lie), ``models``
        (standard deviation of the models); m, or 1 for the ratio.
    kind, title
        The kind of model, and what data it comes from.
    measure, settings
        What of the snow was measured, and what the data have in common, as in `StackModel`.
    objections
        Why the question lies outside the data, in words; empty: it lies inside.
    """

    table: pd.DataFrame
    kind: str
    title: str
    measure: str
    settings: Mapping[str, str]
    objections: tuple[str, ...] = ()

    @property
    def extrapolated(self) -> bool:
        """Whether the question lies outside the data."""
        return bool(self.objections)


def predict(
    *,
    height: float,
    length: float,
    tilt: float,
    events: int,
    model: Union[PathLike, StackModel, None] = None,
    kind: Optional[str] = None,
    extrapolate: bool = False,
) -> Prediction:
    """Predict the stack below a panel after each of several events.

    Parameters
    ----------
    height, length
        Of the panel: its lower edge above the ground, and along the slope, m.
    tilt
        Of the panel from the horizontal, degrees.
    events
        Slide-offs, 1 or more.
    model
        A model file of ``snowshed regress``, or what `load_model` made of it, which spares reading
        it for every question; None: the one that comes with snowshed.
    kind
        "rbf", "gaussian-process" or "linear"; None: the first of these that the file holds.
    extrapolate
        Answer even if the question lies outside the data; the answer is marked.

    Raises
    ------
    OutsideDataError
        If the question lies outside the data.
    InputError
        If there is no such model, or a value is not possible.

    Examples
    --------
    >>> found = predict(height=2, length=4, tilt=60, events=1).table
    >>> found["target"].tolist()
    ['ratio', 'height', 'length']
    """
    import pandas as pd

    _check(height=height, length=length, tilt=tilt, events=events)
    if not isinstance(model, StackModel):
        model = _shipped() if model is None else load_model(model)
    kind = model.kinds[0] if kind is None else kind
    if kind not in model.kinds:
        raise InputError(f"kind: the model holds no {kind!r}; it has: {', '.join(model.kinds)}")
    asked = [[event, height, length, tilt] for event in range(1, events + 1)]
    questions = np.array(asked, dtype=float)
    objections = model.domain.objections(questions)
    if objections and not extrapolate:
        raise OutsideDataError(
            f"the question lies outside the data: {'; '.join(objections)}; no model can be "
            "trusted there. Simulate this panel (snowshed panel), or force an answer with "
            "--extrapolate"
        )
    scaled = Scaling.of(model.inputs).scaled(questions)
    parts = [
        _columns(model, target, kind, scaled)
        for target in model.targets
        if (target, kind) in model.members
    ]
    columns = {name: np.stack([part[name] for part in parts], axis=1).ravel() for name in parts[0]}
    table = pd.DataFrame(columns)
    return Prediction(table, kind, model.title, model.measure, model.settings, tuple(objections))


@cache
def _shipped() -> StackModel:
    return load_model(MODEL)


def _columns(model: StackModel, target: str, kind: str, scaled: Floats) -> dict[str, Any]:
    """Return the columns of one target, each with a value for every event."""
    member = model.members[target, kind]
    found = member.ensemble.predict(scaled) * member.deviation + member.mean
    value, deviation = found.mean(axis=0), found.std(axis=0)
    spread = member.spread.half_width(value, deviation, SPREAD)
    reach = member.spread.half_width(value, deviation, INTERVAL)
    return {
        "event": np.arange(1, len(scaled) + 1),
        "target": np.full(len(scaled), target, dtype=object),
        # Neither a length nor a ratio is negative; a linear model may be.
        "value": np.maximum(value, 0.0),
        "spread": spread,
        "low": np.maximum(value - reach, 0.0),
        "high": np.maximum(value + reach, 0.0),
        "models": deviation,
    }


def _check(*, height: float, length: float, tilt: float, events: int) -> None:
    for name, value in (("height", height), ("length", length)):
        if not (np.isfinite(value) and value > 0):
            raise InputError(f"{name}: {value:g} is not a positive length in m")
    if not 0 <= tilt < 90:
        raise InputError(f"tilt: {tilt:g} is outside the allowed range (0 <= value < 90 degrees)")
    if not 1 <= events <= 1000:
        raise InputError(f"events: {events} is outside the allowed range (1 to 1000)")
