"""Regressions for each variant of the sample, as in Tables 5.3.1 and 5.3.2.

``python -m reproductions.frischholz2023.variant_errors STACKS.csv`` writes the file
``deviation-errors.csv`` in the folder ``data``.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import click

from reproductions.frischholz2023.regression_stage import KINDS, TARGET
from reproductions.frischholz2023.sections.regression import ERRORS, read_results
from reproductions.frischholz2023.studies import PANEL
from reproductions.frischholz2023.variants import (
    distinct_variants,
    measured_as,
    read_variants_file,
)
from snowshed._core import InputError
from snowshed.analysis.regression.folds import CrossValidation
from snowshed.analysis.regression.pipeline import regress
from snowshed.analysis.regression.rows import stack_rows
from snowshed.analysis.regression.summary import QUARTILES
from snowshed.io.csv_table import read_csv, write_csv
from snowshed.snow.stack.trimming import TRIMMINGS

if TYPE_CHECKING:
    import pandas as pd

FILE = Path(__file__).with_name("data") / "deviation-errors.csv"
#: Columns of the inputs, in the order of the regression.
INPUTS = ("event", "panel.height", "panel.length", "panel.tilt")
COLUMNS = ("variant", "trimming", "model", "rows", *QUARTILES, *ERRORS)
#: A sample has a tenth of the rows of the data set, so its folds are fewer.
SCHEME = CrossValidation(rounds=1, folds=7, inner_folds=4)


def variant_errors(
    stacks: pd.DataFrame, scheme: CrossValidation = SCHEME, *, jobs: Optional[int] = None
) -> pd.DataFrame:
    """Return the regressions of H/L of each variant, by each trimming rule of A.4.2.

    Parameters
    ----------
    stacks
        From `reproductions.frischholz2023.variants.read_variants`.
    scheme
        The folds; the same for all.
    jobs
        Processes at once; None: as many as there are cores.

    Returns
    -------
    pandas.DataFrame
        ``variant``, ``trimming``, ``model``; number of ``rows``; the quartiles of the predictions
        (``Q1`` to ``Q4``), ``mean_absolute_error`` and ``standard_deviation`` as in Tables 5.3.1
        and 5.3.2, and ``held_out_error``, on rows that were not trained on.
    """
    import pandas as pd

    tables = [
        _stack_errors(of_variant, trimming, scheme, jobs).assign(variant=name, trimming=trimming)
        for name, of_variant in distinct_variants(stacks)
        for trimming in TRIMMINGS
    ]
    return pd.concat(tables, ignore_index=True)[list(COLUMNS)]


def _stack_errors(
    stacks: pd.DataFrame, trimming: str, scheme: CrossValidation, jobs: Optional[int]
) -> pd.DataFrame:
    height, length = (
        measured_as(stacks, trimming, quantity).to_numpy(float) for quantity in ("height", "length")
    )
    rows = stack_rows(stacks[list(INPUTS)].to_numpy(float), height, length).of_one_seed()
    with tempfile.TemporaryDirectory() as folder:
        regress(
            rows, folder, targets=[TARGET], models=KINDS, scheme=scheme, jobs=jobs, figures=False
        )
        regressed = read_results(
            Path(folder), len(rows), len(stacks[list(PANEL)].drop_duplicates())
        )
    table = regressed.quartiles.loc[list(KINDS), list(QUARTILES)]
    return table.join(regressed.errors[list(ERRORS)]).assign(rows=len(rows)).reset_index()


def read_variant_errors(file: Path = FILE) -> pd.DataFrame:
    """Return the table from a file; raises InputError if columns are missing."""
    table = read_csv(file)
    missing = set(COLUMNS) - set(table)
    if missing:
        raise InputError(f"{file}: no column {', '.join(sorted(missing))}")
    return table


@click.command()
@click.argument("stacks", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), default=FILE)
def main(stacks: Path, output: Path) -> None:
    """Regress the rows of a deviations/stacks.csv, and write the table of all regressions."""
    table = variant_errors(read_variants_file(stacks))
    write_csv(table, output, float_format="%.6g")


if __name__ == "__main__":
    sys.exit(main())
