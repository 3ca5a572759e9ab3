"""The command ``snowshed compare``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from snowshed.cli.options.common import PATH
from snowshed.cli.output.terminal import plain_table, wide_console

if TYPE_CHECKING:
    import pandas as pd


@click.command()
@click.argument("first", type=PATH)
@click.argument("second", type=PATH)
def compare(first: Path, second: Path) -> None:
    """Compare the stack heights of two results folders.

    For a 3D and a 2D run, the thesis's rule of thumb is printed beside the ratio.
    """
    from snowshed.analysis.stack_ratios import compare_folders, height_ratio, same_dimension

    if same_dimension(first, second):
        print_heights(height_ratio(first, second), first.name, second.name)
    else:
        print_ratios(compare_folders(first, second))


def print_ratios(ratios: pd.DataFrame) -> None:
    """Print the ratio of 3D to 2D heights beside the thesis's rule of thumb."""
    from snowshed.analysis.stack_ratios import RULE_OF_THUMB

    headings = ("event", "3D, m", "2D, m", "3D/2D", "rule of thumb")
    table = plain_table("Stack height in 3D and in 2D", headings, padding=0)
    for event, three, two, ratio in ratios.itertuples(index=False):
        cells = (f"{three:.3f}", f"{two:.3f}", f"{ratio:.2f}", f"{RULE_OF_THUMB:.2f}")
        table.add_row(str(event), *cells)
    wide_console(120).print(table)


def print_heights(ratios: pd.DataFrame, first: str, second: str) -> None:
    """Print the heights of two runs, event by event, and their ratio."""
    headings = ("event", f"{first}, m", f"{second}, m", "ratio")
    table = plain_table("Stack heights", headings, padding=0)
    for event, height, other_height, ratio in ratios.itertuples(index=False):
        table.add_row(str(event), f"{height:.3f}", f"{other_height:.3f}", f"{ratio:.2f}")
    wide_console(120).print(table)
