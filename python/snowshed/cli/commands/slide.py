"""The command of snow slides: ``snowshed slide``."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Optional

import click

from snowshed._core import InputError
from snowshed.cli.commands.run import run_options
from snowshed.cli.commands.slide_ranges import RangeOptions, range_options, run_ranges
from snowshed.cli.run_scene import run_scene
from snowshed.scene.scene import ResolvedScene, Scene
from snowshed.scene.schema import Parameter, scene_parameters

PATH = click.Path(path_type=Path)
KINDS = {"number": float, "integer": int}


def _slide_options(command: Any) -> Any:
    """Add an option for every setting of the method but its mode."""
    for parameter in reversed(scene_parameters("slide")):
        section, _, name = parameter.path.partition(".")
        if section == "numerics" and name != "mode":
            command = _option(parameter, name)(command)
    return command


def _option(parameter: Parameter, name: str) -> Any:
    unit = f" [{parameter.unit}]" if parameter.unit else ""
    text = f"{parameter.description}{unit}."
    flag = "--" + name.replace("_", "-")
    if parameter.kind == "boolean":
        return click.option(f"{flag}/--no-{flag[2:]}", name, default=None, help=text)
    if parameter.choices:
        return click.option(flag, name, type=click.Choice(parameter.choices), help=text)
    return click.option(flag, name, type=KINDS[parameter.kind], help=text)


@click.command()
@run_options
@click.option("--terrain", type=PATH, help="Elevations: an ESRI ASCII grid or a GeoTIFF.")
@click.option("--release", type=PATH, help="Polygons of the areas that break loose.")
@click.option("--thickness", type=float, help="Thickness of the released snow [m].")
@click.option("--entrainment-areas", type=PATH, help="Polygons where snow is taken up.")
@click.option("--resistance-areas", type=PATH, help="Polygons of forest.")
@click.option("--avaframe", type=PATH, help="An AvaFrame project, run as AvaFrame 2.1 does.")
@click.option("--example", is_flag=True, help="A slide on a slope that is made for it.")
@click.option("--compatible", is_flag=True, help="Do step by step what AvaFrame 2.1 does.")
@click.option("--max-time", type=float, help="Longest duration of the slide [s].")
@click.option("--particles-at", metavar="STEPS", help="Write the particles after these steps.")
@range_options
@_slide_options
def slide(
    folder: Path,
    resume: bool,
    quiet: bool,
    terrain: Optional[Path],
    release: Optional[Path],
    thickness: Optional[float],
    entrainment_areas: Optional[Path],
    resistance_areas: Optional[Path],
    avaframe: Optional[Path],
    example: bool,
    compatible: bool,
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
    if compatible:
        given["mode"] = "compatible"
    if resume and ranges.sample is None:
        ready = ResolvedScene.load(folder / "scene.json")
    else:
        scene = _scene(
            folder, terrain, release, thickness, entrainment_areas, resistance_areas, avaframe,
            example=example, settings=given,
        )  # fmt: skip
        if max_time is not None:
            scene.set("events.max_time", max_time)
        if ranges.sample is not None:
            run_ranges(scene, folder, ranges, quiet=quiet)
            return
        ready = scene.resolve()
    run_scene(ready, folder, resume, quiet)
    if avaframe is not None:
        _write_as_avaframe(folder, avaframe)
    if steps:
        _write_particles(ready, folder, steps)


def _scene(
    folder: Path,
    terrain: Optional[Path],
    release: Optional[Path],
    thickness: Optional[float],
    entrainment: Optional[Path],
    resistance: Optional[Path],
    avaframe: Optional[Path],
    *,
    example: bool,
    settings: dict[str, object],
) -> Scene:
    """Return the scene that the options describe."""
    from snowshed.methods.slide import SlideSettings
    from snowshed.scene.builders.avaframe import avaframe_scene
    from snowshed.scene.builders.slides import example_slide, slide_scene

    ways = [terrain is not None or release is not None, avaframe is not None, example]
    if sum(ways) != 1:
        raise InputError("give --terrain and --release, or --avaframe, or --example")
    beside = folder.with_name(f"{folder.name}-terrain")
    if avaframe is not None:
        copy = beside.with_suffix(".asc")
        return avaframe_scene(avaframe, settings=settings, thickness=thickness, ascii_copy=copy)
    if example:
        beside.mkdir(parents=True, exist_ok=True)
        return example_slide(beside).update({"numerics": settings})
    if terrain is None or release is None:
        raise InputError("give both --terrain and --release")
    return slide_scene(
        terrain,
        release,
        thickness=thickness,
        entrainment=entrainment,
        resistance=resistance,
        settings=SlideSettings.from_data(settings),
        ascii_copy=beside.with_suffix(".asc"),
        title=f"Slide on {terrain.name}",
    )


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


def _write_particles(ready: ResolvedScene, folder: Path, steps: list[int]) -> None:
    from snowshed.io.atomic import replacing
    from snowshed.run.slides import particles_at

    for step, table in particles_at(ready, steps).items():
        name = "particles_initial" if step == 0 else f"particles_step{step:05d}"
        with replacing(folder / f"{name}.csv") as beside:
            table.to_csv(beside, index=False, float_format="%.10g")


def _write_as_avaframe(folder: Path, project: Path) -> None:
    """Write the peak maps under AvaFrame's names, so that its tools find them."""
    import hashlib
    import shutil

    from snowshed.io.atomic import replacing

    scene = (folder / "scene.json").read_bytes()
    (release,) = sorted((project / "Inputs" / "REL").glob("*.shp"))[:1] or [Path("release")]
    name = f"{release.stem}_{hashlib.sha256(scene).hexdigest()[:10]}_com5_C_L_null_ssl"
    peaks = folder / "Outputs" / "com5SnowSlide" / "peakFiles"
    peaks.mkdir(parents=True, exist_ok=True)
    for kind in ("ppr", "pft", "pfv"):
        with replacing(peaks / f"{name}_{kind}.asc") as beside:
            shutil.copyfile(folder / "peaks" / f"{kind}.asc", beside)
