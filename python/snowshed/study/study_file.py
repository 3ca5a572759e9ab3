"""Study files: TOML read and written, and the commented template."""

from __future__ import annotations

import os
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, TypeVar

from snowshed._core import InputError
from snowshed.base.record import check_once
from snowshed.io.input_file import read_input
from snowshed.io.toml import parse_toml, toml_lines, toml_value
from snowshed.methods.registry import resolution_path
from snowshed.scene.accuracy_settings import ACCURACY, FORMER_NAMES, accuracy_of
from snowshed.scene.components import Snow
from snowshed.scene.named_files import FILES
from snowshed.scene.scene import Scene
from snowshed.study.factors import (
    MAX_COUNT,
    SCALES,
    Factor,
    Part,
    Span,
    axis,
    latin_hypercube,
    linear,
    logarithmic,
    sobol,
)
from snowshed.study.named_laws import NamedLaws
from snowshed.study.season_part import SeasonPart

Made = TypeVar("Made")

FACTOR_KEYS = ("axes", "zip", "sample")
KEYS = (
    *("name", "scene", "dimension", "events", "seeds", "accuracy", "season", "description", "laws"),
    *FACTOR_KEYS,
    "part",
)
SCENE_SOURCES = ("preset", "file", "snow_preset")
SAMPLE_KEYS = ("method", "count", "seed", "axes")
RANGE_KEYS = ("from", "to", "step", "count", "scale")
SPAN_KEYS = ("from", "to", "scale")
SAMPLE_METHODS: Mapping[str, Callable[..., Factor]] = {
    "latin-hypercube": latin_hypercube,
    "sobol": sobol,
}

_TEMPLATE = """\
# A study: one scene, and the parameters that vary in it.
#   snowshed study run FILE --dry-run print the number of runs and their time
#   snowshed study run FILE -o DIR    compute them; repeat after an interruption
# Every parameter is named by its path in a scene (see `snowshed schema`). SI units, degrees.

name = "cohesion-and-slope"   # default: the file's name
dimension = 2
events = 3
seeds = 2                     # repetitions: seeds 1, 2; or a list such as [1, 7]

# Common to all runs. In this order, later lines override earlier ones:
[scene]
preset = "sensitivity"        # lab-40, lab-50, sensitivity, geometry
# file = "scene.json"         # a scene file, found from this file's folder
# snow_preset = "reference"   # calibrated, reference
panel.friction = 0.2          # any field of a scene

[accuracy]                    # settings that every row of the table records
dx = 0.02
@OTHERS@

# Every value of every axis with every value of the others.
[axes]
snow.cohesion = [0.1, 0.2, 0.3]
snow.critical_state_slope = { from = 0.3, to = 0.7, step = 0.2 }
# snow.youngs_modulus = { from = 1e5, to = 1e7, count = 3, scale = "log" }

# Parameters that vary in step, crossed with the axes.
# [[zip]]
# panel.height = [1.0, 2.0]
# panel.length = [2.0, 4.0]

# A sample of a box, crossed with the axes. Methods: latin-hypercube, sobol (a power of two).
# [[sample]]
# method = "latin-hypercube"
# count = 20
# seed = 1
# [sample.axes]
# panel.friction = { from = 0.1, to = 0.4 }
# snow.preconsolidation_pressure = { from = 1e3, to = 1e4, scale = "log" }

# A table [season] with weather = "FILE" makes every run a season. A table [laws] names laws of
# one's own for all runs, see the guide to them.

# Several products in a study: each part is crossed with the axes above, and their union runs.
# [[part]]
# axes.panel.tilt = [40]
# [[part]]
# axes.panel.tilt = [50, 60]
"""
_OTHER_SETTINGS = ", ".join(name for name, path in ACCURACY.items() if path != resolution_path({}))

#: A commented study file to begin with.
TEMPLATE = _TEMPLATE.replace(
    "@OTHERS@", textwrap.fill(_OTHER_SETTINGS, 98, initial_indent="# ", subsequent_indent="# ")
)


@dataclass(frozen=True)
class Content:
    """The contents of a study file; see `Study` for the fields."""

    scene: Scene
    parts: Sequence[Part]
    name: str
    seeds: Optional[Sequence[int]]
    description: str
    season: Optional[SeasonPart] = None
    laws: Optional[NamedLaws] = None


@contextmanager
def name_in_errors(file: Path) -> Iterator[None]:
    """Name the file in errors about what it holds."""
    try:
        yield
    except InputError as error:
        if str(error).startswith(f"{file}: "):  # the message names the file already
            raise
        raise InputError(f"{file}: {error}") from None
    except RecursionError:
        raise InputError(f"{file}: nested too deep") from None


def read(file: Path) -> Content:
    """Return the contents of a study file; see `Study.load`, which names the file in errors."""
    return _content(parse_toml(read_input(file)), file)


def text(content: Content) -> str:
    """Return the text of a study file; see `Study.to_toml`."""
    head: dict[str, object] = {"name": content.name}
    if content.description:
        head["description"] = content.description
    if content.seeds is not None:
        head["seeds"] = list(content.seeds)
    folder = Path(content.scene._base_dir).absolute()
    scene = with_absolute_files(content.scene.to_data(), folder)
    blocks = [list(toml_lines(head)), ["[scene]", *toml_lines(scene)]]
    if content.season is not None:
        blocks.append(["[season]", *toml_lines(content.season.data())])
    if content.laws is not None:
        table = {"make": content.laws.make, "files": list(map(str, content.laws.files))}
        blocks.append(["[laws]", *toml_lines({key: v for key, v in table.items() if v})])
    common = _shared_axes(content.parts)
    blocks += _factor_blocks(common, "", folder)
    for part in content.parts:
        if len(content.parts) > 1:
            blocks.append(["[[part]]"])
            blocks += _factor_blocks(part[len(common) :], "part.", folder)
    return "\n".join(line for block in blocks for line in [*block, ""])


def _shared_axes(parts: Sequence[Part]) -> Part:
    """Return the factors with which all parts begin; all factors of a single part."""
    if len(parts) == 1:
        return parts[0]
    shared: list[Factor] = []
    for first, *others in zip(*parts):
        if len(first.columns) > 1 or any(other != first for other in others):
            break
        shared.append(first)
    return shared


def _factor_blocks(part: Part, prefix: str, folder: Path) -> Iterator[list[str]]:
    """Yield the lines of each table of factors, in the order in which they are read."""
    columns = [with_absolute_files(dict(factor.columns), folder) for factor in part]
    single = [len(factor) == 1 for factor in columns]
    first = single.index(False) if False in single else len(columns)
    axes = {path: values for factor in columns[:first] for path, values in factor.items()}
    if axes:
        yield [f"[{prefix}axes]", *_axis_lines(axes)]
    for factor in columns[first:]:
        yield [f"[[{prefix}zip]]", *_axis_lines(factor)]


def _axis_lines(axes: Mapping[str, Any]) -> list[str]:
    """Return a line for each axis, in the order in which they are read."""
    lines = list(toml_lines(axes))
    if list(_flatten(parse_toml("\n".join(lines).encode()))) == list(axes):
        return lines
    return [f"{toml_value(path)} = {toml_value(values)}" for path, values in axes.items()]


def _content(data: dict[str, Any], file: Path) -> Content:
    _check_keys(data, KEYS, "")
    folder = file.absolute().parent
    data = with_absolute_files(data, folder)
    common = _factors(data, "")
    parts: list[Part] = [common]
    if "part" in data:
        parts = [[*common, *_part(part, where)] for part, where in _tables(data, "part", "")]
    return Content(
        _scene(data, folder),
        parts,
        _checked_value(data.get("name", file.stem), str, "name", "a text"),
        _seeds(data["seeds"]) if "seeds" in data else None,
        _checked_value(data.get("description", ""), str, "description", "a text"),
        SeasonPart.of(_table(data["season"], "season"), folder) if "season" in data else None,
        _laws(_table(data["laws"], "laws"), folder) if "laws" in data else None,
    )


def _laws(table: Mapping[str, Any], folder: Path) -> NamedLaws:
    _check_keys(table, ("make", "files"), "laws.")
    make = _checked_value(table.get("make"), str, "laws.make", 'a text "module:name"')
    files = _checked_value(table.get("files", []), list, "laws.files", "a list of files")
    if not all(isinstance(file, str) for file in files):
        raise InputError("laws.files: not a list of files")
    return NamedLaws(make, [folder / file for file in files])


def _scene(data: Mapping[str, Any], folder: Path) -> Scene:
    given = dict(_table(data.get("scene"), "scene"))
    sources = {key: given.pop(key) for key in SCENE_SOURCES if key in given}
    for key, value in sources.items():
        _checked_value(value, str, f"scene.{key}", "a text")
    scene = Scene()
    if "preset" in sources:
        scene = _at_key("scene", Scene.preset, sources["preset"])
    if "file" in sources:
        scene.update(_scene_file(Path(sources["file"])))
    if "snow_preset" in sources:
        snow = _at_key("scene", Snow.preset, sources["snow_preset"])
        scene.update({"snow": snow.to_data()})
    _at_key("scene", scene.update, given)
    for key, value in given.items():
        if value == {} and getattr(scene, key, None) is None:  # a part with all its defaults
            _at_key("scene", scene.set, key, value)
    for key, path in (("dimension", "dimension"), ("events", "events.count")):
        if key in data:
            scene.set(path, _checked_value(data[key], int, key, "a whole number"))
    accuracy = _table(data.get("accuracy", {}), "accuracy")
    names = {key: FORMER_NAMES.get(key, key) for key in accuracy}
    settings = accuracy_of(scene.to_data())
    _check_keys(names.values(), tuple(settings), "accuracy.")
    _at_key("accuracy", check_once, names, "")
    return scene.update({settings[names[key]]: value for key, value in accuracy.items()})


def _scene_file(file: Path) -> dict[str, Any]:
    data: dict[str, Any] = with_absolute_files(Scene.load(file).to_data(), file.parent)
    return data


def with_absolute_files(value: Any, folder: Path) -> Any:
    """Make the path under every key of a file absolute, because a study's scenes have no folder."""
    if isinstance(value, list):
        return [with_absolute_files(item, folder) for item in value]
    if not isinstance(value, dict):
        return value
    return {
        key: _absolute(inner, folder)
        if key.rpartition(".")[2] in FILES
        else with_absolute_files(inner, folder)
        for key, inner in value.items()
    }


def _absolute(value: Any, folder: Path) -> Any:
    """Return the path of a file, or the paths of an axis of files, relative to `folder`."""
    if isinstance(value, list):
        return [_absolute(item, folder) for item in value]
    return os.fspath(folder / value) if value and isinstance(value, (str, os.PathLike)) else value


def _seeds(value: Any) -> list[int]:
    if type(value) is int and 0 < value <= MAX_COUNT:
        return list(range(1, value + 1))
    if isinstance(value, list) and value and all(type(seed) is int for seed in value):
        return value
    raise InputError(
        f"seeds: {value!r} is neither a number of seeds (1 to {MAX_COUNT}) nor a list of them"
    )


def _part(part: Mapping[str, Any], where: str) -> list[Factor]:
    _check_keys(part, FACTOR_KEYS, f"{where}.")
    return _factors(part, f"{where}.")


def _factors(data: Mapping[str, Any], where: str) -> list[Factor]:
    """Return the factors in a table with the keys axes, zip and sample."""
    axes = _flatten(_table(data.get("axes", {}), f"{where}axes"))
    return [
        *(_at_key(f"{where}axes", axis, path, _values(value, f"{where}axes.{path}"))
          for path, value in axes.items()),
        *(_zip_factor(table, inside) for table, inside in _tables(data, "zip", where)),
        *(_sample(table, inside) for table, inside in _tables(data, "sample", where)),
    ]  # fmt: skip


def _zip_factor(table: Mapping[str, Any], where: str) -> Factor:
    columns = {path: _values(value, f"{where}.{path}") for path, value in _flatten(table).items()}
    return _at_key(where, Factor, columns)


def _sample(table: Mapping[str, Any], where: str) -> Factor:
    _check_keys(table, SAMPLE_KEYS, f"{where}.")
    method = table.get("method", "latin-hypercube")
    if not isinstance(method, str) or method not in SAMPLE_METHODS:
        allowed = ", ".join(SAMPLE_METHODS)
        raise InputError(f"{where}.method: {method!r} is unknown; allowed: {allowed}")
    count = _checked_value(table.get("count"), int, f"{where}.count", "a whole number")
    seed = _checked_value(table.get("seed", 1), int, f"{where}.seed", "a whole number")
    axes = _flatten(_table(table.get("axes", {}), f"{where}.axes"))
    spans = {path: _span(value, f"{where}.axes.{path}") for path, value in axes.items()}
    return _at_key(where, SAMPLE_METHODS[method], spans, count, seed=seed)


def _span(value: Any, where: str) -> Span:
    numbers = _range_numbers(value, SPAN_KEYS, where)
    return _at_key(where, Span, numbers["from"], numbers["to"], value.get("scale", "linear"))


def _values(value: Any, where: str) -> list[Any]:
    """Return the values of an axis: a list, a range, or a single value."""
    if isinstance(value, dict):
        return _range(value, where)
    return value if isinstance(value, list) else [value]


def _range(value: Mapping[str, Any], where: str) -> list[float]:
    numbers = _range_numbers(value, RANGE_KEYS, where)
    start, stop = numbers.pop("from"), numbers.pop("to")
    if "count" in numbers:
        _checked_value(value["count"], int, f"{where}.count", "a whole number")
    scale = value.get("scale", "linear")
    if scale == "linear":
        return _at_key(where, linear, start, stop, **numbers)
    if scale == "log":
        if "step" in numbers or "count" not in numbers:
            raise InputError(f"{where}: a logarithmic range needs a count, and has no step")
        return _at_key(where, logarithmic, start, stop, numbers["count"])
    raise InputError(f"{where}.scale: {scale!r} is unknown; allowed: {', '.join(SCALES)}")


def _range_numbers(value: Any, keys: tuple[str, ...], where: str) -> dict[str, Any]:
    """Return the checked numbers of a range: `from`, `to` and the other `keys`."""
    if not isinstance(value, dict):
        raise InputError(f"{where}: {value!r} is not a range such as {{ from = 1, to = 2 }}")
    _check_keys(value, keys, f"{where}.")
    for key in ("from", "to"):
        if key not in value:
            raise InputError(f"{where}.{key}: missing; a range needs from and to")
    numbers = {key: number for key, number in value.items() if key != "scale"}
    for key, number in numbers.items():
        if isinstance(number, bool) or not isinstance(number, (int, float)):
            raise InputError(f"{where}.{key}: {number!r} is not a number")
    return numbers


def _flatten(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return the values of nested tables by dotted paths; a range is a value, not a table."""
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, dict) and not _is_range(value):
            flat.update(_flatten(value, f"{prefix}{key}."))
        else:
            flat[f"{prefix}{key}"] = value
    return flat


def _is_range(table: Mapping[str, Any]) -> bool:
    """Return whether a table is a range, and not parameters that are called like its keys."""
    nested = any(isinstance(value, (dict, list)) for value in table.values())
    return not nested and bool(table.keys() & set(RANGE_KEYS))


def _tables(data: Mapping[str, Any], key: str, where: str) -> list[tuple[Mapping[str, Any], str]]:
    """Return the tables of an array of tables, each with its place, counted from 1."""
    tables = data.get(key, [])
    if not isinstance(tables, list):
        raise InputError(f"{where}{key}: not a list of tables; write [[{where}{key}]]")
    return [
        (_table(table, f"{where}{key}[{i}]"), f"{where}{key}[{i}]")
        for i, table in enumerate(tables, 1)
    ]


def _table(value: Any, where: str) -> Mapping[str, Any]:
    if value is None:
        raise InputError(f"{where}: missing; write a table [{where}]")
    if not isinstance(value, dict):
        raise InputError(f"{where}: {value!r} is not a table; write [{where}]")
    return value


def _check_keys(data: Iterable[str], allowed: tuple[str, ...], where: str) -> None:
    for key in data:
        if key not in allowed:
            raise InputError(f"{where}{key}: unknown key; allowed: {', '.join(allowed)}")


def _checked_value(value: Any, kind: type, where: str, expected: str) -> Any:
    if value is None:
        raise InputError(f"{where}: missing; give {expected}")
    if not isinstance(value, kind) or isinstance(value, bool):
        raise InputError(f"{where}: {value!r} is not {expected}")
    return value


def _at_key(where: str, make: Callable[..., Made], *arguments: Any, **options: Any) -> Made:
    """Call `make`, and name the place in the file in its errors."""
    try:
        return make(*arguments, **options)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
