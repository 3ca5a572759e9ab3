"""The table and the figure of the parameters that matter, from computed loading tests."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from snowshed.analysis.grains.ratios import compare_variants
from snowshed.analysis.grains.variants import Comparison
from snowshed.base.arguments import checked
from snowshed.io.csv_table import write_csv

if TYPE_CHECKING:
    import pandas as pd

TESTS, TABLE, FIGURE = "tests.csv", "sensitivity.csv", "sensitivity.png"


@checked
def evaluate_variants(comparison: Comparison, runs: Path, folder: Path) -> pd.DataFrame:
    """Evaluate the computed variants; write the table and the figure.

    Parameters
    ----------
    comparison
        The variants.
    runs
        Folder of the store.
    folder
        Folder for ``tests.csv`` (every test), ``sensitivity.csv`` and ``sensitivity.png``.

    Returns
    -------
    pandas.DataFrame
        As from `compare_variants`.

    Raises
    ------
    InputError
        If the base is not computed.
    """
    from snowshed.analysis.grains.figures import sensitivity_figure
    from snowshed.plot.figure_style import save_figure

    tests = comparison.table(runs)
    table = compare_variants(tests)
    folder.mkdir(parents=True, exist_ok=True)
    write_csv(tests, folder / TESTS)
    write_csv(table, folder / TABLE)
    save_figure(sensitivity_figure(table, comparison.scene.title or ""), folder / FIGURE)
    return table
