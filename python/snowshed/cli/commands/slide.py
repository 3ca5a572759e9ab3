"""The command of snow slides: ``snowshed slide``."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Optional

import click

from snowshed._core import InputError
from snowshed.cli.commands.run import run_options
from snowshed.cli.commands.slide_ranges import (
    RangeOptions,
    range_options,
    run_project_ranges,
    run_ranges,
)
from snowshed.cli.run_scene import run_scene
from snowshed.cli.settings_options import settings_options
from snowshed.cli.slide_files import WAYS, SlideFiles, refuse_changed_areas, removing_copies
from snowshed.cli.slide_project import run_project, write_particles
from snowshed.scene.scene import ResolvedScene

PATH = click.Path(path_type=Path)


@click.command()
@run_options
@click.option("--terrain", type=PATH, help="Elevations: an ESRI ASCII grid or a GeoTIFF.")
@click.option("--release", type=PATH, help="Polygons of the areas that break loose.")
@click.option("--thickness", type=float, help="Thickness of the released snow [m].")
@click.option("--thickness-raster", type=PATH, help="The same in the cells of a raster.")
@click.option("--entrainment-areas", type=PATH, help="Polygons where snow is taken up.")
@click.option("--resistance-areas", type=PATH, help="Polygons of forest.")
@click.option("--layer", metavar="NAME", help="Layer of the release's GeoPackage.")
@click.option("--entrainment-layer", metavar="NAME", help="The same of the areas of entrainment.")
@click.option("--resistance-layer", metavar="NAME", help="The same of the areas of forest.")
@click.option("--avaframe", type=PATH, help="An AvaFrame project, run as AvaFrame 2.1 does.")
@click.option("--example", is_flag=True, help="A slide on a slope that is made for it.")
@click.option("--compatible", is_flag=True, help="Do step by step what AvaFrame 2.1 does.")
@click.option("--band", type=int, help="Band of the terrain, where a GeoTIFF has several.")
@click.option("--thickness-band", type=int, help="Band of the raster of thickness.")
@click.option("--max-slope", type=float, help="Steepest cliff under the release that is believed.")
@click.option("--max-thickness", type=float, help="Largest thickness of snow that is believed [m].")
@click.option("--max-cells", type=int, help="How many cells the terrain may have.")
@click.option("--max-time", type=float, help="Longest duration of the slide [s].")
@click.option("--particles-at", metavar="STEPS", help="Write the particles after these steps.")
@range_options
@settings_options("slide", without=["mode"])
def slide(
    folder: Path,
    resume: bool,
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
    given = {name: value for name, value in settings.items() if value is not None}
    limits = {"max_slope": max_slope, "max_thickness": max_thickness, "max_cells": max_cells}
    if compatible:
        given["mode"] = "compatible"
    beliefs = {"--band": band, "--thickness-band": thickness_band, **{
        f"--{name.replace('_', '-')}": value for name, value in limits.items()
    }}  # fmt: skip
    for option, value in beliefs.items():
        if value is not None and (example or avaframe is not None):
            raise InputError(f"{option}: only with --terrain")
    named = {"release": layer, "entrainment": entrainment_layer, "resistance": resistance_layer}
    layers = {part: name for part, name in named.items() if name is not None}
    if avaframe is not None:
        if layers:
            raise InputError("--avaframe: keep one layer in each file of areas")
        if terrain is not None or release is not None or thickness_raster is not None or example:
            raise InputError(WAYS)
        if entrainment_areas is not None or resistance_areas is not None:
            raise InputError("--avaframe: areas are those of the project, in ENT and RES")
        if ranges.sample is not None:
            run_project_ranges(
                avaframe, folder, ranges, quiet=quiet, settings=given, thickness=thickness,
                max_time=max_time,
            )  # fmt: skip
            return
        run_project(
            avaframe, folder, resume=resume, quiet=quiet, settings=given, thickness=thickness,
            max_time=max_time, steps=steps,
        )  # fmt: skip
        return
    files = SlideFiles(
        terrain, release, thickness_raster, entrainment_areas, resistance_areas, thickness,
        band, thickness_band, layers,
    )  # fmt: skip
    with removing_copies(folder):
        if resume and not files.any() and ranges.sample is None:
            ready = ResolvedScene.load(folder / "scene.json")
        else:
            scene = files.scene(folder, example=example, settings=given, limits=limits)
            if max_time is not None:
                scene.set("events.max_time", max_time)
            if ranges.sample is not None:
                run_ranges(scene, folder, ranges, quiet=quiet)
                return
            ready = scene.resolve()
            if resume:
                refuse_changed_areas(ready, folder, files.of_areas())
        run_scene(ready, folder, resume, quiet)
    if steps:
        write_particles(ready, folder, steps)


def _steps(text: Optional[str]) -> list[int]:
    if text is None:
        return []
    try:
        steps = [int(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"--particles-at: {text!r} is no list of steps such as 1,100") from None
    if min(steps) < 0:
        raise InputError(f"--particles-at: {min(steps)}; a number of steps is not negative")
    return steps
