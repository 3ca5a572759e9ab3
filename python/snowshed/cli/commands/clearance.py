"""The command ``snowshed clearance``: slow modules are imported when it runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import click

from snowshed._core import InputError
from snowshed.base.formatting import about, percent, plural
from snowshed.base.notes import InputNote, issue_note
from snowshed.cli.exit_codes import Stopped
from snowshed.cli.options.accuracy import parse_fraction
from snowshed.cli.options.common import (
    PATH,
    ResultsFolder,
    dry_run_option,
    jobs_option,
    quiet_option,
    resume_option,
    same_version_option,
)
from snowshed.cli.options.no_effect import refuse_without_effect
from snowshed.cli.options.number_texts import named_once, named_span, numbers
from snowshed.cli.options.rows import rows_options
from snowshed.cli.options.weather import weather_options
from snowshed.cli.output.terminal import plain_table, say, wide_console
from snowshed.cli.output.winters_table import print_quality
from snowshed.scene.schema import scene_parameters

if TYPE_CHECKING:
    from snowshed.analysis.clearance.answer import ClearanceResult
    from snowshed.analysis.clearance.inputs import ClearanceInputs
    from snowshed.analysis.clearance.panel_design import PanelDesign, SnowRanges
    from snowshed.season.settings import SeasonSettings
    from snowshed.season.weather.season_record import SeasonRecord

SCHEME = next(item for item in scene_parameters() if item.path == "numerics.scheme")
EXAMPLE = "example"  # this word instead of a file: synthetic winters
#: Names of `--range` that are shorter than those in Python.
SHORT_NAMES = {"sliding": "sliding_friction", "melt": "melt_factor"}


@click.command()
@click.argument("weather", metavar="WEATHER...", type=PATH, nargs=-1, required=True)
@click.option(
    "--slope-length", required=True, help="Length of the panel along the slope [m]; a list: 3,4,5."
)
@click.option("--tilt", required=True, help="Tilt from the horizontal [degrees]; a list: 40,60.")
@click.option(
    "--heights",
    default="1:4:0.5",
    show_default=True,
    help="Candidate heights of the lower edge [m]: a number, a list, or FROM:TO:STEP.",
)
@click.option(
    "--range",
    "spans",
    multiple=True,
    metavar="NAME=LOW:HIGH",
    help="Range of an uncertain parameter: friction, adhesion, sliding, strength, melt, catch. "
    "Repeatable; NAME=VALUE sets a known value.",
)
@click.option(
    "--draws",
    type=int,
    help="Seasons for each winter.  [default: 3, and more if there are fewer than seven winters]",
)
@click.option("--seed", type=int, default=1, show_default=True, help="Random seed.")
@click.option(
    "--ground-tilt",
    type=click.FloatRange(-60.0, 60.0, min_open=True, max_open=True),
    default=0.0,
    show_default=True,
    help="Tilt of the ground; positive falls in the slide direction [degrees].",
)
@click.option(
    "--dx",
    type=click.FloatRange(0.005, 0.2),
    help="Size of the grid cells [m]. Releases thinner than two cells slide with those that "
    "follow.  [default: 1/60 of the shortest slope length, 0.04 to 0.1]",
)
@click.option(
    "--scheme",
    type=click.Choice(SCHEME.choices or ()),
    help="Numerical scheme. The interval contains its recorded error of the grid.  "
    f"[default: {SCHEME.default}]",
)
@click.option(
    "--accuracy",
    type=parse_fraction,
    metavar="PERCENT",
    help="Choose scheme and cells by the allowed error of the grid, such as 20%, from recorded "
    "runs; in place of --dx and --scheme.",
)
@click.option(
    "--price",
    type=click.FloatRange(0.0),
    help="Price of a metre of height, in any currency. With it, the tables have costs.",
)
@rows_options
@weather_options
@jobs_option("Processes")
@same_version_option
@click.option(
    *("-o", "--output", "folder"),
    type=PATH,
    required=True,
    cls=ResultsFolder,
    help="Results folder.",
)
@resume_option
@dry_run_option()
@quiet_option
def clearance(
    weather: tuple[Path, ...],
    slope_length: str,
    tilt: str,
    heights: str,
    spans: tuple[str, ...],
    draws: Optional[int],
    seed: int,
    ground_tilt: float,
    dx: Optional[float],
    scheme: Optional[str],
    accuracy: Optional[float],
    price: Optional[float],
    rows: int,
    pitch: float,
    coverage: float,
    snow_from: str,
    temperature: Optional[Path],
    jobs: Optional[int],
    same_version: bool,
    folder: Path,
    dry_run: bool,
    quiet: bool,
) -> None:
    """Find how high the lower edge must be to stay clear of shed snow.

    WEATHER holds years of daily data, in any format that ``snowshed season`` reads, or is the word
    example: ten synthetic winters. Several files of one station are joined: its snow and its
    temperature, or its years. The seasons of all winters with observed snow are simulated over
    the ranges of the uncertain snow parameters. After an interruption, the same command resumes.

    \b
    Example:
      snowshed clearance winters.csv --slope-length 4 --tilt 60 --heights 1.5:4:0.5 -o answer
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.clearance.inputs import ClearanceInputs
    from snowshed.analysis.clearance.panel_design import PanelDesign
    from snowshed.analysis.clearance.winters import counted_winters
    from snowshed.season.rows import PanelRows

    if _is_example(weather):
        refuse_without_effect(["snow_from", "temperature"], f"with the word {EXAMPLE}")
    ranges = _ranges(spans, draws, seed)
    designs = [
        PanelDesign(length, angle, PanelRows(rows, pitch))
        for length in _numbers("--slope-length", slope_length)
        for angle in _numbers("--tilt", tilt)
    ]
    candidates = _numbers("--heights", heights)
    record = _record(weather, snow_from, temperature)
    winter_list = record.winters(coverage)
    notes = [*record.notes, *winter_list.notes]
    for note in () if quiet else notes:
        say(f"note: {note}")
    counted_winters(winter_list)  # none is an error before anything is computed
    grid, settings = _grid(designs, dx, scheme, accuracy, quiet=quiet)
    inputs = ClearanceInputs(
        designs, record, coverage, candidates, ranges, settings,
        {"ground.tilt": ground_tilt, **grid}, price, _files(weather, temperature),
    )  # fmt: skip
    if price is not None and not math.isfinite(price):
        raise InputError(f"--price: {price:g} is not allowed; give a cost of 0 or more")
    if dry_run or not quiet:
        print_expected(inputs, jobs)
    if dry_run:
        return
    answer_and_report(inputs, folder, notes, quiet=quiet, jobs=jobs, same_version=same_version)


def print_expected(inputs: ClearanceInputs, jobs: Optional[int]) -> None:
    """Print the number of winters, panels and seasons, and the expected time."""
    seconds, seasons = inputs.expected_duration(jobs=jobs)
    say(
        f"{inputs.winter_list.counted_text}, "
        f"{plural(len(inputs.designs), 'panel')}, about {seasons} seasons: {about(seconds)}"
    )


def answer_and_report(
    inputs: ClearanceInputs, folder: Path, notes: Sequence[str], *, quiet: bool, **options: Any
) -> None:
    """Compute the answer for each panel, write its files, and print it.

    Parameters
    ----------
    inputs, folder
        The inputs, and the results folder.
    notes
        Notes from reading the weather.
    quiet
        Whether to print nothing.
    options
        `jobs` and `same_version`, as for `Study.compute`.
    """
    from snowshed.analysis.clearance.report import write_report
    from snowshed.cli.output.progress import progress_bar
    from snowshed.study.errors import StudyInterrupted

    try:
        with progress_bar(quiet=quiet) as progress:
            answers = inputs.answers(folder, progress=progress, **options)
    except StudyInterrupted:
        raise Stopped("interrupted; resume with the same command") from None
    record = inputs.record_data()
    write_report(answers, inputs.ranges, folder, notes, inputs.price, record)
    if not quiet:
        print_answers(answers, folder)


def _grid(
    designs: Sequence[PanelDesign],
    dx: Optional[float],
    scheme: Optional[str],
    accuracy: Optional[float],
    *,
    quiet: bool,
) -> tuple[dict[str, Any], SeasonSettings]:
    """Return cells and scheme, the same for all panels, and the settings that pool releases."""
    from snowshed.analysis.clearance.grid_error import (
        MIN_CELLS,
        TYPICAL_SLIDE_OFFS,
        choose_grid,
    )
    from snowshed.season.settings import SeasonSettings

    usual = min(design.default_dx for design in designs)
    if accuracy is None:
        return {"numerics.dx": dx or usual, SCHEME.path: scheme or SCHEME.default}, SeasonSettings()
    if dx is not None or scheme is not None:
        raise InputError("--accuracy chooses cells and scheme; give it, or --dx and --scheme")
    choice = choose_grid(accuracy)
    size = MIN_CELLS * usual / choice.cells  # the same slabs, in more cells
    if not quiet:
        best = "" if choice.error <= accuracy else "no recorded run was that accurate; the best is "
        say(
            f"--accuracy {percent(accuracy)}: {best}scheme {choice.scheme} with {choice.cells:g} "
            f"cells in the thinnest slab, dx {size:.3g} m. Its heights were off by "
            f"{percent(choice.error, 2)} after {TYPICAL_SLIDE_OFFS} slide-offs"
        )
    grid = {"numerics.dx": size, SCHEME.path: choice.scheme}
    return grid, SeasonSettings(pool_below=MIN_CELLS * usual)


def _files(weather: tuple[Path, ...], temperature: Optional[Path]) -> list[str]:
    """Return the weather files; none for the example."""
    from snowshed.season.weather.reading import input_files

    return [] if _is_example(weather) else input_files(weather, temperature)


def _is_example(weather: tuple[Path, ...]) -> bool:
    """Return whether the weather is the word for synthetic winters."""
    return [str(file) for file in weather] == [EXAMPLE]


def _record(weather: tuple[Path, ...], snow_from: str, temperature: Optional[Path]) -> SeasonRecord:
    from snowshed.season.weather.generator import EXAMPLE_CLIMATE
    from snowshed.season.weather.reading import read_record
    from snowshed.season.weather.season_record import SeasonRecord

    if not _is_example(weather):
        return read_record(weather, snow_from, temperature)
    rows = EXAMPLE_CLIMATE.winters(10, seed=7)
    return SeasonRecord(
        rows, ["the weather is ten synthetic winters (generator of Richardson 1981)"]
    )


def _ranges(spans: Sequence[str], draws: Optional[int], seed: int) -> SnowRanges:
    """Return the ranges; errors have the names of the options."""
    from snowshed.analysis.clearance.panel_design import SnowRanges, default_ranges

    given = named_once("--range", map(_span, spans))
    try:
        return SnowRanges({**default_ranges(), **given}, draws, seed)
    except InputError as error:
        text = str(error)
        for short, name in SHORT_NAMES.items():
            text = text.replace(name, short)
        raise InputError(text) from None


def _numbers(option: str, text: str) -> list[float]:
    """Return the numbers in the text of an option, each once, with a note on repeated ones."""
    values = numbers(option, text, example="2,3", steps=True)
    distinct = list(dict.fromkeys(values))
    if len(distinct) < len(values):
        issue_note(f"{option} {text}: equal numbers count once", InputNote)
    return distinct


def _span(text: str) -> tuple[str, tuple[float, float]]:
    name, span = named_span("--range", text, example="friction=0.3:0.6", single=True)
    return SHORT_NAMES.get(name, name), span


def print_answers(answers: Sequence[ClearanceResult], folder: Path) -> None:
    """Print the answer in a sentence, and the heights for each panel and probability."""
    from snowshed.analysis.clearance import answer_text

    console = wide_console(120)
    console.print(answer_text.sentence(answers))
    head = ("slope\nlength, m", "tilt\ndegrees", "stays\nclear", "height\nm", "90 % interval\nm")
    table = plain_table("Height of the lower edge", head, padding=0)
    for answer in answers:
        for level in answer.levels:
            table.add_row(
                f"{answer.design.slope_length:g}",
                f"{answer.design.tilt:g}",
                f"{100 * level.probability:g} %",
                f"{level.height:.2f}",
                f"{level.low:.2f} to {level.high:.2f}",
            )
    if table.row_count:
        console.print(table)
    for answer in answers:
        panel = f"{answer_text.panel_name(answer)}: " if len(answers) > 1 else ""
        console.print(f"{panel}{answer_text.interval_reasons(answer)}")
    if answers[0].winter_list is not None:
        print_quality(console, answers[0].winter_list)
    for warning in answer_text.warnings(answers):
        console.print(f"note: {warning}")
    console.print(f"clearance.html, heights.csv and clearance.csv in {folder}")
