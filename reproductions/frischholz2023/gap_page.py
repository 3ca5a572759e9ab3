"""The page ``docs/trust/thesis-gap.md``: how far our stacks are from the thesis's, and why.

Every number on it comes from the files in the folder ``data``, which hold results of longer runs;
``python -m reproductions.frischholz2023.gap_page`` writes it anew.
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
from reproductions.frischholz2023.claims.regression import Regressed
from reproductions.frischholz2023.deviations import DEVIATIONS
from reproductions.frischholz2023.printed import THESIS_QUARTILES
from reproductions.frischholz2023.scatter import read_scatter, scatter
from reproductions.frischholz2023.sections import deviations as deviations_section
from reproductions.frischholz2023.sections.regression import (
    errors_grid,
    quartiles_grid,
    read_regressed,
    rows_grid,
    rows_in_words,
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
from snowshed.analysis.regression.published import published
from snowshed.analysis.regression.rows import StackRows, read_rows
from snowshed.analysis.regression.summary import QUARTILES
from snowshed.base.formatting import percent
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import write_csv
from snowshed.plot.html_page import Grid
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, TRIMMINGS

if TYPE_CHECKING:
    import pandas as pd

DATA = Path(__file__).with_name("data")
PAGE = Path(__file__).parents[2] / "docs" / "trust" / "thesis-gap.md"
DEVIATIONS_FILE, SCATTER_FILE, ERRORS_FILE = "deviations.csv", "scatter.csv", FILE.name
#: What is kept of the folders of regressions, as `snowshed regress` writes them.
KEPT = ("scores.csv", "ratio/errors.csv", "ratio/quartiles.csv")


def page(data: Path = DATA) -> str:
    """Return the page, from the results in a folder."""
    stacks = read_variants_file(data / DEVIATIONS_FILE)
    parts = [
        "# The gap to the thesis",
        "This page is written by `python -m reproductions.frischholz2023.gap_page` from the "
        "results in `reproductions/frischholz2023/data`; change those, not this. It says how far "
        "our stacks below panels are from those of the thesis's chapter 5, and what makes them so. "
        "[Reproducing the thesis](reproduce.md) has the rest.",
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
            *(f"{one:.3f}" for one in quartiles(stacks, name)),
        ]
        for name in TRIMMINGS
    ]
    grid = Grid(["reading", *names.values(), *QUARTILES], rows, "l" + "r" * 7)
    other = next(name for name in TRIMMINGS if name != DEFAULT_TRIMMING)
    ours, theirs = (scatter(stacks, name, "length") for name in (DEFAULT_TRIMMING, other))
    return [
        "## The two readings of A.4.2",
        "[Two readings](../methods/stack.md#two-readings-of-a42) of the same stacks: "
        f"{panels} panels up to "
        f"{stacks['panel.length'].max():g} m long, {seeds} seedings each, cells of {cells}. The "
        "columns are the deviation between seedings as a part of the mean (root mean square over "
        "panels and events), and the quartiles of H/L of the rows.",
        markdown_table(grid),
        f"The length by `{DEFAULT_TRIMMING}` scatters by {percent(ours, 2)}, by `{other}` by "
        f"{percent(theirs, 2)}. The steadier one is the default, whatever it says of the thesis's "
        "numbers.",
    ]


def _causes_part(stacks: pd.DataFrame, errors: pd.DataFrame) -> list[str]:
    order = by_size(stacks)
    return [
        "## Causes, the largest first",
        " ".join(deviations_section.sample_text(stacks)),
        markdown_table(deviations_section.changes_grid(stacks)),
        "\n".join(f"{place}. {_cause(stacks, name)}" for place, name in enumerate(order, 1)),
        *_variations_part(stacks),
        "### Quartiles of H/L with each deviation undone",
        markdown_table(deviations_section.quartiles_grid(stacks)),
        *_left_over(stacks),
        "### Regressions with each deviation undone",
        f"ε-SVR of H/L of the same rows ({errors['rows'].max():.0f} for each), by "
        f"{SCHEME.rounds} round{'s' if SCHEME.rounds > 1 else ''} of {SCHEME.folds} outer and "
        f"{SCHEME.inner_folds} inner folds. The "
        "quartiles are those of the predictions. A sample has a tenth of the rows of the data set, "
        "so that its errors can only be compared with each other.",
        markdown_table(deviations_section.errors_grid(errors, stacks)),
    ]


def _variations_part(stacks: pd.DataFrame) -> list[str]:
    return [
        "### Settings of our own, varied on the same sample",
        "Damping is a rate in our settings, so that it does not depend on the length of the "
        "steps. A share in each step does.",
        markdown_table(deviations_section.variations_grid(stacks)),
    ]


def _cause(stacks: pd.DataFrame, name: str) -> str:
    """Return what a deviation does to H/L, in words."""
    one, found = DEVIATIONS[name], change(stacks, name, "ratio")
    if is_unswitched(stacks, name):
        size = "not switched in these runs, whose scenes are our own; what it changes is not known"
    elif found.value == 0:
        size = "it changes no stack of the sample"
    else:
        size = f"H/L changes by {deviations_section.change_in_words(found)}"
        if not abs(found.value) > SIGMAS * found.noise:
            size += ", which may be chance"
    return f"**`{name}`**: {size}. The thesis: {one.thesis} Here: {one.here} {one.reason}"


def _left_over(stacks: pd.DataFrame) -> list[str]:
    """Return in words what is left between Table 5.3.1 and the preset ``thesis``."""
    of_all = stacks[stacks["variant"] == THESIS]
    if of_all.empty:
        return []
    words = [f"by `{name}` {_gaps(quartiles(of_all, name))}" for name in TRIMMINGS]
    return [
        "With all undone the quartiles Q1 to Q4 of this sample's rows differ from the thesis's "
        f"predictions for all panels {'; '.join(words)}. The panel's friction, which the thesis "
        "does not print, is the same in all of them."
    ]


def _gaps(ours: list[float]) -> str:
    parts = (one / printed - 1 for one, printed in zip(ours, THESIS_QUARTILES["rbf"]))
    return "by " + ", ".join(f"{100 * part:+.0f}" for part in parts) + " %"


def regressed_rows() -> dict[str, StackRows]:
    """Return the rows that the regressions in ``data`` are of, by the name of their folder.

    For each reading of A.4.2 that the data set has: the rows of one seed, and the means if a row
    has several.
    """
    found = {}
    for name in TRIMMINGS:
        try:
            rows = read_rows(geometry_table(), name)
        except InputError:  # not measured by this reading
            continue
        found[f"regression-{name}"] = rows.of_one_seed()
        if rows.most_seeds > 1:
            found[f"regression-{name}-means"] = rows
    return found


def _regression_part(data: Path) -> list[str]:
    parts = regressed_rows()
    found: Mapping[str, Regressed] = {
        f"{rows.settings['trimming']}, {rows_in_words(rows)}": read_regressed(
            data / folder, len(rows), rows.panel_count
        )
        for folder, rows in parts.items()
    }
    one = next(iter(found.values()))
    rounds, folds = one.scores["round"].nunique(), one.scores["fold"].nunique()
    times = f"{rounds} round{'s' if rounds > 1 else ''} of {folds} outer folds"
    of_one_seed = {
        str(rows.settings["trimming"]): regression
        for rows, regression in zip(parts.values(), found.values())
        if rows.most_seeds == 1
    }
    gaps = [f"by `{name}` {_gaps(_predicted_quartiles(one))}" for name, one in of_one_seed.items()]
    shares = [f"{percent(_share(one), 2)} by `{name}`" for name, one in of_one_seed.items()]
    return [
        "## Tables 5.3.1 and 5.3.2",
        "The rows that come with snowshed "
        "([their settings](prediction-record.md#the-rows-that-come-with-snowshed)), "
        f"by both readings of A.4.2, regressed in {times}. The thesis's table "
        "holds quartiles of predictions, and its rows are single stacks: our predictions from rows "
        "of one seed are their like.",
        markdown_table(quartiles_grid(found)),
        f"The RBF kernel's predictions from rows of one seed differ {'; '.join(gaps)}.",
        markdown_table(rows_grid(geometry_table())),
        markdown_table(errors_grid(found)),
        f"The RBF kernel's error is {' and '.join(shares)} of its median prediction; the thesis's "
        f"is {percent(published().relative_error('rbf'), 2)}. Means of several seeds have "
        "smaller errors because they scatter less, which says nothing of the model.",
    ]


def _predicted_quartiles(found: Regressed) -> list[float]:
    return [float(value) for value in found.quartiles.loc["rbf", list(QUARTILES)].to_numpy()]


def _share(found: Regressed) -> float:
    """Return the RBF kernel's error over its median prediction."""
    return float(found.errors["mean_absolute_error"]["rbf"]) / _predicted_quartiles(found)[1]


def keep(
    data: Path,
    deviations: Optional[Path],
    seeds: Optional[Path],
    regressions: Optional[Path],
) -> None:
    """Take new results into the folder that the page is written from; None: the old ones stay.

    Raises
    ------
    InputError
        If a file is not what it should be.
    """
    data.mkdir(exist_ok=True)
    if deviations is not None:
        read_variants_file(deviations)
        shutil.copyfile(deviations, data / DEVIATIONS_FILE)
    if seeds is not None:
        write_csv(read_scatter(seeds), data / SCATTER_FILE, float_format="%.5g")
    if regressions is not None:
        for name in regressed_rows():
            for file in KEPT:
                (data / name / file).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(regressions / name / file, data / name / file)


@click.command()
@click.option("--deviations", type=click.Path(path_type=Path), help="New deviations/stacks.csv.")
@click.option("--scatter", "seeds", type=click.Path(path_type=Path), help="New table of seedings.")
@click.option(
    "--regressions",
    type=click.Path(path_type=Path),
    help="New regressions: a folder of those that `regressed_rows` names.",
)
def main(deviations: Optional[Path], seeds: Optional[Path], regressions: Optional[Path]) -> None:
    """Write docs/trust/thesis-gap.md from the folder data, after taking new results into it."""
    keep(DATA, deviations, seeds, regressions)
    write_text(PAGE, page())


if __name__ == "__main__":
    sys.exit(main())
