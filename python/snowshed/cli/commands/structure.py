"""The commands ``snowshed structure …``: scenes of roofs, rows, tables, trackers and terrain.

Their options are the arguments of the builders, which know the defaults.
"""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Optional, get_args

import click

from snowshed._core import InputError
from snowshed.cli.quiet import quiet_option
from snowshed.cli.terminal import say
from snowshed.scene import builders
from snowshed.scene.components import Condition
from snowshed.scene.scene import Scene

PATH = click.Path(path_type=Path)
PICTURES = (".png", ".svg", ".pdf")
Builder = Callable[..., Scene]


class Structure(NamedTuple):
    """A kind of structure: its builder, and an example of its options."""

    build: Builder
    example: str


STRUCTURES = {
    "shed-roof": Structure(
        builders.shed_roof, "--eaves 2.5 --length 4 --tilt 30 --snow 0.3 --guards 0.5 --dx 0.05"
    ),
    "gable-roof": Structure(
        builders.gable_roof, "--eaves 2.5 --length 3 --tilt 40 --snow 0.25 --guards 0.4 --dx 0.05"
    ),
    "rows": Structure(
        builders.panel_rows,
        "--count 3 --pitch 4 --height 0.6 --length 2 --tilt 35 --snow 0.1",
    ),
    "table": Structure(
        builders.panel_table,
        "--modules 3 --gap 0.06 --module-length 1 --height 0.6 --tilt 35 --snow 0.1",
    ),
    "tracker": Structure(builders.tracker, "--axis-height 1.5 --length 2 --snow 0.1 --tilt-to 45"),
    "mesh": Structure(builders.mesh_structure, "carport.stl --snow 0.2 --dx 0.05"),
}
#: What each argument of the builders means.
MEANINGS = {
    "axis_height": "Height of the axis above the ground, m.",
    "azimuth": "Where snow slides to on the map, degrees from north, clockwise.",
    "band": "Which band of a GeoTIFF, from 1; needed where it has several.",
    "condition": "What snow that touches the terrain may do.",
    "count": "Number of panels.",
    "dimension": "2 or 3; in 2 the section of the mesh at y = 0 counts.",
    "dx": "Size of grid cells, m; nothing smaller than two of them is resolved.",
    "eaves": "Height of the eaves above the ground, m.",
    "friction": "Coulomb coefficient of the surface on which the snow slides.",
    "gap": "Between modules, m; 0 or at least two grid cells.",
    "ground_tilt": "Tilt of the ground, degrees; positive falls in the slide direction.",
    "guard_height": "Height of snow guards above the roof, m.",
    "guard_thickness": "Thickness of snow guards along the roof, m.",
    "guards": "Where snow guards stand, m up the slope from the eaves: 0.4 or 0.4,1.5.",
    "height": "Height of the lower edge above the ground, m.",
    "layers": "Layers of triangles by which snow is built up on the mesh.",
    "length": "Length along the slope, m.",
    "lip": "Height of the frame above the face at each module's lower end, m.",
    "max_slope": "Steepest cliff beside elevations of 0 that is believed, degrees.",
    "module_length": "Length of a module along the slope, m.",
    "modules": "Number of modules up the slope.",
    "origin": "East and north of the scene's x = y = 0 on the map, m.",
    "overhang": "Of the roof beyond the walls, m, along the slope.",
    "pitch": "Horizontal distance from one panel to the next, m.",
    "post_size": "Thickness of the posts, m.",
    "posts": "Where posts stand, as parts of the table's length from its lower end.",
    "scale": "Length of a unit of the file, m.",
    "seconds": "How long it takes to turn, s.",
    "settle": "Longest time for the snow to come to rest after the board, s.",
    "snow": "Thickness of the snow, m.",
    "spacing": "Between samples of the terrain, m.",
    "tilt": "Tilt from the horizontal, degrees.",
    "tilt_from": "Tilt before it turns, degrees.",
    "tilt_to": "Tilt after it has turned, degrees.",
    "width": "Width across the slope, m; without it the scene is 2D.",
    "x": "From where to where along the slide direction there is terrain, m.",
    "y": "From where to where across it there is terrain, m; in 3D.",
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
        values = {key: value for key, value in given.items() if value is not None}
        mesh = [values.pop("mesh")] if "mesh" in values else []
        _tell(_write(_built(kind.build, *mesh, **values), file, picture), quiet)

    arguments = inspect.signature(kind.build).parameters
    options: list[click.Parameter] = [
        click.Argument(["mesh"], type=PATH) if argument.name == "file" else _option(argument)
        for argument in arguments.values()
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
    """Return an example of a command in lines that any terminal can show."""
    whole = f"snowshed structure {example} -o scene.json"
    return " \\\n".join(textwrap.wrap(whole, 72, initial_indent="  ", subsequent_indent=6 * " "))


def _terrain() -> click.Command:
    """Return the command that sets a scene on terrain."""

    def write(
        scene: Path, raster: Path, file: Path, picture: Optional[Path], quiet: bool, **given: Any
    ) -> None:
        values = {key: value for key, value in given.items() if value is not None}
        start = Scene.load(scene)
        distances = file.with_suffix(".npy")
        built = _built(builders.on_terrain, start, raster, distances, **values)
        _tell([*_write(built, file, picture), distances], quiet)

    arguments = [*inspect.signature(builders.on_terrain).parameters.values()][3:]
    options = [_option(argument) for argument in arguments]
    command = click.Command(
        "terrain",
        callback=write,
        params=[
            click.Argument(["scene"], type=PATH),
            click.Argument(["raster"], type=PATH),
            *options,
            *_outputs(),
        ],
        help="Write a scene file anew with terrain in place of its ground.\n\nRASTER holds "
        "heights: an ESRI ASCII grid or a GeoTIFF in metres. The signed distances of the terrain "
        "are written beside the scene.\n\n\b\nExample:\n"
        + _wrapped("terrain panel.json hill.asc --origin 2600118 1200215 --azimuth 90 --x -3 8"),
        short_help="Write a scene anew with terrain in place of its ground.",
    )
    return quiet_option(command)


def _outputs() -> list[click.Option]:
    return [
        click.Option(["-o", "--output", "file"], type=PATH, required=True, help="Scene file."),
        click.Option(["--picture"], type=PATH, help="Picture of the scene, such as roof.png."),
    ]


def _option(argument: inspect.Parameter) -> click.Option:
    """Return the option of a builder's argument, of the type that its annotation names."""
    needed = argument.default is inspect.Parameter.empty
    kinds: dict[str, dict[str, Any]] = {
        "int": {"type": int},
        "Optional[int]": {"type": int},
        "Span": {"type": float, "nargs": 2},
        "Condition": {"type": click.Choice(get_args(Condition))},
        "Sequence[float]": {"callback": _listed},
    }
    default = "" if needed or not argument.default else f"  [default: {_shown(argument.default)}]"
    return click.Option(
        [f"--{argument.name.replace('_', '-')}", argument.name],
        required=needed,
        help=MEANINGS[argument.name] + default,
        **kinds.get(str(argument.annotation), {"type": float}),
    )


def _shown(value: Any) -> str:
    return ",".join(map(str, value)) if isinstance(value, tuple) else str(value)


def _listed(_: click.Context, option: click.Parameter, text: Optional[str]) -> Any:
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
    """Write a scene, and its picture where one is wanted; return the files."""
    ready = scene.resolve()
    written = []
    if picture is not None:
        if picture.suffix not in PICTURES:
            raise InputError(f"--picture: {picture}; allowed: {', '.join(PICTURES)}")
        from snowshed.plot.figure_style import save
        from snowshed.plot.scene_picture import scene_figure

        save(scene_figure(ready), picture)
        written.append(picture)
    ready.save(file)
    return [*written, file]


def _tell(written: Sequence[Path], quiet: bool) -> None:
    for file in written if not quiet else ():
        say(file)


for kind_name, kind_of_structure in STRUCTURES.items():
    structure.add_command(_command(kind_name, kind_of_structure))
structure.add_command(_terrain())
