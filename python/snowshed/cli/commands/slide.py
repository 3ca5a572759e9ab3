"""The command ``snowshed slide``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Optional, get_args

import click

from snowshed._core import InputError
from snowshed.base.extras import require
from snowshed.base.notes import held_notes, issue_notes_on_failure, record_notes
from snowshed.cli.commands.slide_ranges import (
    OF_RANGES,
    RangeOptions,
    range_options,
    run_project_ranges,
    run_ranges,
)
from snowshed.cli.options.common import PATH, given_values, run_options
from snowshed.cli.options.no_effect import refuse_without_effect
from snowshed.cli.options.number_texts import numbers
from snowshed.cli.options.settings import settings_options
from snowshed.cli.options.slide_files import (
    INPUTS,
    SlideFiles,
    file_options,
    notes_for_summary,
    refuse_changed_areas,
)
from snowshed.cli.run_scene import run_or_cost
from snowshed.cli.slide_project import print_project_cost, run_project, write_particles
from snowshed.io.raster.output import MapFormat
from snowshed.scene.builders.terrain_copy import copies_removed_on_failure
from snowshed.scene.scene import ResolvedScene


@dataclass(frozen=True)
class SlideOptions:
    """The options of a slide that are not files."""

    example: bool
    settings: Mapping[str, Any]
    max_time: Optional[float]
    ranges: RangeOptions
    steps: Sequence[int]
    map_format: MapFormat
    resume: bool
    dry_run: bool
    quiet: bool


@click.command()
@run_options
@file_options
@click.option("--avaframe", type=PATH, help="AvaFrame project to run as AvaFrame 2.1 does.")
@click.option("--example", is_flag=True, help="Run the example: a slide on a synthetic slope.")
@click.option("--compatible", is_flag=True, help="Reproduce the steps of AvaFrame 2.1.")
@click.option("--max-time", type=float, help="Longest duration of the slide [s].")
@click.option(
    "--map-format",
    type=click.Choice(get_args(MapFormat)),
    default="ascii",
    show_default=True,
    help="Format of the maps; geotiff is compressed.",
)
@click.option("--particles-at", metavar="STEPS", help="Write the particles after these steps.")
@range_options
@settings_options("slide", without=["mode"])
def slide(
    folder: Path,
    resume: bool,
    dry_run: bool,
    quiet: bool,
    avaframe: Optional[Path],
    example: bool,
    compatible: bool,
    max_time: Optional[float],
    particles_at: Optional[str],
    map_format: MapFormat,
    **others: Any,
) -> None:
    """Run a small snow slide on terrain, and write the maps of its peak speed and thickness.

    \b
    Examples:
      snowshed slide --example -o slide
      snowshed slide --terrain dem.tif --release release.shp --thickness 0.5 -o slide
      snowshed slide --avaframe project -o slide
      snowshed slide --example --range mu=0.3:0.5 --range max_strain=0.1:0.4 --runs 50 -o maps
    """  # noqa: D301 - click wants the control character
    files, ranges = SlideFiles.pop_from(others), RangeOptions.pop_from(others)
    settings = given_values(others) | ({"mode": "compatible"} if compatible else {})
    options = SlideOptions(
        example,
        settings,
        max_time,
        ranges,
        _steps(particles_at),
        map_format,
        resume,
        dry_run,
        quiet,
    )
    if map_format == "geotiff":
        require("rasterio", "terrain", "the format geotiff of maps")
    if example or avaframe is not None:
        files.refuse_terrain_options()
    _refuse_ignored(files, options)
    with _results_folder(folder, dry_run) as results:
        if avaframe is not None:
            _check_project_files(files, example=example)
            _run_or_cost_project(avaframe, results, files.thickness, options)
            return
        with copies_removed_on_failure(results):
            resolved = _run_or_cost_files(files, results, options)
        if options.steps and resolved is not None:
            write_particles(resolved, results, options.steps)


def _run_or_cost_project(
    project: Path, results: Path, thickness: Optional[float], options: SlideOptions
) -> None:
    """Run an AvaFrame project, with or without ranges, or print its cost."""
    common: dict[str, Any] = {
        "quiet": options.quiet,
        "settings": options.settings,
        "thickness": thickness,
        "max_time": options.max_time,
    }
    if options.ranges.sample is not None:
        run_project_ranges(
            project,
            results,
            options.ranges,
            dry_run=options.dry_run,
            map_format=options.map_format,
            **common,
        )
    elif options.dry_run:
        print_project_cost(project, results, **common)
    else:
        run_project(
            project,
            results,
            resume=options.resume,
            steps=options.steps,
            map_format=options.map_format,
            **common,
        )


def _run_or_cost_files(
    files: SlideFiles, results: Path, options: SlideOptions
) -> Optional[ResolvedScene]:
    """Run the slide of files or the example, or print its cost.

    Returns
    -------
    ResolvedScene
        The scene that ran; None after a dry run, and after many slides.
    """
    dry_run, quiet, sampled = options.dry_run, options.quiet, options.ranges.sample is not None
    in_summary: list[str] = []
    if options.resume and not (files.has_files() or sampled or dry_run):
        resolved = ResolvedScene.load(results / "scene.json")
    else:
        with record_notes() if dry_run or sampled else held_notes() as notes:
            scene = files.scene(results, example=options.example, settings=options.settings)
        if options.max_time is not None:
            scene.set("events.max_time", options.max_time)
        if sampled:
            run_ranges(
                scene,
                results,
                options.ranges,
                dry_run=dry_run,
                quiet=quiet,
                map_format=options.map_format,
            )
            return None
        resolved = scene.resolve()
        if options.resume and not dry_run:
            refuse_changed_areas(resolved, results, files.area_files())
        in_summary = [] if dry_run else notes_for_summary(notes, scene)
    with issue_notes_on_failure(in_summary):
        run_or_cost(
            resolved,
            results,
            resume=options.resume,
            dry_run=dry_run,
            quiet=quiet,
            map_format=options.map_format,
        )
    return None if dry_run else resolved


def _refuse_ignored(files: SlideFiles, options: SlideOptions) -> None:
    """Refuse options that the files and the other options leave without effect."""
    from snowshed.scene.builders.slides import LAYER_OPTIONS

    if options.example:
        refuse_without_effect(["thickness"], "with --example")
    if options.ranges.sample is None:
        refuse_without_effect(OF_RANGES, "without --range")
    else:
        refuse_without_effect(["particles_at"], "with --range")
    if files.terrain is not None:
        for part, file in files.layered_files().items():
            if file is None:
                layer = LAYER_OPTIONS[part]
                refuse_without_effect([layer.replace("-", "_")], "without a file of these areas")
        if files.thickness_raster is None:
            refuse_without_effect(["thickness_band"], "without --thickness-raster")


@contextmanager
def _results_folder(folder: Path, dry_run: bool) -> Iterator[Path]:
    """Yield the results folder; a dry run gets a temporary one, for its copies of files."""
    if not dry_run:
        yield folder
        return
    with TemporaryDirectory() as temporary:
        yield Path(temporary) / "slide"


def _check_project_files(files: SlideFiles, *, example: bool) -> None:
    """Refuse files besides those of an AvaFrame project."""
    if files.layers:
        raise InputError("--avaframe: keep one layer in each file of areas")
    if files.terrain or files.release or files.thickness_raster or example:
        raise InputError(INPUTS)
    if any((*files.area_files().values(), files.hydrograph)):
        raise InputError(
            "--avaframe: the project's folders ENT, RES, SECREL, DAM and REL hold the areas, dams "
            "and hydrographs"
        )


def _steps(text: Optional[str]) -> list[int]:
    """Return the numbers of steps of ``--particles-at``."""
    if text is None:
        return []
    steps = numbers("--particles-at", text, example="1,100")
    for step in steps:
        if step < 0 or step % 1:
            raise InputError(f"--particles-at: {step:g} is not a whole number, at least 0")
    return [int(step) for step in steps]
