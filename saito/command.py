"""The command ``snowshed reproduce saito``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click
from reproduction.computing import compute_and_report

PATH = click.Path(path_type=Path)


@click.command()
@click.option(
    "-o", "--output", "folder", type=PATH, required=True, help="Results folder, old or new."
)
@click.option(
    "--quick", "size", flag_value="quick", default=True,
    help="0.02 m between particles of the wooden slope, other slopes in 2D: minutes (default).",
)  # fmt: skip
@click.option(
    "--full", "size", flag_value="full", help="The paper's 0.01 m, and slopes 1 and 2 in space."
)
@click.option(
    "--stage", "names", multiple=True, metavar="NAME",
    help="Compute only this case, such as wooden-slope-no-obstacle; may be repeated.",
)  # fmt: skip
@click.option("--report-only", is_flag=True, help="Compute nothing, write the report.")
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
def saito(folder: Path, size: str, names: Sequence[str], report_only: bool, quiet: bool) -> None:
    """Judge what Saito and others (2012) say of avalanches as a fluid of particles.

    Writes saito.html. After an interruption the same command goes on.

    \b
    Example:
      snowshed reproduce saito --quick -o avalanches
    """  # noqa: D301 - click wants the control character
    from reproduction.folder import claim_folder
    from reproduction.stage import choose

    from saito.report import report_file, write_report
    from saito.reproduction import Reproduction
    from saito.size import SIZES
    from snowshed.cli.exit_codes import Failed

    claim_folder(folder, {"publication": "saito", "size": size})
    found = Reproduction(folder, SIZES[size])
    stages = choose(list(found.stages.values()), names)
    compute_and_report(
        [] if report_only else stages, folder, lambda: write_report(found),
        publication="the paper", file=report_file(folder), jobs=None, quiet=quiet,
    )  # fmt: skip
    failures = found.failures()
    if failures:
        raise Failed("; ".join(failures))
