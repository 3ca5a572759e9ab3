"""The commands ``snowshed structure …``: scenes of roofs, rows, tables, trackers and terrain.

Their options are the parameters of the builders, with their defaults and descriptions.
"""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Optional, get_args

import click

from snowshed._core import InputError
from snowshed.cli.options.common import PATH, given_values, quiet_option
from snowshed.cli.options.parameter_docs import parameter_docs
from snowshed.cli.output.terminal import say
from snowshed.scene.builders.meshes import mesh_structure
from snowshed.scene.builders.panels import panel_rows, panel_table
from snowshed.scene.builders.roofs import gable_roof, shed_roof
from snowshed.scene.builders.terrain import on_terrain
from snowshed.scene.builders.tracker import tracker
from snowshed.scene.components import Condition
from snowshed.scene.scene import Scene

PICTURES = (".png", ".svg", ".pdf")
Builder = Callable[..., Scene]


class Structure(NamedTuple):
    """A kind of structure: its builder, and an example of its options."""

    build: Builder
    example: str


STRUCTURES = {
    "shed-roof": Structure(
        shed_roof, "--eaves 2.5 --length 4 --tilt 30 --snow 0.3 --guards 0.5 --dx 0.05"
    ),
    "gable-roof": Structure(
        gable_roof, "--eaves 2.5 --length 3 --tilt 40 --snow 0.25 --guards 0.4 --dx 0.05"
    ),
    "rows": Structure(
        panel_rows,
        "--count 3 --pitch 4 --height 0.6 --length 2 --tilt 35 --snow 0.1",
    ),
    "table": Structure(
        panel_table,
        "--modules 3 --gap 0.06 --module-length 1 --height 0.6 --tilt 35 --snow 0.1",
    ),
    "tracker": Structure(tracker, "--axis-height 1.5 --length 2 --snow 0.1 --tilt-to 45"),
    "mesh": Structure(mesh_structure, "carport.stl --snow 0.2 --dx 0.05"),
}


@click.group()
def structure() -> None:
    """Write scenes of roofs, rows of panels, tables, trackers, meshes and terrain.

    \b
    Example:
      snowshed structure gable-roof --eaves 2.5 --length 3 --tilt 40 --snow 0.25 \\
          --dx 0.05 -o roof.json --picture roof.png
      snowshed run roof.json -o results
    """  # noqa: D301 - click wants the control character


def _command(name: str, kind: Structure) -> click.Command:
    """Return the command of a kind of structure."""

    def write(file: Path, picture: Optional[Path], quiet: bool, **given: Any) -> None:
        values = given_values(given)
        mesh = [values.pop("mesh")] if "mesh" in values else []
        _print_files(_write(_built(kind.build, *mesh, **values), file, picture), quiet)

    docs = parameter_docs(kind.build)
    options: list[click.Parameter] = [
        click.Argument(["mesh"], type=PATH)
        if name == "file"
        else _option(parameter, docs.get(name, ""))
        for name, parameter in inspect.signature(kind.build).parameters.items()
    ]
    summary = str(inspect.getdoc(kind.build)).splitlines()[0].replace("Return", "Write", 1)
    command = click.Command(
        name,
        callback=write,
        params=[*options, *_outputs()],
        help=f"{summary}\n\n\b\nExample:\n" + _wrapped(f"{name} {kind.example}"),
        short_help=summary,
    )
    return quiet_option(command)


def _wrapped(example: str) -> str:
    """Return an example of a command in short lines."""
    command = f"snowshed structure {example} -o scene.json"
    return " \\\n".join(textwrap.wrap(command, 72, initial_indent="  ", subsequent_indent=6 * " "))


def _terrain() -> click.Command:
    """Return the command that sets a scene on terrain."""

    def write(
        scene: Path, raster: Path, file: Path, picture: Optional[Path], quiet: bool, **given: Any
    ) -> None:
        values = given_values(given)
        start = Scene.load(scene)
        distances = file.with_suffix(".npy")
        built = _built(on_terrain, start, raster, distances, **values)
        _print_files([*_write(built, file, picture), distances], quiet)

    docs = parameter_docs(on_terrain)
    parameters = [*inspect.signature(on_terrain).parameters.values()][3:]
    options = [_option(parameter, docs.get(parameter.name, "")) for parameter in parameters]
    command = click.Command(
        "terrain",
        callback=write,
        params=[
            click.Argument(["scene"], type=PATH),
            click.Argument(["raster"], type=PATH),
            *options,
            *_outputs(),
        ],
        help="Write a copy of a scene file with terrain as its ground.\n\nRASTER holds elevations: "
        "an ESRI ASCII grid or a GeoTIFF in metres. The signed distances of the terrain are "
        "written beside the scene.\n\n\b\nExample:\n"
        + _wrapped("terrain panel.json hill.asc --origin 2600118 1200215 --azimuth 90 --x -3 8"),
        short_help="Write a copy of a scene with terrain as its ground.",
    )
    return quiet_option(command)


def _outputs() -> list[click.Option]:
    return [
        click.Option(
            ["-o", "--output", "file"], type=PATH, required=True, help="Scene file to write."
        ),
        click.Option(
            ["--picture"], type=PATH, help="Picture of the scene to write, such as roof.png."
        ),
    ]


def _option(parameter: inspect.Parameter, description: str) -> click.Option:
    """Return the option of a builder's parameter, with the type of its annotation."""
    needed = parameter.default is inspect.Parameter.empty
    kinds: dict[str, dict[str, Any]] = {
        "int": {"type": int},
        "Optional[int]": {"type": int},
        "Span": {"type": float, "nargs": 2},
        "Condition": {"type": click.Choice(get_args(Condition))},
        "Sequence[float]": {"callback": _number_list},
    }
    default = (
        ""
        if needed or not parameter.default
        else f"  [default: {_default_text(parameter.default)}]"
    )
    return click.Option(
        [f"--{parameter.name.replace('_', '-')}", parameter.name],
        required=needed,
        help=description + default,
        **kinds.get(str(parameter.annotation), {"type": float}),
    )


def _default_text(value: Any) -> str:
    return ",".join(map(str, value)) if isinstance(value, tuple) else str(value)


def _number_list(_: click.Context, option: click.Parameter, text: Optional[str]) -> Any:
    try:
        return None if text is None else [float(part) for part in text.split(",")]
    except ValueError:
        raise click.BadParameter(f"{text!r}; needed: numbers with commas", param=option) from None


def _built(build: Builder, *given: Any, **values: Any) -> Scene:
    """Return the scene of a builder; errors name the options."""
    try:
        return build(*given, **values)
    except InputError as error:
        name, colon, rest = str(error).partition(":")
        if colon and name in values:
            raise InputError(f"--{name.replace('_', '-')}:{rest}") from None
        raise


def _write(scene: Scene, file: Path, picture: Optional[Path]) -> list[Path]:
    """Write a scene, and its picture if given; return the files."""
    resolved = scene.resolve()
    written = []
    if picture is not None:
        if picture.suffix not in PICTURES:
            raise InputError(f"--picture: {picture}; allowed: {', '.join(PICTURES)}")
        from snowshed.plot.figure_style import save_figure
        from snowshed.plot.scene_picture import scene_figure

        save_figure(scene_figure(resolved), picture)
        written.append(picture)
    resolved.save(file)
    return [*written, file]


def _print_files(written: Sequence[Path], quiet: bool) -> None:
    for file in written if not quiet else ():
        say(file)


for kind_name, kind_of_structure in STRUCTURES.items():
    structure.add_command(_command(kind_name, kind_of_structure))
structure.add_command(_terrain())
