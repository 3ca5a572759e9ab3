"""The command ``snowshed loads``: slow modules are imported when it runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import click

from snowshed._core import InputError
from snowshed.cli.options.common import PATH, dry_run_option, quiet_option, resume_flag
from snowshed.cli.output.dry_run import print_cost
from snowshed.cli.output.terminal import plain_table, say, wide_console

if TYPE_CHECKING:
    from snowshed.scene.scene import ResolvedScene

OBJECT_TABLE = "object_loads.csv"


@click.command()
@click.argument("sources", metavar="SOURCE...", type=PATH, nargs=-1, required=True)
@click.option(
    *("-o", "--output", "folder"),
    type=PATH,
    help="Folder of the page, and of the runs of scene files.  [default: the results folder]",
)
@click.option(
    "--snow-load", type=float, help="Snow load on the roof or panel [kN/m2]; the rules use it."
)
@click.option(
    "--snow-depth", type=float, help="Depth of the snow cover, for overhangs and creep [m]."
)
@click.option("--snow-density", type=float, help="Density of the snow cover, for creep [kg/m3].")
@click.option("--creep-factor", type=float, help="Creep factor K of the Swiss guideline.")
@click.option("--glide-factor", type=float, help="Glide factor N of the Swiss guideline.")
@click.option("--efficiency", type=float, help="Efficiency factor of a narrow post.")
@click.option(
    "--objects", type=PATH, help="Slides: lines or polygons of masts, walls and buildings."
)
@click.option("--layer", help="Slides: layer of the GeoPackage of objects.")
@click.option("--drag", type=float, help="Slides: drag coefficient of the objects.")
@resume_flag("Resume interrupted runs of scene files.")
@dry_run_option("Print the cost of the scene files and exit.")
@quiet_option
def loads(
    sources: tuple[Path, ...],
    folder: Optional[Path],
    snow_load: Optional[float],
    snow_depth: Optional[float],
    snow_density: Optional[float],
    creep_factor: Optional[float],
    glide_factor: Optional[float],
    efficiency: Optional[float],
    objects: Optional[Path],
    layer: Optional[str],
    drag: Optional[float],
    resume: bool,
    dry_run: bool,
    quiet: bool,
) -> None:
    """Find the loads of the snow on structures: a page with tables, pictures and rules.

    A SOURCE is a scene file, which is run with its forces recorded, or the results folder of a run
    or a season with forces. Several sources are compared. For a slide, or slides of --range, give
    its folder and --objects: the table object_loads.csv has the load on each of them.

    \b
    Examples:
      snowshed loads results --snow-load 3.5
      snowshed loads low-roof.json fence.json -o loads
      snowshed loads slide --objects masts.gpkg --drag 1.5
    """  # noqa: D301 - click wants the control character
    inputs = (snow_load, snow_depth, snow_density, creep_factor, glide_factor, efficiency)
    for source in sources:
        if not source.exists():
            raise InputError(f"{source}: no such scene file or results folder")
    if objects is not None:
        if resume or dry_run or any(value is not None for value in inputs):
            raise InputError("--objects: only with --layer, --drag and -o")
        _object_loads(sources, objects, layer, drag, folder, quiet=quiet)
        return
    if layer is not None or drag is not None:
        raise InputError("--layer, --drag: only with --objects")
    scenes = {source: _with_forces(source) for source in sources if source.is_file()}
    _check_folders(scenes, folder, several=len(sources) > 1, dry_run=dry_run)
    if dry_run:
        for source, resolved in scenes.items():
            say(f"{source}:")
            print_cost(resolved)
        return
    from snowshed.analysis.loads.report import write_loads
    from snowshed.analysis.loads.standards import RuleInputs
    from snowshed.results.view import shown_results

    rule_inputs = RuleInputs(*inputs)
    done = [shown_results(source) for source in sources if source not in scenes]
    for run in done:
        if run.scene.data.get("terrain"):
            raise InputError(f"{run.folder}: a slide: give its objects (--objects, --drag)")
        _ = run.loads  # before other scenes run
    folders = [
        _run(scenes[source], Path(str(folder)) / source.stem, resume=resume, quiet=quiet)
        if source in scenes
        else source
        for source in sources
    ]
    results = [shown_results(each) for each in folders]
    page = write_loads(results, folder or folders[0], rule_inputs)
    if not quiet:
        print_loads(page)


def _with_forces(scene: Path) -> ResolvedScene:
    from snowshed.scene.scene import Scene

    return Scene.load(scene).set("output.forces", True).resolve()


def _check_folders(
    scenes: Mapping[Path, ResolvedScene], folder: Optional[Path], *, several: bool, dry_run: bool
) -> None:
    """Refuse scenes without folders of their own, before any of them runs."""
    if folder is None and not dry_run:
        if scenes:
            raise InputError(f"-o: the scene {next(iter(scenes))} needs a folder for its run")
        if several:
            raise InputError("-o: several sources need a folder for their page")
    stems = [scene.stem for scene in scenes]
    for stem in stems:
        if stems.count(stem) > 1:
            raise InputError(f"two scenes are called {stem}: their runs need different names")


def _run(scene: ResolvedScene, folder: Path, *, resume: bool, quiet: bool) -> Path:
    """Run a scene with its forces, and return its results folder."""
    from snowshed.cli.run_scene import run_scene

    run_scene(scene, folder, resume=resume and folder.is_dir(), quiet=quiet)
    return folder


def _object_loads(
    sources: Sequence[Path],
    file: Path,
    layer: Optional[str],
    drag: Optional[float],
    folder: Optional[Path],
    *,
    quiet: bool,
) -> None:
    """Write object_loads.csv for a slide or a study of slides, and print it."""
    from snowshed.analysis.loads.slide_objects import object_loads
    from snowshed.io.csv_table import write_csv
    from snowshed.methods.slide.objects import read_objects

    if len(sources) > 1:
        raise InputError("--objects: give the folder of one slide, or of the slides of --range")
    if drag is None:
        raise InputError("--objects: give their drag coefficient, too (--drag)")
    table = object_loads(sources[0], read_objects(file, layer), drag)
    out = folder or sources[0]
    out.mkdir(parents=True, exist_ok=True)
    write_csv(table, out / OBJECT_TABLE, float_format="%.6g")
    if quiet:
        return
    shown = plain_table("Loads on objects", [_heading(str(name)) for name in table])
    for row in table.to_dict("records"):
        shown.add_row(
            *(f"{value:.3g}" if isinstance(value, float) else str(value) for value in row.values())
        )
    wide_console(120).print(shown)
    for note in table.attrs.get("notes", ()):
        say(note)
    say(
        "Pressure is drag times density times the square of the largest speed, the force that over "
        "the width and the largest depth: an upper bound, because both need not come together, and "
        "because the width is the largest one, wherever the flow comes from."
    )
    say(f"{OBJECT_TABLE} in {out}")


def _heading(column: str) -> str:
    r"""Return a column's name and its unit as the head of a table.

    Examples
    --------
    >>> _heading("pressure_kpa_p95").split("\n"), _heading("reached_low").split("\n")
    (['pressure', 'kPa', '95 %'], ['reached', '95 % from'])
    """
    words = {"kpa": "kPa", "kn": "kN", "p50": "50 %", "p95": "95 %", "low": "95 % from",
             "high": "95 % to"}  # fmt: skip
    return "\n".join(words.get(word, word) for word in column.split("_"))


def print_loads(page: Path) -> None:
    """Print the largest loads, from the table beside the page."""
    from snowshed.analysis.loads.report import TABLE
    from snowshed.analysis.loads.structures import kilo
    from snowshed.io.csv_table import read_csv

    table = read_csv(page.parent / TABLE)
    head = ("on", "at rest\nkN", "1 ms\nkN", "10 ms\nkN", "100 ms\nkN", "pressure\nkPa")
    has_designs = "design" in table
    shown = plain_table(
        "Largest loads, in 2D per metre of width", (*(("design",) if has_designs else ()), *head)
    )
    names = ("rest_n", "peak_1ms_n", "peak_10ms_n", "peak_100ms_n", "peak_pressure_pa")
    for row in table.to_dict("records"):
        cells = [kilo(row[name]) for name in names]
        design = (str(row["design"]),) if has_designs else ()
        shown.add_row(*design, str(row["obstacle"]), *cells)
    wide_console(120).print(shown)
    say(f"{page.name} and {TABLE} in {page.parent}")
