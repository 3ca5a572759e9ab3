"""Models as files: NumPy arrays and JSON in a zip archive, which cannot hold code."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed._core import version as snowshed_version
from snowshed.analysis.regression.domain import DataDomain
from snowshed.analysis.regression.ensemble import Ensemble
from snowshed.analysis.regression.rows import INPUTS, TARGETS, is_input
from snowshed.analysis.regression.scaling import Scaling
from snowshed.analysis.regression.spread import INTERVAL_SHARE, SPREAD_SHARE, Spread
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.base.damage import DAMAGED
from snowshed.base.paths import PathLike
from snowshed.io.array_archive import open_archive
from snowshed.io.atomic import replacing
from snowshed.io.input_file import read_regular
from snowshed.scene.accuracy_settings import FORMER_NAMES
from snowshed.snow.stack.quantities import measure_named
from snowshed.study.table import FORMER_TRIMMING

FORMAT = "snowshed stack model"
VERSION = 1
MAX_BYTES = 2**28  # bytes, unpacked
MAX_VALUE = 1e50  # largest value in an array; its square is finite
MAX_METADATA_LENGTH = 2**20  # characters
#: Kinds of model that a file may hold: all are sums of kernels. The first in a file answers.
STORED_KINDS = ("rbf", "gaussian-process", "linear")
ENSEMBLE_ARRAYS = ("coefficients", "intercepts", "rates")


@dataclass(frozen=True)
class Member:
    """An ensemble that predicts one target.

    Attributes
    ----------
    ensemble
        In standardised inputs and targets.
    mean, deviation
        Mean and deviation of the target, which standardise it, (5.2.12), in its unit.
    spread
        Spread of its predictions.
    """

    ensemble: Ensemble
    mean: float
    deviation: float
    spread: Spread


@dataclass(frozen=True)
class StackModel:
    """A model that predicts stacks: an ensemble for each target and kind of model.

    Attributes
    ----------
    inputs
        All rows the models come from, shape (n, k), the columns of `names`.
    members
        Models by target and kind.
    title
        Title of the data.
    measure
        "stack" or "body", as for `read_rows`.
    settings
        Common settings of all rows, as in `StackRows`.
    names
        Names of the inputs; the event is the first.
    """

    inputs: Floats
    members: Mapping[tuple[str, str], Member]
    title: str
    measure: str
    settings: Mapping[str, str] = field(default_factory=dict)
    names: Sequence[str] = INPUTS

    @cached_property
    def domain(self) -> DataDomain:
        """The domain of the model."""
        return DataDomain(self.inputs, self.names)

    @property
    def targets(self) -> list[str]:
        """The targets that can be predicted."""
        return [name for name in TARGETS if any(name == target for target, _ in self.members)]

    @property
    def kinds(self) -> list[str]:
        """The kinds of model in the file; the first one answers."""
        return [name for name in STORED_KINDS if any(name == kind for _, kind in self.members)]


@checked
def save_model(model: StackModel, file: PathLike) -> None:
    """Write a model; the file appears whole or not at all."""
    arrays: dict[str, Any] = {"inputs": model.inputs}
    members: dict[str, Any] = {}
    for (target, kind), member in model.members.items():
        name = f"{target}/{kind}"
        for part in ENSEMBLE_ARRAYS:
            arrays[f"{name}/{part}"] = getattr(member.ensemble, part)
        members[name] = {
            "mean": member.mean,
            "deviation": member.deviation,
            "spread": {
                "floor": member.spread.floor,
                "slope": member.spread.slope,
                "factors": [[part, factor] for part, factor in member.spread.factors.items()],
            },
        }
    facts = {
        "format": FORMAT,
        "format_version": VERSION,
        "snowshed": snowshed_version,
        "title": model.title,
        "measure": model.measure,
        "settings": dict(model.settings),
        "inputs": list(model.names),
        "members": members,
    }
    with replacing(file) as beside, beside.open("wb") as stream:
        np.savez_compressed(stream, facts=np.array(json.dumps(facts)), **arrays)


@checked
def load_model(file: PathLike) -> StackModel:
    """Read a model. Nothing in the file is executed.

    Raises
    ------
    InputError
        If it is not a model, is damaged, or holds invalid values; the message names file and key.
    """
    path = Path(file)
    try:
        content = read_regular(path)
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}") from None
    try:
        with open_archive(content, MAX_BYTES) as archive:
            return _ModelReader(archive).model()
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except (OSError, *DAMAGED) as error:
        raise InputError(f"{path}: damaged, or not a model ({error})") from None


class _ModelReader:
    """Reads a model from an archive, and checks everything."""

    def __init__(self, archive: Any) -> None:
        self._archive = archive

    def model(self) -> StackModel:
        facts = self._facts()
        names = facts["inputs"]
        inputs = self._array("inputs", ("n", len(names)))
        described = _entry(facts, "members", dict)
        members = {}
        for name, member_facts in described.items():
            target, _, kind = name.partition("/")
            if target not in TARGETS or kind not in STORED_KINDS:
                raise InputError(f"members.{name}: unknown target or kind of model")
            members[target, kind] = self._member(name, member_facts, inputs)
        if not members:
            raise InputError("members: none")
        measure = _entry(facts, "measure", str)
        measure_named(measure)
        settings = _entry(facts, "settings", dict)
        if not all(isinstance(value, str) for value in settings.values()):
            raise InputError("settings: must be strings")
        settings = {FORMER_NAMES.get(key, key): value for key, value in settings.items()}
        settings.setdefault("trimming", FORMER_TRIMMING)
        title = _entry(facts, "title", str)
        return StackModel(inputs, members, title, measure, settings, names)

    def _facts(self) -> dict[str, Any]:
        text = self._raw("facts")
        if (
            text.dtype.kind != "U"
            or text.ndim != 0
            or text.dtype.itemsize > 4 * MAX_METADATA_LENGTH
        ):
            raise InputError("facts: not a text")
        try:
            facts = json.loads(str(text))
        except (ValueError, RecursionError) as error:
            raise InputError(f"facts: not JSON: {error}") from None
        if not isinstance(facts, dict) or facts.get("format") != FORMAT:
            raise InputError(f"facts: not a {FORMAT}")
        if facts.get("format_version") != VERSION:
            raise InputError(
                f"format_version: {facts.get('format_version')!r}; this snowshed reads {VERSION}"
            )
        facts["inputs"] = _names(facts.get("inputs"))
        return facts

    def _member(self, name: str, facts: Any, inputs: Floats) -> Member:
        where = f"members.{name}"
        if not isinstance(facts, dict):
            raise InputError(f"{where}: not an object")
        count, dimension = inputs.shape
        coefficients = self._array(f"{name}/coefficients", ("m", count))
        models = len(coefficients)
        intercepts = self._array(f"{name}/intercepts", (models,))
        rates = self._array(f"{name}/rates", (models, 0 if name.endswith("/linear") else dimension))
        if (rates < 0).any():
            raise InputError(f"{name}/rates: negative values")
        return Member(
            Ensemble(Scaling.of(inputs).scaled(inputs), coefficients, intercepts, rates),
            _number(facts, "mean", where),
            _number(facts, "deviation", where, positive=True),
            _spread(_entry(facts, "spread", dict, where), f"{where}.spread"),
        )

    def _array(self, key: str, shape: tuple[object, ...]) -> Floats:
        """Return an array of finite numbers; a word in `shape` stands for any length from 1."""
        array = self._raw(key)
        fits = array.dtype == np.float64 and array.ndim == len(shape)
        fits = fits and all(
            length == size if isinstance(size, int) else length >= 1
            for length, size in zip(array.shape, shape)
        )
        if not fits:
            wanted = " x ".join(map(str, shape))
            raise InputError(
                f"{key}: {array.dtype} numbers of shape {array.shape}; must be float64, {wanted}"
            )
        if not (np.abs(array) <= MAX_VALUE).all():
            raise InputError(f"{key}: holds values that are not finite, or beyond {MAX_VALUE:g}")
        return np.asarray(array)

    def _raw(self, key: str) -> Any:
        if key not in self._archive:
            raise InputError(f"{key}: missing")
        try:
            array = self._archive[key]
        except DAMAGED as error:
            raise InputError(f"{key}: {error}") from None
        if not isinstance(array, np.ndarray):
            raise InputError(f"{key}: not an array")
        return array


def _names(given: Any) -> tuple[str, ...]:
    """Return the names of a model's inputs: the event, and parameters of a scene, each once."""
    sound = isinstance(given, list) and len(given) > 1 and given[0] == INPUTS[0]
    if not sound or not all(is_input(name) for name in given[1:]):
        raise InputError(
            f"inputs: {given!r}; must be {INPUTS[0]} and parameters of a scene, such as "
            f"{', '.join(INPUTS[1:])}"
        )
    if len(set(given)) < len(given):
        raise InputError(f"inputs: {given!r}; each may occur once")
    return tuple(given)


def _spread(facts: dict[str, Any], where: str) -> Spread:
    listed = _entry(facts, "factors", list, where)
    try:
        factors = {float(part): float(factor) for part, factor in listed}
    except (TypeError, ValueError):
        raise InputError(f"{where}.factors: not pairs of numbers") from None
    if set(factors) != {SPREAD_SHARE, INTERVAL_SHARE} or not all(
        0 <= x < 1e12 for x in factors.values()
    ):
        raise InputError(
            f"{where}.factors: must be given, and not negative; the required shares are "
            f"{SPREAD_SHARE} and {INTERVAL_SHARE}"
        )
    slope = _number(facts, "slope", where)
    if slope < 0:
        raise InputError(f"{where}.slope: {slope} is negative")
    return Spread(_number(facts, "floor", where, positive=True), slope, factors)


def _entry(facts: dict[str, Any], key: str, kind: type, where: str = "") -> Any:
    value = facts.get(key)
    if not isinstance(value, kind):
        place = f"{where}.{key}" if where else key
        raise InputError(f"{place}: missing, or not {kind.__name__}")
    return value


def _number(facts: dict[str, Any], key: str, where: str, *, positive: bool = False) -> float:
    value: Any = facts.get(key)
    good = isinstance(value, (int, float)) and not isinstance(value, bool) and np.isfinite(value)
    if not good or (positive and value <= 0):
        wanted = "a positive number" if positive else "a number"
        raise InputError(f"{where}.{key}: {value!r} is not {wanted}")
    return float(value)
