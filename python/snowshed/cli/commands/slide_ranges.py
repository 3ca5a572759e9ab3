"""Snow slides with uncertain parameters: many runs, and maps of probability."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import click

from snowshed._core import InputError
from snowshed.base.messages import shortened, suggestion
from snowshed.base.notes import InputNote, issue_note
from snowshed.cli.compute_study import compute_study, print_study_cost
from snowshed.cli.exit_codes import Failed, Stopped
from snowshed.cli.options.common import jobs_option, same_version_option
from snowshed.cli.options.number_texts import named_once, named_span, numbers
from snowshed.cli.output.terminal import PlainConsole
from snowshed.io.raster.output import MapFormat
from snowshed.methods.slide.settings import SlideSettings
from snowshed.scene.builders.terrain_copy import copies_removed_on_failure, terrain_copy
from snowshed.scene.scene import Scene
from snowshed.scene.schema import scene_parameters
from snowshed.study.definition import Study
from snowshed.study.factors import Factor, Span, latin_hypercube, sobol

if TYPE_CHECKING:
    from snowshed.analysis.hazard.maps import HazardMaps
    from snowshed.scene.builders.avaframe.project import AvaFrameSimulation

RUNS = "runs"
STUDY = "slides"
SAMPLINGS = {"latin-hypercube": latin_hypercube, "sobol": sobol}
#: Settings by their symbols in the literature.
SYMBOLS = {"mu": "friction", "xi": "turbulence", "E": "bond_modulus"}
#: Options that concern the runs of ranges only.
OF_RANGES = (
    "runs", "sampling", "sample_seed", "reached_above", "pressures", "jobs", "same_version",
)  # fmt: skip
#: The thickness of all release areas.
THICKNESS = "thickness"


@dataclass(frozen=True)
class RangeOptions:
    """The values of the options of many slides; see `range_options`."""

    sample: Optional[Factor]
    pressures: Sequence[float]
    reached_above: float
    jobs: Optional[int]
    same_version: bool

    @classmethod
    def pop_from(cls, options: dict[str, Any]) -> RangeOptions:
        """Return the options of many slides, and remove them from `options`.

        Raises
        ------
        InputError
            If a range, the number of runs or a list of pressures is wrong.
        """
        spans = named_once("--range", map(_span, options.pop("ranges")))
        draw = SAMPLINGS[options.pop("sampling")]
        runs, seed = options.pop("runs"), options.pop("sample_seed")
        return cls(
            draw(spans, runs, seed=seed) if spans else None,
            numbers("--pressures", options.pop("pressures"), example="1,3,10"),
            **{name: options.pop(name) for name in ("reached_above", "jobs", "same_version")},
        )


def range_options(command: Any) -> Any:
    """Add the options of many slides."""
    for option in (
        same_version_option,
        jobs_option("With --range: runs"),
        click.option(
            "--pressures", default="1,3,10", show_default=True, metavar="KPA,...",
            help="With --range: pressures whose exceedance is mapped.",
        ),
        click.option(
            "--reached-above", type=float, default=0.1, show_default=True,
            help="With --range: thickness above which a cell is reached [m].",
        ),
        click.option("--sample-seed", type=int, default=1, help="With --range: random seed."),
        click.option(
            "--sampling", type=click.Choice(list(SAMPLINGS)), default="latin-hypercube",
            show_default=True, help="With --range: sampling of the ranges.",
        ),
        click.option(
            "--runs", type=int, default=50, show_default=True, help="With --range: number of runs."
        ),
        click.option(
            "--range", "ranges", multiple=True, metavar="NAME=LOW:HIGH",
            help="Vary a setting, mu, xi, E or thickness, and map probabilities. Repeatable.",
        ),
    ):  # fmt: skip
        command = option(command)
    return command


def run_ranges(
    scene: Scene,
    folder: Path,
    options: RangeOptions,
    *,
    dry_run: bool,
    quiet: bool,
    map_format: MapFormat = "ascii",
) -> None:
    """Compute the slides of a sample of the ranges, and write their maps of probability.

    After an interruption, the same command resumes.
    """
    from snowshed.analysis.hazard.folder import write_hazard

    study = _study(scene, options)
    if dry_run:
        print_study_cost(study, options.jobs)
        return
    folder.mkdir(parents=True, exist_ok=True)
    study.save(folder / "study.toml")
    failure: Optional[Failed] = None
    try:
        compute_study(
            study, folder / RUNS, quiet=quiet, jobs=options.jobs, keep_particles=True,
            same_version=options.same_version,
        )  # fmt: skip
    except Failed as failed:  # maps of the other runs are written, with a note
        failure = failed
    except Stopped:
        raise Stopped("interrupted; resume with the same command") from None
    maps = write_hazard(
        folder,
        folder / RUNS,
        STUDY,
        reached=options.reached_above,
        pressures=options.pressures,
        map_format=map_format,
    )
    if not quiet:
        print_hazard(maps, folder)
    if failure is not None:
        raise failure


def run_project_ranges(
    project: Path,
    folder: Path,
    options: RangeOptions,
    *,
    dry_run: bool,
    quiet: bool,
    settings: Mapping[str, object],
    thickness: Optional[float],
    max_time: Optional[float],
    map_format: MapFormat = "ascii",
) -> None:
    """Run many slides of the first simulation of an AvaFrame project, and map probabilities."""
    from snowshed.scene.builders.avaframe.project import avaframe_simulations

    with copies_removed_on_failure(folder):
        first, *others = avaframe_simulations(
            project, settings=settings, thickness=thickness, ascii_copy=terrain_copy(folder)
        )
        if max_time is not None:
            first.scene.set("events.max_time", max_time)
        if others:
            _note_left_out(first, others)
        run_ranges(
            first.scene, folder, options, dry_run=dry_run, quiet=quiet, map_format=map_format
        )


def _note_left_out(first: AvaFrameSimulation, others: Sequence[AvaFrameSimulation]) -> None:
    """Issue a note on the simulations of a project that are left out, and record it."""
    names = shortened(", ".join(f"{other.release} ({other.sim_type})" for other in others), 200)
    note = (
        f"of the project's {len(others) + 1} simulations, these slides are {first.release} "
        f"({first.sim_type}); left out: {names}"
    )
    terrain = first.scene.terrain
    assert terrain is not None
    terrain.notes = "\n".join(filter(None, (terrain.notes, note)))
    issue_note(note, InputNote)


def _study(scene: Scene, options: RangeOptions) -> Study:
    terrain = scene.resolve().data["terrain"]
    columns: dict[str, Sequence[object]] = {}
    sample = {} if options.sample is None else options.sample.columns
    if THICKNESS in sample and terrain.get("thickness_file"):
        raise InputError("--range thickness: a raster gives the thickness of each cell")
    for name, values in sample.items():
        for path in _paths(name, len(terrain["release"])):
            columns[path] = values
    return Study(scene, [[Factor(columns)]], STUDY)


def _span(text: str) -> tuple[str, Span]:
    """Return the name and the interval of a text such as "mu=0.3:0.5"."""
    given, ends = named_span("--range", text, example="mu=0.3:0.5")
    name = SYMBOLS.get(given, given)
    names = [THICKNESS, *_numerical_settings()]
    if name not in names:
        allowed = ", ".join([*SYMBOLS, *names])
        raise InputError(f"--range: {name!r} is none of {allowed}{suggestion(name, names)}")
    try:
        return name, Span(*ends)
    except InputError as error:
        raise InputError(f"--range {name}: {error}") from None


def _numerical_settings() -> list[str]:
    """Return the names of the numerical settings that do not change the grid."""
    names = [
        parameter.path.partition(".")[2]
        for parameter in scene_parameters("slide")
        if parameter.path.startswith("numerics.") and parameter.kind == "number"
    ]
    return [name for name in names if name != SlideSettings.RESOLUTION]


def _paths(name: str, areas: int) -> list[str]:
    """Return the paths of a parameter in a scene; the thickness has one per release area."""
    if name == THICKNESS:
        return [f"terrain.release.{area}.thickness" for area in range(areas)]
    return [f"numerics.{name}"]


def print_hazard(maps: HazardMaps, folder: Path) -> None:
    """Print the areas above each probability, and the folder of the maps."""
    from rich.table import Table

    from snowshed.analysis.hazard.maps import LEVELS, uncertainty

    table = Table(title=f"{maps.runs} slides", box=None, title_justify="left")
    table.add_column("area, m2, with a probability of", style="bold")
    for level in LEVELS:
        table.add_column(f"at least {100 * level:.0f} %", justify="right")
    for exceedance in maps.exceedances:
        areas = (f"{maps.area(exceedance, level):,.0f}" for level in LEVELS)
        table.add_row(exceedance.label, *areas)
    console = PlainConsole(soft_wrap=True)
    console.print(table)
    console.print(uncertainty(maps.runs))
    if maps.failed:
        console.print(f"note: {maps.failed} further runs failed and are left out")
    console.print(f"maps, hazard.html and hazard.png in {folder}")
