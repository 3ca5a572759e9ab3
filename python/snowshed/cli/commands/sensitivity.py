"""The command ``snowshed sensitivity``; slow imports are made when it runs."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any, Optional

import click

from snowshed.cli.commands.designed_study import (
    check_options,
    chosen_study,
    computed,
    design_options,
)
from snowshed.cli.terminal import say


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
    /,
    method: str,
    samples: Optional[int],
    folder: Optional[Path],
    quick: bool,
    seeds: Optional[int],
    stored: Optional[Path],
    name: Optional[str],
    measure: str,
    quiet: bool,
    **options: Any,
) -> None:
    """Find the snow parameters that matter for the stack, compared with its noise.

    Computes the missing runs into DIR/runs, and evaluates them. After an interruption the same
    command goes on. With --stored it evaluates the store of another study.

    \b
    Example:
      snowshed sensitivity --method morris --quick -o morris
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.sensitivity.designs import sensitivity_study
    from snowshed.analysis.sensitivity.report import evaluate
    from snowshed.cli.display.sensitivity import print_table

    folder = check_options(context)
    if stored is None:
        design = partial(sensitivity_study, method, quick=quick, seeds=seeds, samples=samples)
        found = computed(context, chosen_study(context, folder, design), folder)
        if found is None:
            return
        stored, name = found
    note = None if quiet else lambda text: say(f"note: {text}", err=True)
    table = evaluate(stored, folder, method, study=name, measure=measure, note=note)
    if not quiet:
        print_table(method, table)
        say(f"tables and figures in {folder}")
