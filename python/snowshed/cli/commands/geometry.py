"""The command ``snowshed geometry``."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed.analysis.regression.geometry import FRICTION
from snowshed.cli.options.common import PATH, quiet_notes_option
from snowshed.cli.options.no_effect import refuse_without_effect
from snowshed.cli.output.terminal import write_out


@click.command()
@click.option(
    "--between",
    default="carry",
    help="Treatment of the stack between events: carry or reseed.  [default: carry]",
)
@click.option(
    "--friction",
    type=click.FloatRange(0.0, 10.0),
    default=FRICTION,
    show_default=True,
    help="Coulomb coefficient of the panel.",
)
@click.option(
    "--dx",
    type=click.FloatRange(1e-4, 1.0),
    default=0.01,
    show_default=True,
    help="Size of the grid cells [m].",
)
@click.option(
    "--seeds",
    type=click.IntRange(1, 1000),
    default=1,
    show_default=True,
    help="Seeds of each panel up to 1 m long; the regression uses the mean of their stacks. Longer "
    "panels get fewer: a third up to 2 m, a sixth up to 4 m, a sixteenth beyond (rounded up).",
)
@click.option(
    "--scheme",
    default="thesis",
    help="Scheme of the MPM: thesis or objective.  [default: thesis]",
)
@click.option("--trial", is_flag=True, help="A few panels on a coarse grid: seconds.")
@click.option("-o", "--output", "file", type=PATH, help="File to write.  [default: stdout]")
@quiet_notes_option
@click.pass_context
def geometry(
    context: click.Context,
    between: str,
    friction: float,
    dx: float,
    seeds: int,
    scheme: str,
    trial: bool,
    file: Optional[Path],
) -> None:
    """Write the study of panel geometries whose table ``regress`` takes.

    \b
    Example:
      snowshed geometry -o geometry.toml
      snowshed study run geometry.toml -o runs
      snowshed study export runs -o rows.csv
      snowshed regress rows.csv -o regression
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.regression.geometry import geometry_study

    if trial:
        refuse_without_effect(["dx"], "with --trial, which has its own cell size")
    study = geometry_study(
        between, friction=friction, dx=dx, seeds=seeds, scheme=scheme, trial=trial
    )
    if file is None:
        write_out(study.to_toml())
    else:
        study.save(file)
