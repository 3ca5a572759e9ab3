"""The command ``snowshed slide``."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Optional

import click

from snowshed._core import InputError
from snowshed.base.notes import held, recorded, told_on_failure
from snowshed.cli.commands.slide_ranges import (
    RangeOptions,
    range_options,
    run_project_ranges,
    run_ranges,
)
from snowshed.cli.common_options import PATH, given_values, run_options
from snowshed.cli.dry_run import print_cost
from snowshed.cli.run_scene import run_scene
from snowshed.cli.settings_options import settings_options
from snowshed.cli.slide_files import (
    INPUTS,
    SlideFiles,
    notes_for_summary,
    refuse_changed_areas,
)
from snowshed.cli.slide_project import print_project_cost, run_project, write_particles
from snowshed.scene.builders.terrain_copy import removing_copies
from snowshed.scene.scene import ResolvedScene


@click.command()
@run_options
@click.option("--terrain", type=PATH, help="Elevations: an ESRI ASCII grid or a GeoTIFF.")
@click.option("--release", type=PATH, help="Polygons of the release areas.")
@click.option("--thickness", type=float, help="Thickness of the released snow [m].")
@click.option(
    "--thickness-raster", type=PATH, help="Raster of the thickness of the released snow [m]."
)
@click.option("--entrainment-areas", type=PATH, help="Polygons of the entrainment areas.")
@click.option("--resistance-areas", type=PATH, help="Polygons of forest.")
@click.option("--layer", metavar="NAME", help="Layer of the GeoPackage of release areas.")
@click.option(
    "--entrainment-layer", metavar="NAME", help="Layer of the GeoPackage of entrainment areas."
)
@click.option("--resistance-layer", metavar="NAME", help="Layer of the GeoPackage of forest.")
@click.option("--avaframe", type=PATH, help="AvaFrame project to run as AvaFrame 2.1 does.")
@click.option("--example", is_flag=True, help="Run the example: a slide on a synthetic slope.")
@click.option("--compatible", is_flag=True, help="Reproduce the steps of AvaFrame 2.1.")
@click.option("--band", type=int, help="Band of the terrain, if the GeoTIFF has several.")
@click.option("--thickness-band", type=int, help="Band of the thickness raster.")
@click.option(
    "--max-slope", type=float, help="Steepest plausible cliff under the release [degrees]."
)
@click.option("--max-thickness", type=float, help="Largest plausible thickness of snow [m].")
@click.option("--max-cells", type=int, help="Largest number of cells of the terrain.")
@click.option("--max-time", type=float, help="Longest duration of the slide [s].")
@click.option("--particles-at", metavar="STEPS", help="Write the particles after these steps.")
@range_options
@settings_options("slide", without=["mode"])
def slide(
    folder: Path,
    resume: bool,
    dry_run: bool,
    quiet: bool,
    terrain: Optional[Path],
    release: Optional[Path],
    thickness: Optional[float],
    thickness_raster: Optional[Path],
    entrainment_areas: Optional[Path],
    resistance_areas: Optional[Path],
    layer: Optional[str],
    entrainment_layer: Optional[str],
    resistance_layer: Optional[str],
    avaframe: Optional[Path],
    example: bool,
    compatible: bool,
    band: Optional[int],
    thickness_band: Optional[int],
    max_slope: Optional[float],
    max_thickness: Optional[float],
    max_cells: Optional[int],
    max_time: Optional[float],
    particles_at: Optional[str],
    **settings: Any,
) -> None:
    """Run a small snow slide on terrain, and write the maps of its peak speed and thickness.

    \b
    Examples:
      snowshed slide --example -o slide
      snowshed slide --terrain dem.tif --release release.shp --thickness 0.5 -o slide
      snowshed slide --avaframe project -o slide
      snowshed slide --example --range mu=0.3:0.5 --range max_strain=0.1:0.4 --runs 50 -o maps
    """  # noqa: D301 - click wants the control character
    ranges = RangeOptions.taken_from(settings)
    steps = _steps(particles_at)
    given = given_values(settings)
    if compatible:
        given["mode"] = "compatible"
    limits = {"max_slope": max_slope, "max_thickness": max_thickness, "max_cells": max_cells}
    terrain_options = {"band": band, "thickness_band": thickness_band, **limits}
    for name in given_values(terrain_options):
        if example or avaframe is not None:
            raise InputError(f"--{name.replace('_', '-')}: only with --terrain")
    layers = given_values(
        {"release": layer, "entrainment": entrainment_layer, "resistance": resistance_layer}
    )
    files = SlideFiles(
        terrain, release, thickness_raster, entrainment_areas, resistance_areas, thickness,
        band, thickness_band, layers,
    )  # fmt: skip
    with _results_folder(folder, dry_run) as results:
        if avaframe is not None:
            _check_project_files(files, example=example)
            project: dict[str, Any] = {
                "quiet": quiet, "settings": given, "thickness": thickness, "max_time": max_time
            }  # fmt: skip
            if ranges.sample is not None:
                run_project_ranges(avaframe, results, ranges, dry_run=dry_run, **project)
            elif dry_run:
                print_project_cost(avaframe, results, **project)
            else:
                run_project(avaframe, results, resume=resume, steps=steps, **project)
            return
        with removing_copies(results):
            in_summary: list[str] = []
            if resume and not files.any() and ranges.sample is None and not dry_run:
                resolved = ResolvedScene.load(results / "scene.json")
            else:
                with recorded() if dry_run or ranges.sample else held() as notes:
                    scene = files.scene(results, example=example, settings=given, limits=limits)
                if max_time is not None:
                    scene.set("events.max_time", max_time)
                if ranges.sample is not None:
                    run_ranges(scene, results, ranges, dry_run=dry_run, quiet=quiet)
                    return
                resolved = scene.resolve()
                if dry_run:
                    print_cost(resolved)
                    return
                if resume:
                    refuse_changed_areas(resolved, results, files.of_areas())
                in_summary = notes_for_summary(notes, scene)
            with told_on_failure(in_summary):
                run_scene(resolved, results, resume, quiet)
        if steps:
            write_particles(resolved, results, steps)


@contextmanager
def _results_folder(folder: Path, dry_run: bool) -> Iterator[Path]:
    """Yield the results folder; a dry run gets a temporary one, for its copies of files."""
    if not dry_run:
        yield folder
        return
    with TemporaryDirectory() as temporary:
        yield Path(temporary) / "slide"


def _check_project_files(files: SlideFiles, *, example: bool) -> None:
    """Refuse files beside those of an AvaFrame project."""
    if files.layers:
        raise InputError("--avaframe: keep one layer in each file of areas")
    if files.terrain or files.release or files.thickness_raster or example:
        raise InputError(INPUTS)
    if files.entrainment or files.resistance:
        raise InputError("--avaframe: the project's folders ENT and RES hold the areas")


def _steps(text: Optional[str]) -> list[int]:
    if text is None:
        return []
    try:
        steps = [int(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"--particles-at: {text!r} is not a list of steps such as 1,100") from None
    if min(steps) < 0:
        raise InputError(f"--particles-at: {min(steps)}; a number of steps must not be negative")
    return steps
