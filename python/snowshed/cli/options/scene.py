"""Every parameter of a scene as a command-line option, generated from the core's schema.

The option for a parameter is the last part of its path in kebab case (``--youngs-modulus`` for
``snow.youngs_modulus``). Parameters of the panel, slab, ground and domain carry the section's name
in front (``--slab-width``). The names in `SHORT_NAMES` are exceptions to both rules.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Optional, TypeVar

import click
from click.shell_completion import CompletionItem

from snowshed._core import InputError
from snowshed.cli.options.number_texts import numbers
from snowshed.io.input_file import read_input
from snowshed.io.json_text import loads
from snowshed.scene.components import Ground, Panel, Slab, Snow
from snowshed.scene.scene import Scene
from snowshed.scene.schema import Parameter, current_path, scene_parameters

PRESETS = ("lab-40", "lab-50", "sensitivity", "geometry")
SNOWS = ("calibrated", "reference")
SHORT_NAMES = {
    "dimension": "dim",
    "panel.height": "height",
    "panel.length": "length",
    "panel.width": "width",
    "panel.tilt": "tilt",
    "panel.friction": "friction",
    "slab.thickness": "thickness",
    "slab.layers": "layer",
    "events.count": "events",
    "snow.model": "snow-model",
    "obstacles": "obstacle",
    "bodies": "body",
}
#: Parameters whose options ``--help`` shows; ``--help-all`` shows all options.
BASIC_PATHS = (
    "dimension", "panel.height", "panel.length", "panel.width", "panel.tilt", "panel.friction",
    "panel.condition", "slab.thickness", "slab.layers", "ground.tilt", "snow.density",
    "snow.youngs_modulus", "snow.preconsolidation_pressure", "snow.cohesion", "numerics.dx",
    "numerics.threads", "numerics.device", "events.count", "events.max_time",
    "output.snapshot_interval", "output.forces",
)  # fmt: skip
PREFIXED_SECTIONS = ("panel", "slab", "ground", "domain")
TYPES: Mapping[str, Any] = {"number": float, "integer": int, "string": str}

Command = TypeVar("Command", bound=Callable[..., Any])


def _show_all(context: click.Context, parameter: click.Parameter, given: bool) -> None:
    if not given or context.resilient_parsing:
        return
    aliases = {option_name(path) for parameter in scene_parameters() for path in parameter.aliases}
    for option in context.command.params:
        if isinstance(option, click.Option):
            option.hidden = bool(aliases & set(option.opts))
    click.echo(context.get_help())
    context.exit()


def option_name(path: str) -> str:
    """Return the option for a parameter's dotted path.

    Examples
    --------
    >>> [option_name(p) for p in ("panel.tilt", "panel.thickness", "snow.density")]
    ['--tilt', '--panel-thickness', '--density']
    """
    section, _, leaf = path.rpartition(".")
    name = f"{section}-{leaf}" if section in PREFIXED_SECTIONS else leaf
    return "--" + SHORT_NAMES.get(path, name).replace("_", "-").replace(".", "-")


def scene_options(command: Command) -> Command:
    """Add all options that describe a scene to a click command.

    ``--help`` shows those of `BASIC_PATHS`, ``--help-all`` all of them.
    """
    command = click.option(
        "--help-all",
        is_flag=True,
        is_eager=True,
        expose_value=False,
        callback=_show_all,
        help="Show all options, also those of the snow and the method, and exit.",
    )(command)
    for parameter in reversed(scene_parameters()):
        for path in parameter.aliases:
            command = _option(replace(parameter, path=path), hidden=True)(command)
        command = _option(parameter, hidden=parameter.path not in BASIC_PATHS)(command)
    command = click.option(
        "--snow",
        "snow_preset",
        metavar="NAME",
        shell_complete=_completion(SNOWS, files=True),
        help=f"Snow of the thesis ({', '.join(SNOWS)}), or a JSON file of a snow.",
    )(command)
    return click.option(
        "--preset",
        metavar="NAME",
        shell_complete=_completion(PRESETS),
        help=f"Scene to start from: {', '.join(PRESETS)}.",
    )(command)


def _completion(names: Sequence[str], *, files: bool = False) -> Callable[..., Any]:
    """Return the completion of an option: names, or files if no name fits."""

    def complete(_: click.Context, __: click.Parameter, begun: str) -> list[CompletionItem]:
        fitting = [CompletionItem(name) for name in names if name.startswith(begun)]
        return fitting or ([CompletionItem(begun, type="file")] if files else [])

    return complete


def scene_from_options(
    preset: Optional[str], snow_preset: Optional[str], options: Mapping[str, Any]
) -> Scene:
    """Build a scene: the preset (or a bare panel), then the snow, then single options."""
    scene = Scene.preset(preset) if preset else Scene(panel=Panel(), slab=Slab(), ground=Ground())
    if snow_preset:
        scene.update({"snow": Snow.preset_or_file(snow_preset).to_data()})
    return scene.update(given_options(options))


def given_options(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the given options by their paths in a scene."""
    return {
        name.replace("__", "."): value
        for name, value in options.items()
        if value is not None and value != ()
    }


def in_terms_of_options(error: InputError) -> InputError:
    """Return the error with the option in front, if the parameter has an option."""
    path = path_of(error)
    if current_path(path) in {parameter.path for parameter in scene_parameters()}:
        where, colon, rest = str(error).partition(":")
        return InputError(f"{option_name(path)} ({where}){colon}{rest}")
    return error


def path_of(error: InputError) -> str:
    """Return the path of an error's parameter, such as ``panel.tilt``; empty if it names none."""
    where = str(error).partition(":")[0]
    return where[1:].replace("/", ".") if where.startswith("/") else ""


def json_object(text: str) -> Any:
    """Return a JSON object, given as text or as the name of a file."""
    try:
        if not text.lstrip().startswith("{"):
            text = read_input(Path(text)).decode("utf-8")
        return loads(text)
    except (OSError, ValueError, RecursionError) as error:
        raise click.BadParameter(f"{error}; give a JSON object, or its file") from None


def _option(parameter: Parameter, *, hidden: bool = False) -> Callable[[Command], Command]:
    """Return the decorator that adds the option; a hidden one is not in the help."""
    name = option_name(parameter.path)
    target = parameter.path.replace(".", "__")
    text = _help(parameter)
    if parameter.kind == "boolean":
        return click.option(
            f"{name}/--no-{name[2:]}", target, default=None, help=text, hidden=hidden
        )
    if parameter.kind == "list":
        return click.option(
            name, target, type=json_object, multiple=True, metavar="JSON", help=text, hidden=hidden
        )
    if parameter.kind == "vector":

        def vector(text: str) -> list[float]:
            return numbers(name, text, example="0.5,0,1")

        return click.option(name, target, type=vector, metavar="X,Y,Z", help=text, hidden=hidden)
    kind = click.Choice(parameter.choices) if parameter.choices else TYPES[parameter.kind]
    return click.option(name, target, type=kind, help=text, hidden=hidden)


def _help(parameter: Parameter) -> str:
    notes = [parameter.unit] if parameter.unit else []
    if parameter.kind == "list":
        notes.append("may be repeated")
    elif parameter.default not in (None, ""):
        default = parameter.default
        notes.append(f"default {default if isinstance(default, str) else json.dumps(default)}")
    section = parameter.path.partition(".")[0]
    subject = f"{section.capitalize()}: " if section in PREFIXED_SECTIONS else ""
    return subject + parameter.description + (f" [{'; '.join(notes)}]" if notes else "")
