"""The command ``snowshed calibrate``; slow imports are made when it runs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, Optional

import click

from snowshed.cli.commands.designed_study import (
    PATH,
    check_options,
    chosen_study,
    computed,
    design_options,
)
from snowshed.cli.terminal import say


@click.command()
@click.argument("measurements", type=PATH, required=False)
@click.option("--template", type=PATH, help="Write an empty measurements file to fill in.")
@click.option(
    "--quantity",
    "quantities",
    multiple=True,
    metavar="NAME",
    help="What the ranges rest on: height, length, head or tail; may be repeated.  "
    "[default: height, length]",
)
@design_options
@click.pass_context
def calibrate(
    context: click.Context,
    /,
    measurements: Optional[Path],
    template: Optional[Path],
    quantities: Sequence[str],
    folder: Optional[Path],
    quick: bool,
    seeds: Optional[int],
    stored: Optional[Path],
    name: Optional[str],
    measure: str,
    quiet: bool,
    **options: Any,
) -> None:
    """Find the snow whose simulated stacks agree with measured ones.

    Computes the missing runs into DIR/runs, ranks the parameter sets, and gives the ranges that the
    measurements allow. After an interruption the same command goes on. With --stored it evaluates
    the store of another study.

    \b
    Example:
      snowshed calibrate --template stacks.csv
      snowshed calibrate stacks.csv --quick -o calibration
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.calibration import measurements as reading
    from snowshed.analysis.calibration.design import calibration_study
    from snowshed.analysis.calibration.misfit import RANKED
    from snowshed.analysis.calibration.report import check_libraries, evaluate
    from snowshed.io.atomic import write_text

    if template is not None:
        write_text(template, reading.template())
        return
    if measurements is None:
        raise click.UsageError("give a MEASUREMENTS file, or --template FILE to write an empty one")
    folder = check_options(context)
    measured = reading.read_measurements(measurements)
    if not context.params["plan_only"]:
        check_libraries()
    if stored is None:
        design = partial(calibration_study, measured, quick=quick, seeds=seeds)
        runs = computed(context, chosen_study(context, folder, design), folder)
        if runs is None:
            return
        stored, name = runs
    found = evaluate(
        measured,
        stored,
        folder,
        study=name,
        measure=measure,
        quantities=quantities or RANKED,
    )
    if not quiet:
        from snowshed.cli.display.calibration import print_calibration

        print_calibration(found)
        say(f"tables and figures in {folder}")
