"""The command ``snowshed clearance``; slow imports are made when it runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import click

from snowshed._core import InputError
from snowshed.base.formatting import about
from snowshed.cli.exit_codes import Stopped
from snowshed.cli.quiet import quiet_option
from snowshed.cli.terminal import say
from snowshed.cli.weather_options import weather_options

if TYPE_CHECKING:
    from snowshed.analysis.clearance import Answer, Design, Ranges, Winter
    from snowshed.season.record import Record, WinterList

EXAMPLE = "example"  # in place of a file: made winters
PATH = click.Path(path_type=Path)


@click.command()
@click.argument("weather", metavar="WEATHER...", type=PATH, nargs=-1, required=True)
@click.option("--slope-length", required=True, help="Along the slope, m; several: 3,4,5.")
@click.option("--tilt", required=True, help="Degrees from the horizontal; several: 40,60.")
@click.option(
    "--heights",
    default="1:4:0.5",
    show_default=True,
    help="Candidate heights of the lower edge, m: one, a list, or FROM:TO:STEP.",
)
@click.option(
    "--range",
    "spans",
    multiple=True,
    metavar="NAME=LOW:HIGH",
    help="What is not known: friction, adhesion, sliding, strength, catch. May be repeated; "
    "NAME=VALUE sets a known value.",
)
@click.option("--draws", type=int, default=3, show_default=True, help="Seasons for each winter.")
@click.option("--seed", type=int, default=1, show_default=True, help="Of the drawing.")
@weather_options
@click.option("--jobs", type=int, help="Processes at once.  [default: cores]")
@click.option("-o", "--output", "folder", type=PATH, required=True, help="Results folder.")
@click.option("--dry-run", is_flag=True, help="Say how long it takes, and end.")
@quiet_option
def clearance(
    weather: tuple[Path, ...],
    slope_length: str,
    tilt: str,
    heights: str,
    spans: tuple[str, ...],
    draws: int,
    seed: int,
    coverage: float,
    snow_from: str,
    temperature: Optional[Path],
    jobs: Optional[int],
    folder: Path,
    dry_run: bool,
    quiet: bool,
) -> None:
    """Find how high the lower edge must be, so that shed snow does not reach it.

    WEATHER holds years of daily data, in any format that ``snowshed season`` reads, or is the word
    example: ten made winters. Several files of one station are read as one: those of its snow and
    its temperature, or of its years. The seasons of all winters whose snow was observed are
    simulated over the ranges of what nobody knows of the snow. The same command goes on with an
    interrupted answer.

    \b
    Example:
      snowshed clearance winters.csv --slope-length 4 --tilt 60 --heights 1.5:4:0.5 -o answer
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.clearance import Design, Ranges
    from snowshed.analysis.clearance.answer import forecast
    from snowshed.analysis.clearance.design import DEFAULT_RANGES
    from snowshed.analysis.clearance.winters import counted

    ranges = Ranges({**DEFAULT_RANGES, **dict(map(_span, spans))}, draws, seed)
    designs = [
        Design(length, angle)
        for length in numbers("--slope-length", slope_length)
        for angle in numbers("--tilt", tilt)
    ]
    candidates = numbers("--heights", heights)
    record = _record(weather, snow_from, temperature)
    known = record.winters(coverage)
    notes = [*record.notes, *known.notes]
    for note in () if quiet else notes:
        say(f"note: {note}")
    winters = counted(known)
    if dry_run or not quiet:
        plans = [forecast(one, winters, candidates, ranges=ranges, jobs=jobs) for one in designs]
        seconds, seasons = sum(plan[0] for plan in plans), sum(plan[1] for plan in plans)
        say(
            f"{known.words}, {len(designs)} {'panel' if len(designs) == 1 else 'panels'}, about "
            f"{seasons} seasons: {about(seconds)}"
        )
    if dry_run:
        return
    answers = _answers(designs, known, winters, candidates, ranges, folder, jobs, quiet=quiet)
    from snowshed.analysis.clearance.report import write_report

    write_report(answers, ranges, folder, notes)
    if not quiet:
        from snowshed.cli.display.clearance import print_answers

        print_answers(answers, folder)


def _answers(
    designs: list[Design],
    known: WinterList,
    winters: list[Winter],
    heights: list[float],
    ranges: Ranges,
    folder: Path,
    jobs: Optional[int],
    *,
    quiet: bool,
) -> list[Answer]:
    from snowshed.analysis.clearance import clearance_of
    from snowshed.cli.progress import progress_bar
    from snowshed.study.errors import StudyInterrupted

    folder.mkdir(parents=True, exist_ok=True)
    options: dict[str, Any] = {"ranges": ranges, "jobs": jobs, "known": known}
    found = []
    try:
        for one in designs:
            store = folder / f"runs-{one.slope_length:g}-{one.tilt:g}"
            with progress_bar(quiet=quiet) as progress:
                found.append(
                    clearance_of(one, winters, heights, store, progress=progress, **options)
                )
    except StudyInterrupted:
        raise Stopped("interrupted; go on with the same command") from None
    return found


def _record(weather: tuple[Path, ...], snow_from: str, temperature: Optional[Path]) -> Record:
    from snowshed.season.generator import EXAMPLE_CLIMATE
    from snowshed.season.record import Record
    from snowshed.season.weather import read_record

    if [str(one) for one in weather] != [EXAMPLE]:
        return read_record(weather, snow_from, temperature)
    rows = EXAMPLE_CLIMATE.winters(10, seed=7)
    return Record(rows, ["the weather is that of ten made winters (generator of Richardson 1981)"])


def numbers(option: str, text: str) -> list[float]:
    """Return the numbers of an option: one, some with commas, or FROM:TO:STEP.

    Examples
    --------
    >>> numbers("--heights", "1:2:0.5"), numbers("--tilt", "40,60")
    ([1.0, 1.5, 2.0], [40.0, 60.0])
    """
    try:
        if ":" not in text:
            return [float(part) for part in text.split(",")]
        low, high, step = (float(part) for part in text.split(":"))
        count = int((high - low) / step + 1e-9) + 1
        if not (step > 0 and 1 <= count <= 1000):
            raise ValueError
        return [round(low + n * step, 9) for n in range(count)]
    except (ValueError, ZeroDivisionError, OverflowError):
        raise InputError(
            f"{option}: {text!r}; needed: a number, a list such as 2,3, or FROM:TO:STEP"
        ) from None


def _span(text: str) -> tuple[str, tuple[float, float]]:
    name, _, values = text.partition("=")
    try:
        ends = [float(part) for part in values.split(":")]
        return name, (ends[0], ends[-1])
    except ValueError:
        raise InputError(
            f"--range: {text!r}; needed: NAME=LOW:HIGH, such as friction=0.3:0.6"
        ) from None
