"""The command ``snowshed sensitivity``: slow modules are imported when it runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import click

from snowshed.cli.commands.designed_study import (
    check_options,
    chosen_study,
    compute_missing_runs,
    design_options,
)
from snowshed.cli.output.terminal import plain_table, say, wide_console

if TYPE_CHECKING:
    import pandas as pd

#: Half width beyond which the interval of an index between 0 and 1 is too wide.
MAX_INTERVAL_HALF_WIDTH = 0.25


@click.command()
@click.option(
    "--method",
    default="s",
    help="s (single-parameter index), fixation, sobol or morris.  [default: s]",
)
@click.option(
    "--samples", type=int, help="Base points of sobol (a power of two), trajectories of morris."
)
@design_options("s: 4, with --quick 3; fixation: 2; sobol and morris vary the seed")
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

    Computes the missing runs into DIR/runs, and evaluates them. After an interruption, the same
    command resumes. With --stored it evaluates the store of another study.

    \b
    Example:
      snowshed sensitivity --method morris --quick -o morris
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.sensitivity.designs import sensitivity_study
    from snowshed.analysis.sensitivity.report import evaluate_sensitivity

    folder = check_options(context)
    if stored is None:
        design = partial(sensitivity_study, method, quick=quick, seeds=seeds, samples=samples)
        runs = compute_missing_runs(context, chosen_study(context, folder, design), folder)
        if runs is None:
            return
        stored, name = runs
    note = None if quiet else lambda text: say(f"note: {text}", err=True)
    table = evaluate_sensitivity(stored, folder, method, study=name, measure=measure, note=note)
    if not quiet:
        print_indices(method, table)
        say(f"tables and figures in {folder}")


def _local(row: Any) -> str:
    doubtful = row["distinct"] is not None and not row["distinct"]
    return f"{row['s']:+.3f} ± {row['standard_error']:.3f}{' ?' if doubtful else '  '}"


def _fixation_text(row: Any) -> str:
    return f"{row['mean_m']:.3f} ± {row['deviation_m']:.3f}"


def _shares(row: Any) -> str:
    return f"{row['first']:+.2f} / {row['total']:.2f}"


def _effects(row: Any) -> str:
    return f"{row['strength']:.3f} ± {row['strength_interval']:.3f}"


CELLS: Mapping[str, tuple[str, Callable[[Any], str]]] = {
    "s": ("Index S ± standard error from seeding noise", _local),
    "fixation": ("Mean ± standard deviation over the others, m", _fixation_text),
    "sobol": ("First order / total Sobol index", _shares),
    "morris": ("Strength μ* of effects ± 95 %, relative to the mean", _effects),
}
NOTES = {
    "s": "? may be noise: zero lies within 1.96 standard errors",
    "fixation": "the seeding alone: see noise.csv",
    "sobol": "the total index of the seeding is noise: smaller indices show no effect",
    "morris": "the strength of the seeding is noise: smaller strengths show no effect",
}


def print_indices(method: str, table: pd.DataFrame) -> None:
    """Print the indices of a method: a line per parameter, a column per event."""
    from snowshed.analysis.sensitivity.stored import TARGETS

    title, cell = CELLS[method]
    events = list(dict.fromkeys(table["event"]))
    console = wide_console()
    for target in TARGETS:
        indices = plain_table(f"{title}: {target}")
        indices.add_column("parameter", no_wrap=True)
        for event in events:
            indices.add_column(f"event {event}", justify="right", no_wrap=True)
        rows = table[table["target"] == target]
        keys = ["parameter", *(["value"] if "value" in table else [])]
        for key, rows_of_key in rows.groupby(keys, sort=False):
            by_event = {row["event"]: cell(row) for _, row in rows_of_key.iterrows()}
            indices.add_row(_name(key), *(by_event.get(event, "") for event in events))
        console.print(indices)
    console.print(f" {NOTES[method]}")
    if method == "sobol" and table["total_interval"].median() > MAX_INTERVAL_HALF_WIDTH:
        blocks = int(table["blocks"].min())
        console.print(
            f" {blocks} blocks are too few: the 95 % intervals are wider than the indices"
        )


def _name(key: Any) -> str:
    from snowshed.scene.labels import label

    path, *values = key
    parameter = label(path)
    return " ".join([parameter.symbol, *(parameter.quantity(value) for value in values)])
