"""The command ``snowshed loads``: slow modules are imported when it runs."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed._core import InputError
from snowshed.cli.options.common import PATH, quiet_option, resume_flag
from snowshed.cli.output.terminal import plain_table, say, wide_console


@click.command()
@click.argument("sources", metavar="SOURCE...", type=PATH, nargs=-1, required=True)
@click.option(
    *("-o", "--output", "folder"),
    type=PATH,
    help="Folder of the page, and of the runs of scene files.  [default: the results folder]",
)
@click.option(
    "--snow-load", type=float, help="Snow load on the roof or panel, for the rules [kN/m2]."
)
@click.option(
    "--snow-depth", type=float, help="Depth of the snow cover, for overhangs and creep [m]."
)
@click.option("--snow-density", type=float, help="Density of the snow cover, for creep [kg/m3].")
@click.option("--creep-factor", type=float, help="Creep factor K of the Swiss guideline.")
@click.option("--glide-factor", type=float, help="Glide factor N of the Swiss guideline.")
@click.option("--efficiency", type=float, help="Efficiency factor of a narrow post.")
@resume_flag("Resume interrupted runs of scene files.")
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
    resume: bool,
    quiet: bool,
) -> None:
    """Find the loads of the snow on structures: a page with tables, pictures and rules.

    A SOURCE is a scene file, which is run with its forces recorded, or the results folder of a run
    or a season with forces. Several sources are compared.

    \b
    Examples:
      snowshed loads results --snow-load 3.5
      snowshed loads low-roof.json fence.json -o loads
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.loads.report import write_loads
    from snowshed.analysis.loads.rules import RuleInputs
    from snowshed.results.view import shown_results

    inputs = RuleInputs(snow_load, snow_depth, snow_density, creep_factor, glide_factor, efficiency)
    folders = [
        source if source.is_dir() else _run(source, folder, resume=resume, quiet=quiet)
        for source in sources
    ]
    if folder is None and len(folders) > 1:
        raise InputError("-o: several sources need a folder for their page")
    results = [shown_results(each) for each in folders]
    page = write_loads(results, folder or folders[0], inputs)
    if not quiet:
        print_loads(page)


def _run(scene: Path, folder: Optional[Path], *, resume: bool, quiet: bool) -> Path:
    """Run a scene file with its forces, and return its results folder."""
    from snowshed.cli.run_scene import run_scene
    from snowshed.scene.scene import Scene

    if folder is None:
        raise InputError(f"-o: the scene {scene} needs a folder for its run")
    resolved = Scene.load(scene).set("output.forces", True).resolve()
    run_folder = folder / scene.stem
    run_scene(resolved, run_folder, resume=resume and run_folder.is_dir(), quiet=quiet)
    return run_folder


def print_loads(page: Path) -> None:
    """Print the largest loads, from the table beside the page."""
    from snowshed.analysis.loads.report import TABLE
    from snowshed.io.csv_table import read_csv

    table = read_csv(page.parent / TABLE)
    head = ("on", "at rest\nkN", "1 ms\nkN", "10 ms\nkN", "100 ms\nkN", "pressure\nkPa")
    has_designs = "design" in table
    shown = plain_table(
        "Largest loads, in 2D per metre of width", (*(("design",) if has_designs else ()), *head)
    )
    names = ("rest_n", "peak_1ms_n", "peak_10ms_n", "peak_100ms_n", "peak_pressure_pa")
    for row in table.to_dict("records"):
        cells = [f"{row[name] / 1000:.3g}" for name in names]
        design = (str(row["design"]),) if has_designs else ()
        shown.add_row(*design, str(row["obstacle"]), *cells)
    wide_console(120).print(shown)
    say(f"{page.name} and {TABLE} in {page.parent}")
