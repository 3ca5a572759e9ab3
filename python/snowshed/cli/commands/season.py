"""The command ``snowshed season``: slow modules are imported when it runs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import click

from snowshed._core import InputError
from snowshed.base.formatting import plural
from snowshed.base.interrupt import Interrupted
from snowshed.base.notes import held_notes, record_notes
from snowshed.base.paths import shell_words
from snowshed.cli.exit_codes import Stopped
from snowshed.cli.options.common import (
    PATH,
    ResultsFolder,
    dry_run_option,
    quiet_option,
    resume_flag,
)
from snowshed.cli.options.no_effect import note_options_without_effect, refuse_without_effect
from snowshed.cli.options.rows import rows_options
from snowshed.cli.options.scene import (
    given_options,
    in_terms_of_options,
    path_of,
    scene_from_options,
    scene_options,
)
from snowshed.cli.options.weather import weather_options
from snowshed.cli.output.dry_run import print_cost
from snowshed.cli.output.terminal import plain_table, say, wide_console
from snowshed.cli.output.winters_table import print_quality
from snowshed.scene.scene import Scene
from snowshed.season.rows import PanelRows
from snowshed.season.settings import SeasonSettings

if TYPE_CHECKING:
    from snowshed.scene.scene import ResolvedScene
    from snowshed.season.driver import SeasonPlan, SeasonResult

DEFAULTS = SeasonSettings()

#: Placeholders for values that the season file determines.
PLACEHOLDERS = {"slab.thickness": 0.1}
#: Options of a scene that the releases of a season replace.
OF_SLABS = ("slab__thickness", "slab__layers", "events__count")

SEASON_TABLE = {
    "date": ("date", "{}"),
    "event": ("event", "{}"),
    "released": ("released", "{}"),
    "snowfall\nm": ("snowfall_m", "{:.2f}"),
    "density\nkg/m3": ("density_kg_m3", "{:.0f}"),
    "on panel\nm": ("panel_snow_m", "{:.3f}"),
    "pull\nPa": ("driving_pa", "{:.0f}"),
    "hold\nPa": ("resisting_pa", "{:.0f}"),
    "stack\nheight, m": ("stack_height_m", "{:.2f}"),
    "stack\nlength, m": ("stack_length_m", "{:.2f}"),
    "cover\nm": ("cover_m", "{:.2f}"),
    "clearance\nm": ("clearance_m", "{:.2f}"),
    "to crest\nm": ("crest_clearance_m", "{:.2f}"),
}
MAX_ROWS = 60  # rows; a longer table shows releases only
SETTLED_COLUMN = {"settled\nheight, m": ("settled_height_m", "{:.2f}")}


@click.command()
@click.argument("season_files", metavar="FILE...", type=PATH, nargs=-1, required=True)
@click.option(
    *("-o", "--output", "folder"),
    type=PATH,
    required=True,
    cls=ResultsFolder,
    help="Results folder, new or empty.",
)
@click.option("--scene", "scene_file", type=PATH, help="Scene file to start from.")
@click.option(
    "--release-friction",
    type=float,
    default=DEFAULTS.friction,
    show_default=True,
    help="Static friction coefficient of snow on the panel; without adhesion, snow is released if "
    "tan(tilt) exceeds it.",
)
@click.option(
    "--adhesion",
    type=float,
    default=DEFAULTS.adhesion,
    show_default=True,
    help="Adhesion of the snow to the panel [Pa].",
)
@click.option(
    "--catch",
    type=float,
    default=DEFAULTS.catch,
    show_default=True,
    help="Share of the snowfall that stays on the panel.",
)
@click.option(
    "--new-snow",
    default=DEFAULTS.density,
    show_default=True,
    metavar="NAME",
    help="Relation for days without a density: hedstrom-pomeroy-1998, jordan-1999, vionnet-2012.",
)
@click.option(
    "--settling",
    metavar="NAME",
    default=DEFAULTS.settling,
    show_default=True,
    help="Law of settling: vionnet-2012, essery-2013, or none.",
)
@click.option(
    "--sintering",
    metavar="NAME",
    help="Law of sintering, by which broken snow in the stack regains strength between events: "
    "van-herwijnen-2013, podolskiy-2014.  [default: none]",
)
@click.option(
    "--strength-age",
    type=float,
    metavar="HOURS",
    default=DEFAULTS.strength_age,
    show_default=True,
    help="Age at which bonds reach the strength of the sliding snow [h].",
)
@click.option(
    "--strength",
    metavar="NAME",
    default=DEFAULTS.strength,
    show_default=True,
    help="Relation of a slab's strength to its density: sigrist-2006, or none.",
)
@click.option(
    "--cover",
    metavar="DEPTH",
    default=str(DEFAULTS.cover),
    show_default=True,
    help="Natural snow cover below the stack: weather (from the file), none, or a depth [m].",
)
@click.option(
    "--melt-factor",
    type=float,
    default=DEFAULTS.melt_factor,
    show_default=True,
    help="Melt of the snow on panel and ground and in the stack, per day and degree of the air "
    "above 0 °C [mm of water].",
)
@click.option(
    "--thaw",
    metavar="NAME",
    default=DEFAULTS.thaw,
    show_default=True,
    help="Criterion for wet snow, which does not adhere to the panel: marion-2013 (air warmer than "
    "0 °C, or colder in sunshine), or none.",
)
@rows_options
@weather_options
@resume_flag("Resume an interrupted season.")
@dry_run_option("Print the releases, and the cost of the slide-offs, and exit.")
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
    melt_factor: float,
    thaw: str,
    rows: int,
    pitch: float,
    coverage: float,
    snow_from: str,
    temperature: Optional[Path],
    resume: bool,
    dry_run: bool,
    quiet: bool,
    preset: Optional[str],
    snow_preset: Optional[str],
    **options: Any,
) -> None:
    """Simulate a season: snow accumulates on a panel, is released, and piles up below it.

    FILE comes from a weather station (SMET, iCSV, EPW, TMY3, GHCN-daily, ACIS, MeteoSwiss, IMIS),
    or is a table with the columns date, snowfall_m, temperature_c and, if known, density_kg_m3,
    friction, adhesion_pa, snow_depth_m and irradiance_w_m2. Several FILEs of one station are
    joined: its snow and its temperature, or its years. The options of ``snowshed panel`` describe
    the panel, the ground and the method; --friction is that of sliding snow.

    \b
    Example:
      snowshed season winter.csv --dim 2 --height 0.8 --length 2 --tilt 40 --dx 0.03 -o results
    """  # noqa: D301 - click wants the control character
    with record_notes() if dry_run else held_notes():  # the result has these notes
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
            melt_factor=melt_factor,
            thaw=none_or(thaw),
            rows=PanelRows(rows, pitch),
        )
    refuse_without_effect(OF_SLABS, "on a season: the weather defines its slabs")
    if sintering is None or sintering == "none":
        refuse_without_effect(["strength_age"], "without --sintering")
    scene = _scene(scene_file, preset, snow_preset, options)
    reading = {"coverage": coverage, "snow_from": snow_from, "temperature": temperature}
    if dry_run:
        _print_cost(season_files, scene, settings, reading, quiet=quiet)
        return
    result = _run(season_files, scene, folder, settings, reading, resume=resume, quiet=quiet)
    if not quiet:
        print_season(result, folder, scene)


def none_or(name: Optional[str]) -> Optional[str]:
    """Return the name, or None if it is "none"."""
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
        raise click.UsageError("--scene cannot be combined with --preset or --snow")
    given = given_options(options)
    scene = Scene.load(file) if file else scene_from_options(preset, snow_preset, {})
    if scene.slab is not None:
        scene.slab.layers = None
    try:
        resolved = scene.update({**PLACEHOLDERS, **given}).resolve()
    except InputError as error:
        if file is not None and path_of(error) not in given:
            raise InputError(f"{file}: {error}") from None
        raise in_terms_of_options(error) from None
    note_options_without_effect(given, resolved.data, events_known=False)
    return resolved


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
    from snowshed.season.driver import plan_season

    plan = plan_season(season_files, scene, settings=settings, **reading)
    return simulate_with_progress(plan, folder, settings, resume=resume, quiet=quiet)


def simulate_with_progress(
    plan: SeasonPlan, folder: Path, settings: SeasonSettings, *, resume: bool, quiet: bool
) -> SeasonResult:
    """Simulate a planned season with a progress bar."""
    from snowshed.cli.output.progress import progress_bar
    from snowshed.season.driver import simulate_season

    try:
        with progress_bar(quiet=quiet) as progress:
            return simulate_season(
                plan, folder, settings=settings, resume=resume, progress=progress
            )
    except Interrupted:
        raise Stopped("interrupted; resume with the same command and --resume") from None


def _print_cost(
    season_files: tuple[Path, ...],
    scene: ResolvedScene,
    settings: SeasonSettings,
    reading: Mapping[str, Any],
    *,
    quiet: bool,
) -> None:
    """Print the number of releases and the cost of their slide-offs."""
    from snowshed.season.driver import plan_season

    print_plan_cost(plan_season(season_files, scene, settings=settings, **reading), quiet=quiet)


def print_plan_cost(plan: SeasonPlan, *, quiet: bool) -> None:
    """Print the number of releases of a planned season, and the cost of its slide-offs."""
    for note in () if quiet else plan.record.notes:
        say(f"note: {note}")
    dates = {day.weather.date.date() for day in plan.days}
    releases = plural(sum(day.released for day in plan.days), "release")
    say(f"{releases} in {plural((max(dates) - min(dates)).days + 1, 'day')}")
    if plan.slides is not None:
        print_cost(plan.slides)


def print_season(result: SeasonResult, folder: Path, scene: ResolvedScene) -> None:
    """Print the table, the event that buries the panel, and notes on the limits of the results."""
    from snowshed.season.driver import verdict
    from snowshed.snow.accuracy.mechanisms import Mechanisms
    from snowshed.snow.accuracy.stack_errors import recorded_bias

    console = wide_console(120)
    columns = dict(SEASON_TABLE)
    if (result.table["settled_height_m"] < result.table["stack_height_m"]).any():
        columns.update(SETTLED_COLUMN)
    table = plain_table("Season", columns, padding=0)
    rows, left_out = _rows(result)
    for row in rows:
        table.add_row(*(_cell(row[name], form) for name, form in columns.values()))
    if rows:
        console.print(table)
    if left_out:
        console.print(f"{left_out} rows without a release are in season.csv")
    print_quality(console, result.winters, judged=False)
    for line in (verdict(result), *(f"note: {note}" for note in result.notes)):
        console.print(line)
    console.print(f"season.csv and season.png in {folder}")
    mechanisms = Mechanisms.of_scene(scene.data)
    if result.simulated and mechanisms is not None:
        bias = recorded_bias(int(scene.data["dimension"]), result.simulated, mechanisms)
        console.print(f"error of the grid: {bias}")
    if result.simulated:
        console.print(f"the snow in motion: {shell_words('snowshed', 'view', folder)}")
    if result.simulated and scene.data["output"]["forces"]:
        console.print(f"the loads of the snow: {shell_words('snowshed', 'loads', folder)}")


def _rows(result: SeasonResult) -> tuple[list[dict[str, Any]], int]:
    """Return the rows to print, and the number of left-out rows without a release."""
    table = result.table
    if len(table) > MAX_ROWS:
        table = table[table["released"] == "yes"].head(MAX_ROWS)
    rows = [{str(name): value for name, value in row.items()} for row in table.to_dict("records")]
    return rows, len(result.table) - len(table)


def _cell(value: Any, form: str) -> str:
    missing = not isinstance(value, str) and (value is None or not math.isfinite(_number(value)))
    return "" if missing else form.format(value)


def _number(value: Any) -> float:
    try:
        return float(value)
    except TypeError:  # the value is pandas.NA, a missing integer
        return math.nan
