"""The functions that scripts call, and their effects on a scene.

Later values override earlier ones, as in the thesis (A.3.1). The guide to Lua scripts lists the
functions.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from types import MappingProxyType
from typing import Any

from snowshed._core import InputError
from snowshed.base.messages import shortened
from snowshed.scene.components import Snow
from snowshed.scene.lua.builder import Builder
from snowshed.scene.lua.sandbox import Call, ScriptLine
from snowshed.scene.scene import Scene

Word = Callable[[Builder, ScriptLine, Any], None]

# The thesis's symbols, equations (1.2.5) to (1.2.7).
SYMBOLS = MappingProxyType(
    {
        "rho": "density",
        "E": "youngs_modulus",
        "nu": "poissons_ratio",
        "M": "critical_state_slope",
        "p0": "preconsolidation_pressure",
        "beta": "cohesion",
        "xi": "hardening_factor",
    }
)

# Functions that make shapes, and the type of the shape.
SHAPES = MappingProxyType(
    {
        "plane": "plane",
        "box": "box",
        "sphere": "sphere",
        "cylinder": "cylinder",
        "capsule": "capsule",
        "plate": "plate",
        "mesh": "mesh",
        "grid": "grid",
        "vdb": "vdb",
        "union": "union",
        "difference": "difference",
        "transform": "transform",
    }
)

RUN_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+=-]{0,99}")
MAX_RUNS = 1000


def apply(call: Call, builder: Builder) -> None:
    """Apply a call to the scene.

    Parameters
    ----------
    call
        A call of one of the `WORDS`.
    builder
        Holds the scene that is changed.

    Raises
    ------
    InputError
        With script and line, if the call makes no sense.

    Examples
    --------
    >>> builder = Builder(".")
    >>> apply(Call("preset", ["lab-50"], ScriptLine("init.lua", 1)), builder)
    >>> apply(Call("gravity", [1.62], ScriptLine("init.lua", 2)), builder)
    >>> apply(Call("run", ["moon"], ScriptLine("init.lua", 3)), builder)
    >>> builder.runs[0].scene.data["gravity"]
    1.62
    """
    if call.word == "run":
        _run(builder, call)  # its errors already name a line
        return
    try:
        if call.word in PATH_WORDS:
            path, value = _arguments(call, 2)
            if not isinstance(path, str):
                raise InputError(f"{call.word} needs a path such as 'snow.density', not {path!r}")
            PATH_WORDS[call.word](builder, path, value, call.script_line)
        else:
            (argument,) = _arguments(call, 1)
            SIMPLE_WORDS[call.word](builder, call.script_line, argument)
    except InputError as error:
        raise InputError(f"{call.script_line}: {error}") from None


def _arguments(call: Call, count: int) -> list[Any]:
    if len(call.arguments) != count:
        raise InputError(f"{call.word} needs {count} argument(s), not {len(call.arguments)}")
    return call.arguments


def _table(word: str, value: Any) -> dict[str, Any]:
    """Return a table of named values; an empty table may come as an empty list."""
    if value == []:
        return {}
    if not isinstance(value, dict):
        raise InputError(f"{word} needs a table of named values, not {value!r}")
    return value


def _name(word: str, value: Any) -> str:
    if not isinstance(value, str):
        raise InputError(f"{word} needs a name, not {value!r}")
    return value


def _preset(builder: Builder, script_line: ScriptLine, value: Any) -> None:
    builder.replace(Scene.preset(_name("preset", value)))


def _value(path: str, builder: Builder, script_line: ScriptLine, value: Any) -> None:
    builder.set(path, value, script_line)


def _section(section: str, builder: Builder, script_line: ScriptLine, value: Any) -> None:
    builder.update(section, _table(section, value), script_line)


def _material(builder: Builder, script_line: ScriptLine, value: Any) -> None:
    """Set the snow: a preset by its name, or values, which override earlier ones."""
    if isinstance(value, str):
        builder.set("snow", Snow.preset(value).to_data(), script_line)
        return
    values: dict[str, Any] = {}
    for key, inner in _table("material", value).items():
        full = SYMBOLS.get(key, key)
        if full in values:
            raise InputError(f"material has {full} twice, by its name and by its symbol")
        values[full] = inner
    builder.update("snow", values, script_line)


def _frames(builder: Builder, script_line: ScriptLine, value: Any) -> None:
    """Write a frame every `interval` seconds, and end an event after `count` of them."""
    values = _table("frames", value)
    interval, count = values.get("interval"), values.get("count")
    if set(values) - {"interval", "count"} or not _positive(interval):
        raise InputError("frames needs an interval in s (more than 0), and may have a count")
    builder.set("output.snapshot_interval", interval, script_line)
    if count is not None:
        if not _positive(count):
            raise InputError(f"frames: count is {count!r}, and must be a number more than 0")
        builder.set("events.max_time", interval * count, script_line)


def _positive(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and value > 0


def _levelset(builder: Builder, script_line: ScriptLine, value: Any) -> None:
    """Add an obstacle, or change the obstacle of the same name."""
    values = _table("levelset", value)
    builder.append_or_change(
        "obstacles", _name("levelset: name", values.get("name", "")), values, script_line
    )


def _body(builder: Builder, script_line: ScriptLine, value: Any) -> None:
    """Add a body of snow, or change the body of the same name; the name exists only in scripts."""
    values = dict(_table("body", value))
    name = _name("body: name", values.pop("name", ""))
    builder.append_or_change("bodies", name, values, script_line)


def _run(builder: Builder, call: Call) -> None:
    """Request a run of the scene with its present values."""
    name = call.arguments[0] if len(call.arguments) == 1 else None
    if not (isinstance(name, str) and RUN_NAME.fullmatch(name)):
        raise InputError(
            f"{call.script_line}: run needs a name for its folder: up to 100 letters, digits and "
            f"._+=- after a letter or digit, not {shortened(repr(name))}"
        )
    if any(name == run.name for run in builder.runs):
        raise InputError(f"{call.script_line}: there is already a run {name!r}")
    if len(builder.runs) == MAX_RUNS:
        raise InputError(f"{call.script_line}: more than {MAX_RUNS} runs; use a study for so many")
    builder.request_run(name, call.script_line)


PATH_WORDS = MappingProxyType({"set": Builder.set, "append": Builder.append})

SIMPLE_WORDS: MappingProxyType[str, Word] = MappingProxyType(
    {
        "preset": _preset,
        "title": partial(_value, "title"),
        "dimension": partial(_value, "dimension"),
        "gravity": partial(_value, "gravity"),
        "grid_size": partial(_value, "numerics.dx"),
        "material": _material,
        "frames": _frames,
        "levelset": _levelset,
        "body": _body,
        "panel": partial(_section, "panel"),
        "slab": partial(_section, "slab"),
        "ground": partial(_section, "ground"),
        "domain": partial(_section, "domain"),
        "seeding": partial(_section, "seeding"),
        "numerics": partial(_section, "numerics"),
        "events": partial(_section, "events"),
        "output": partial(_section, "output"),
    }
)

WORDS = (*SIMPLE_WORDS, *PATH_WORDS, "run")
