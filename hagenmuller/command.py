"""The command ``snowshed reproduce hagenmuller``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Optional

import click
from reproduction.computing import check_failures, compute_and_report

PATH = click.Path(path_type=Path)


@click.command()
@click.option(
    "-o", "--output", "folder", type=PATH, required=True, help="Results folder, old or new."
)
@click.option(
    "--quick", "size", flag_value="quick", default=True,
    help="Some 90 grains a sample: minutes on two cores (default).",
)  # fmt: skip
@click.option(
    "--full", "size", flag_value="full", help="1000 grains and more: some two hours on two cores."
)
@click.option(
    "--stage", "names", multiple=True, metavar="NAME",
    help="Compute only this: elastic, brittle or dense; may be repeated.",
)  # fmt: skip
@click.option("--report-only", is_flag=True, help="Compute nothing, write the report.")
@click.option("--jobs", type=int, help="Tests at once.  [default: the number of cores]")
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
def hagenmuller(
    folder: Path,
    size: str,
    names: Sequence[str],
    report_only: bool,
    jobs: Optional[int],
    quiet: bool,
) -> None:
    """Judge what Hagenmuller, Chambon and Naaim (2015) say of snow in compression.

    Writes hagenmuller.html. The snow is synthetic. After an interruption the same command goes on.

    \b
    Example:
      snowshed reproduce hagenmuller --quick -o grains
    """  # noqa: D301 - click wants the control character
    from reproduction.folder import claim_folder
    from reproduction.stage import choose

    from hagenmuller.report import report_file, write_report
    from hagenmuller.reproduction import Reproduction
    from hagenmuller.size import SIZES

    claim_folder(folder, {"publication": "hagenmuller", "size": size})
    found = Reproduction(folder, SIZES[size])
    stages = choose(list(found.stages.values()), names)
    compute_and_report(
        [] if report_only else stages, folder, lambda: write_report(found),
        publication="the paper", file=report_file(folder), jobs=jobs, quiet=quiet,
    )  # fmt: skip
    check_failures(found.stages, found.runs)
