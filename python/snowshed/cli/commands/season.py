"""The command ``snowshed season``; slow imports are made when it runs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import click

from snowshed._core import InputError
from snowshed.base.interrupt import Interrupted
from snowshed.cli.exit_codes import Stopped
from snowshed.cli.quiet import quiet_option
from snowshed.cli.scene_options import (
    in_terms_of_options,
    path_of,
    scene_from_options,
    scene_options,
)
from snowshed.cli.weather_options import weather_options
from snowshed.scene.scene import Scene
from snowshed.season.settings import SeasonSettings

if TYPE_CHECKING:
    from snowshed.scene.scene import ResolvedScene
    from snowshed.season.driver import SeasonResult

PATH = click.Path(path_type=Path)
DEFAULTS = SeasonSettings()

# Values that the season file decides, and that need not be given.
DECIDED = {"slab.thickness": 0.1}


@click.command()
@click.argument("season_files", metavar="FILE...", type=PATH, nargs=-1, required=True)
@click.option(
    "-o", "--output", "folder", type=PATH, required=True, help="Results folder, new or empty."
)
@click.option("--scene", "scene_file", type=PATH, help="Scene file to start from.")
@click.option(
    "--release-friction",
    type=float,
    default=DEFAULTS.friction,
    show_default=True,
    help="Static Coulomb coefficient that the snow must overcome to let go.",
)
@click.option(
    "--adhesion",
    type=float,
    default=DEFAULTS.adhesion,
    show_default=True,
    help="What else holds the snow, Pa.",
)
@click.option(
    "--catch",
    type=float,
    default=DEFAULTS.catch,
    show_default=True,
    help="Part of the snowfall that stays on the panel.",
)
@click.option(
    "--new-snow",
    default=DEFAULTS.density,
    show_default=True,
    metavar="NAME",
    help="Relation for rows without a density: hedstrom-pomeroy-1998, jordan-1999, vionnet-2012.",
)
@click.option(
    "--settling",
    metavar="NAME",
    default=DEFAULTS.settling,
    show_default=True,
    help="Law by which snow settles: vionnet-2012, essery-2013, or none.",
)
@click.option(
    "--sintering",
    metavar="NAME",
    help="Law by which broken snow in the stack regains strength between events: "
    "van-herwijnen-2013, podolskiy-2014.  [default: none]",
)
@click.option(
    "--strength-age",
    type=float,
    metavar="HOURS",
    default=DEFAULTS.strength_age,
    show_default=True,
    help="Age of bonds that have the strength of the snow that slides.",
)
@click.option(
    "--strength",
    metavar="NAME",
    default=DEFAULTS.strength,
    show_default=True,
    help="Relation by which the strength of a slab follows from its density: sigrist-2006, or "
    "none.",
)
@click.option(
    "--cover",
    metavar="DEPTH",
    default=str(DEFAULTS.cover),
    show_default=True,
    help="Natural snow cover below the stack: weather (from the file), none, or a depth in m.",
)
@weather_options
@click.option("--resume", is_flag=True, help="Go on with an interrupted season.")
@quiet_option
@scene_options
def season(
    season_files: tuple[Path, ...],
    folder: Path,
    scene_file: Optional[Path],
    release_friction: float,
    adhesion: float,
    catch: float,
    new_snow: str,
    settling: Optional[str],
    sintering: Optional[str],
    strength_age: float,
    strength: str,
    cover: str,
    coverage: float,
    snow_from: str,
    temperature: Optional[Path],
    resume: bool,
    quiet: bool,
    preset: Optional[str],
    snow_preset: Optional[str],
    **options: Any,
) -> None:
    """Simulate a season: snow accumulates on a panel, is released, and piles up below it.

    FILE is that of a weather station (SMET, iCSV, EPW, TMY3, GHCN-daily, ACIS, MeteoSwiss, IMIS),
    or a table with the columns date, snowfall_m, temperature_c and, if known, density_kg_m3,
    friction, adhesion_pa and snow_depth_m. Several FILEs of one station are read as one: those of
    its snow and its temperature, or of its years. The panel, the ground and the method are
    described by the same options as in ``snowshed panel``; --friction is that of sliding snow.

    \b
    Example:
      snowshed season winter.csv --dim 2 --height 0.8 --length 2 --tilt 40 --dx 0.03 -o results
    """  # noqa: D301 - click wants the control character
    settings = SeasonSettings(
        release_friction,
        adhesion,
        catch,
        new_snow,
        none_or(settling),
        none_or(sintering),
        strength_age,
        none_or(strength),
        depth_or_word(cover),
    )
    scene = _scene(scene_file, preset, snow_preset, options)
    reading = {"coverage": coverage, "snow_from": snow_from, "temperature": temperature}
    result = _run(season_files, scene, folder, settings, reading, resume=resume, quiet=quiet)
    if not quiet:
        from snowshed.cli.display.season import print_season

        print_season(result, folder)


def none_or(name: Optional[str]) -> Optional[str]:
    """Return the name, or None where it is "none"."""
    return None if name == "none" else name


def depth_or_word(text: str) -> Union[str, float]:
    """Return a depth, m, if the text is a number, else the text."""
    try:
        return float(text)
    except ValueError:
        return text


def _scene(
    file: Optional[Path], preset: Optional[str], snow_preset: Optional[str], options: dict[str, Any]
) -> ResolvedScene:
    if file is not None and (preset or snow_preset):
        raise click.UsageError("--scene does not go with --preset or --snow")
    given = _given(options)
    scene = Scene.load(file) if file else scene_from_options(preset, snow_preset, {})
    if scene.slab is not None:
        scene.slab.layers = None
    try:
        for path, value in {**DECIDED, **given}.items():
            scene.set(path, value)
        return scene.resolve()
    except InputError as error:
        if file is not None and path_of(error) not in given:
            raise InputError(f"{file}: {error}") from None
        raise in_terms_of_options(error) from None


def _given(options: dict[str, Any]) -> dict[str, Any]:
    """Return the given options by their paths in a scene."""
    return {
        name.replace("__", "."): value
        for name, value in options.items()
        if value is not None and value != ()
    }


def _run(
    season_files: tuple[Path, ...],
    scene: ResolvedScene,
    folder: Path,
    settings: SeasonSettings,
    reading: Mapping[str, Any],
    *,
    resume: bool,
    quiet: bool,
) -> SeasonResult:
    from snowshed.cli.progress import progress_bar
    from snowshed.season.driver import run_season

    options = {**reading, "resume": resume}
    try:
        with progress_bar(quiet=quiet) as progress:
            return run_season(
                season_files, scene, folder, settings=settings, progress=progress, **options
            )
    except Interrupted:
        raise Stopped("interrupted; go on with the same command and --resume") from None
