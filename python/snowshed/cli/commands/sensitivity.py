"""The command ``snowshed sensitivity``; it imports what takes long when it runs."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed.cli.designed_study import check_options, compute, design_options, plan, write_study


@click.command()
@click.option(
    "--method",
    default="s",
    help="s (single-parameter index), fixation, sobol or morris.  [default: s]",
)
@click.option(
    "--samples", type=int, help="Base points of sobol (a power of two), trajectories of morris."
)
@design_options
@click.pass_context
def sensitivity(
    context: click.Context,
    method: str,
    samples: Optional[int],
    folder: Optional[Path],
    quick: bool,
    seeds: Optional[int],
    plan_only: bool,
    file: Optional[Path],
    stored: Optional[Path],
    name: Optional[str],
    measure: str,
    jobs: Optional[int],
    quiet: bool,
) -> None:
    """Find which snow parameters matter for the stack, beside its noise.

    Computes the runs that are missing, into DIR/runs, and evaluates them. After an interruption
    the same command goes on; with --stored it evaluates what another study has stored.

    \b
    Example:
      snowshed sensitivity --method morris --quick -o morris
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.sensitivity.designs import sensitivity_study
    from snowshed.analysis.sensitivity.report import evaluate
    from snowshed.cli.display.sensitivity import print_table

    folder = check_options(context)
    if stored is None:
        if file is None:
            text = sensitivity_study(method, quick=quick, seeds=seeds, samples=samples)
            file = write_study(text, folder)
        if plan_only:
            plan(context, file, jobs)
            return
        stored, name = compute(context, file, folder, jobs, quiet)
    note = None if quiet else lambda text: click.echo(f"note: {text}", err=True)
    table = evaluate(stored, folder, method, study=name, measure=measure, note=note)
    if not quiet:
        print_table(method, table)
        click.echo(f"tables and figures in {folder}")
