"""The page ``docs/trust/thesis-gap.md``: how our stacks differ from the thesis's, and why.

Every number on it comes from the files in the folder ``data``, which hold results of longer runs;
``python -m reproductions.frischholz2023.gap_page`` writes it again.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import click

from reproductions.common.hypothesis_tests import SIGMAS
from reproductions.common.markdown import markdown_table
from reproductions.frischholz2023.claims.regression import RegressionResults
from reproductions.frischholz2023.deviations import DEVIATIONS
from reproductions.frischholz2023.printed import THESIS_QUARTILES, thesis_relative_error
from reproductions.frischholz2023.scatter import read_scatter, scatter
from reproductions.frischholz2023.sections import deviations as deviations_section
from reproductions.frischholz2023.sections.regression import (
    errors_grid,
    quartiles_grid,
    read_results,
    rows_grid,
    rows_label,
)
from reproductions.frischholz2023.studies import PANEL, THESIS
from reproductions.frischholz2023.variant_errors import FILE, SCHEME, read_variant_errors
from reproductions.frischholz2023.variants import (
    by_size,
    change,
    is_unswitched,
    quartiles,
    read_variants_file,
)
from snowshed._core import InputError
from snowshed.analysis.regression.dataset import geometry_table
from snowshed.analysis.regression.rows import StackRows, read_rows
from snowshed.analysis.regression.summary import QUARTILES
from snowshed.base.formatting import percent
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import write_csv
from snowshed.plot.html_page import HtmlTable
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, TRIMMINGS

if TYPE_CHECKING:
    import pandas as pd

DATA = Path(__file__).with_name("data")
PAGE = Path(__file__).parents[2] / "docs" / "trust" / "thesis-gap.md"
DEVIATIONS_FILE, SCATTER_FILE, ERRORS_FILE = "deviations.csv", "scatter.csv", FILE.name
#: Files that are stored from the folders of regressions, as `snowshed regress` writes them.
COPIED_FILES = ("scores.csv", "ratio/errors.csv", "ratio/quartiles.csv")


def page(data: Path = DATA) -> str:
    """Return the page, from the results in a folder."""
    stacks = read_variants_file(data / DEVIATIONS_FILE)
    parts = [
        "# The gap to the thesis",
        "This page compares our stacks below panels with those of the thesis's chapter 5, and "
        "gives the causes of the differences. [Reproducing the thesis](reproduce.md) describes "
        "the reproduction as a whole.",
        "`python -m reproductions.frischholz2023.gap_page` writes this page from the results in "
        "`reproductions/frischholz2023/data`. Do not edit it by hand.",
        *_scatter_part(read_scatter(data / SCATTER_FILE)),
        *_causes_part(stacks, read_variant_errors(data / ERRORS_FILE)),
        *_regression_part(data),
    ]
    return "\n\n".join(parts) + "\n"


def _scatter_part(stacks: pd.DataFrame) -> list[str]:
    panels, seeds = len(stacks[list(PANEL)].drop_duplicates()), stacks["seed"].nunique()
    cells = ", ".join(f"{100 * dx:.3g} cm" for dx in stacks["dx"].unique())
    names = {"height": "height", "length": "length", "ratio": "H/L"}
    rows = [
        [
            name,
            *(percent(scatter(stacks, name, quantity), 2) for quantity in names),
            *(f"{quartile:.3f}" for quartile in quartiles(stacks, name)),
        ]
        for name in TRIMMINGS
    ]
    grid = HtmlTable(["trimming rule", *names.values(), *QUARTILES], rows, "l" + "r" * 7)
    other = next(name for name in TRIMMINGS if name != DEFAULT_TRIMMING)
    default_scatter, other_scatter = (
        scatter(stacks, name, "length") for name in (DEFAULT_TRIMMING, other)
    )
    return [
        "## The two trimming rules of A.4.2",
        "The table measures the same stacks by [two trimming rules]"
        f"(../methods/stack.md#two-trimming-rules-in-a42): {panels} panels up to "
        f"{stacks['panel.length'].max():g} m long, {seeds} seedings each, cells of {cells}. The "
        "columns are the deviation between seedings relative to the mean (root mean square over "
        "panels and events), and the quartiles of H/L of the rows.",
        markdown_table(grid),
        f"The length by `{DEFAULT_TRIMMING}` scatters by {percent(default_scatter, 2)}, by "
        f"`{other}` by {percent(other_scatter, 2)}. "
        "The steadier rule is the default, whether or not it agrees with "
        "the thesis's numbers.",
    ]


def _causes_part(stacks: pd.DataFrame, errors: pd.DataFrame) -> list[str]:
    order = by_size(stacks)
    return [
        "## Causes, the largest first",
        *deviations_section.sample_text(stacks),
        markdown_table(deviations_section.changes_grid(stacks)),
        "\n".join(f"{place}. {_cause(stacks, name)}" for place, name in enumerate(order, 1)),
        *_variations_part(stacks),
        "### Quartiles of H/L with each deviation undone",
        markdown_table(deviations_section.quartiles_grid(stacks)),
        *_remaining_gaps(stacks),
        "### Regressions with each deviation undone",
        f"The table has regressions of H/L (ε-SVR) for {errors['rows'].max():.0f} rows of each "
        "variant, by "
        f"{SCHEME.rounds} round{'s' if SCHEME.rounds > 1 else ''} of {SCHEME.folds} outer and "
        f"{SCHEME.inner_folds} inner folds. The "
        "quartiles are those of the predictions. The sample has a tenth of the rows of the data "
        "set, so compare its errors only with each other.",
        markdown_table(deviations_section.errors_grid(errors, stacks)),
    ]


def _variations_part(stacks: pd.DataFrame) -> list[str]:
    return [
        "### Settings of our own, varied on the same sample",
        "Our damping is a rate, so it does not depend on the length of the steps. With a share in "
        "each step it does.",
        markdown_table(deviations_section.variations_grid(stacks)),
    ]


def _cause(stacks: pd.DataFrame, name: str) -> str:
    """Return the text on a deviation and its effect on H/L."""
    deviation, ratio_change = DEVIATIONS[name], change(stacks, name, "ratio")
    if is_unswitched(stacks, name):
        size = "the runs of the sample do not switch it, so its effect is unknown"
    elif ratio_change.value == 0:
        size = "it changes no stack of the sample"
    elif 100 * max(abs(ratio_change.value), ratio_change.noise) < 0.5:  # both are printed as 0
        size = "it changes no stack of the sample noticeably"
    else:
        size = f"H/L changes by {deviations_section.change_text(ratio_change)}"
        if not abs(ratio_change.value) > SIGMAS * ratio_change.noise:
            size += ", which may be chance"
    texts = f"The thesis: {deviation.thesis} Here: {deviation.here} {deviation.reason}"
    return f"**`{name}`**: {size}. {texts}"


def _remaining_gaps(stacks: pd.DataFrame) -> list[str]:
    """Return the differences that remain between Table 5.3.1 and the preset ``thesis``."""
    undone = stacks[stacks["variant"] == THESIS]
    if undone.empty:
        return []
    gaps = [f"{_gaps(quartiles(undone, name))} with `{name}`" for name in TRIMMINGS]
    return [
        "With all deviations undone, the quartiles Q1 to Q4 of this sample's rows differ from the "
        f"thesis's predictions for all panels as follows: {'; '.join(gaps)}. The panel's friction, "
        "which the thesis does not print, is the same in all of them."
    ]


def _gaps(ours: list[float]) -> str:
    parts = (quartile / printed - 1 for quartile, printed in zip(ours, THESIS_QUARTILES["rbf"]))
    return ", ".join(map(deviations_section.signed_percentage, parts)) + " %"


def rows_of_regressions() -> dict[str, StackRows]:
    """Return the rows of the regressions in ``data``, by the name of their folder.

    Each trimming rule has the rows of one seed and, if rows have several seeds, their means.
    """
    rows_by_name = {}
    for name in TRIMMINGS:
        try:
            rows = read_rows(geometry_table(), name)
        except InputError:  # not measured by this rule
            continue
        rows_by_name[f"regression-{name}"] = rows.of_one_seed()
        if rows.most_seeds > 1:
            rows_by_name[f"regression-{name}-means"] = rows
    return rows_by_name


def _regression_part(data: Path) -> list[str]:
    parts = rows_of_regressions()
    regressions: Mapping[str, RegressionResults] = {
        f"{rows.settings['trimming']}, {rows_label(rows)}": read_results(
            data / folder, len(rows), rows.panel_count
        )
        for folder, rows in parts.items()
    }
    regressed = next(iter(regressions.values()))
    rounds, folds = regressed.scores["round"].nunique(), regressed.scores["fold"].nunique()
    times = f"{rounds} round{'s' if rounds > 1 else ''} of {folds} outer folds"
    of_one_seed = {
        str(rows.settings["trimming"]): regression
        for rows, regression in zip(parts.values(), regressions.values())
        if rows.most_seeds == 1
    }
    gaps = [
        f"{_gaps(_predicted_quartiles(regressed))} with `{name}`"
        for name, regressed in of_one_seed.items()
    ]
    shares = [
        f"{percent(_share(regressed), 2)} by `{name}`" for name, regressed in of_one_seed.items()
    ]
    return [
        "## Tables 5.3.1 and 5.3.2",
        "The rows that come with snowshed "
        "([their settings](prediction-record.md#the-rows-that-come-with-snowshed)), "
        f"by both trimming rules, were regressed in {times}. The thesis's table has quartiles of "
        "predictions, and its rows are single stacks: compare them with our predictions from rows "
        "of one seed.",
        markdown_table(quartiles_grid(regressions)),
        f"The RBF kernel's predictions from rows of one seed differ as follows: {'; '.join(gaps)}.",
        markdown_table(rows_grid(geometry_table())),
        markdown_table(errors_grid(regressions)),
        f"The RBF kernel's error is {' and '.join(shares)} of its median prediction; the thesis's "
        f"is {percent(thesis_relative_error('rbf'), 2)}. Means of several seeds have "
        "smaller errors because they scatter less, not because the model is better.",
    ]


def _predicted_quartiles(regressed: RegressionResults) -> list[float]:
    return [float(value) for value in regressed.quartiles.loc["rbf", list(QUARTILES)].to_numpy()]


def _share(regressed: RegressionResults) -> float:
    """Return the RBF kernel's error relative to its median prediction."""
    return (
        float(regressed.errors["mean_absolute_error"]["rbf"]) / _predicted_quartiles(regressed)[1]
    )


def keep(
    data: Path,
    deviations: Optional[Path],
    seeds: Optional[Path],
    regressions: Optional[Path],
) -> None:
    """Copy new results into the folder of the page's data; None keeps the old ones.

    Raises
    ------
    InputError
        If a file is invalid.
    """
    data.mkdir(exist_ok=True)
    if deviations is not None:
        read_variants_file(deviations)
        shutil.copyfile(deviations, data / DEVIATIONS_FILE)
    if seeds is not None:
        write_csv(read_scatter(seeds), data / SCATTER_FILE, float_format="%.5g")
    if regressions is not None:
        for name in rows_of_regressions():
            for file in COPIED_FILES:
                (data / name / file).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(regressions / name / file, data / name / file)


@click.command()
@click.option("--deviations", type=click.Path(path_type=Path), help="New deviations/stacks.csv.")
@click.option("--scatter", "seeds", type=click.Path(path_type=Path), help="New table of seedings.")
@click.option(
    "--regressions",
    type=click.Path(path_type=Path),
    help="Folder of new regressions, as `rows_of_regressions` names them.",
)
def main(deviations: Optional[Path], seeds: Optional[Path], regressions: Optional[Path]) -> None:
    """Write docs/trust/thesis-gap.md from the folder data, after taking new results into it."""
    keep(DATA, deviations, seeds, regressions)
    write_text(PAGE, page())


if __name__ == "__main__":
    sys.exit(main())
