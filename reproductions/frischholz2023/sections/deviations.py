"""The deviations from the thesis: each one undone, all undone, and our settings varied."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Optional

import numpy as np

from reproductions.common.hypothesis_tests import SIGMAS, Estimate
from reproductions.common.section import Content
from reproductions.frischholz2023.deviations import DEVIATIONS, FRAME_RATE
from reproductions.frischholz2023.printed import THESIS_QUARTILES, THESIS_ROWS
from reproductions.frischholz2023.stages import ThesisComputation
from reproductions.frischholz2023.studies import DEFAULTS, PANEL, THESIS, VARIANTS, VARIATIONS
from reproductions.frischholz2023.variants import (
    by_size,
    change,
    distinct_variants,
    is_unswitched,
    quartiles,
    read_variants,
)
from snowshed.analysis.regression.geometry import DAMPING_RATE
from snowshed.analysis.regression.summary import QUARTILES
from snowshed.base.formatting import MISSING, percent
from snowshed.io.csv_table import write_csv
from snowshed.plot.html_page import HtmlTable
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, TRIMMINGS

if TYPE_CHECKING:
    import pandas as pd

STACKS = "stacks.csv"
#: Descriptions of the variations of our settings.
VARIATION_LABELS: Mapping[str, str] = {
    "coarse-cells": "cells a third larger",
    "half-damping": f"damping {DAMPING_RATE / 2:g} 1/s instead of {DAMPING_RATE:g}",
    "double-damping": f"damping {DAMPING_RATE * 2:g} 1/s",
    "short-steps": "steps two thirds as long",
    "short-steps-damped-each": "the same, with a share of 0.99 in each step",
}
QUANTITIES = {"height": "height", "length": "length", "ratio": "H/L"}


def build(work: ThesisComputation) -> Content:
    """Return the content; raises InputError if nothing of it is computed."""
    stacks = read_variants(work.folder.runs)
    folder = work.folder.of_stage("deviations")
    folder.mkdir(exist_ok=True)
    write_csv(stacks, folder / STACKS, float_format="%.6g")
    tables = [
        ("The deviations", deviations_grid()),
        ("Changes when a deviation is undone", changes_grid(stacks)),
        ("Changes when a setting of ours is varied", variations_grid(stacks)),
        ("Quartiles of H/L, of the rows, by both trimming rules", quartiles_grid(stacks)),
    ]
    return Content(sample_text(stacks), tables)


def sample_text(stacks: pd.DataFrame) -> list[str]:
    """Return the text on the computed sample and the meaning of the tables."""
    ours = stacks[stacks["variant"] == DEFAULTS]
    stacks = stacks[stacks["variant"].isin(VARIANTS)]
    panels, seeds = len(ours[list(PANEL)].drop_duplicates()), ours["seed"].nunique()
    longest, events = ours["panel.length"].max(), ours["event"].max()
    return [
        f"The sample has {panels} of the 122 panels of chapter 5, up to {longest:g} m long, with "
        f"{events:g} events and {seeds} seeding{'s' if seeds > 1 else ''} each. The panels were "
        "chosen by their geometry alone. They were simulated with our settings, with each "
        "deviation undone, and with all undone.",
        f"{_cells_sentence(stacks)} The trimming rule is `outermost_first`, except in "
        "the variants `trimming` and `thesis`.",
        "A change is the change of the mean stack below a panel, relative to our settings with "
        "the same seed; its noise is the standard error over the panels. A change of up to "
        f"{SIGMAS:g} standard errors may be chance.",
        f"Table 5.3.1 holds quartiles of predictions for {THESIS_ROWS} rows. The quartiles here "
        "are those of rows of a sample: compare them only with each other.",
        f"Frames are counted at {FRAME_RATE:g} per second; the thesis prints only their number.",
    ]


def _cells_sentence(stacks: pd.DataFrame) -> str:
    sizes = [f"{100 * dx:.3g} cm" for dx in sorted(stacks["dx"].unique(), reverse=True)]
    if len(sizes) < 2:
        return f"Cells are {sizes[0]} wide."
    return f"Cells are {sizes[0]} wide, and {sizes[1]} where the deviation `grid` is undone."


def deviations_grid() -> HtmlTable:
    """Return each deviation and its reason."""
    rows = [
        [deviation.name, deviation.thesis, deviation.here, deviation.reason]
        for deviation in DEVIATIONS.values()
    ]
    return HtmlTable(["deviation", "the thesis", "here", "because"], rows, "llll")


def changes_grid(stacks: pd.DataFrame) -> HtmlTable:
    """Return the change of a stack by each deviation, the largest change of H/L first."""
    rows = []
    for name in by_size(stacks):
        rows.append([_title(stacks, name), *_changes(stacks, name)])
    if THESIS in set(stacks["variant"]):
        rows.append(["all except the trimming", *_changes(stacks, THESIS, DEFAULT_TRIMMING)])
        rows.append([_title(stacks, THESIS), *_changes(stacks, THESIS)])
    return HtmlTable(["undone", *QUANTITIES.values()], rows, "l" + "r" * len(QUANTITIES))


def variations_grid(stacks: pd.DataFrame) -> HtmlTable:
    """Return the change of a stack by each variation of our settings."""
    present_names = [name for name in VARIATIONS if name in set(stacks["variant"])]
    rows = [[VARIATION_LABELS[name], *_changes(stacks, name)] for name in present_names]
    return HtmlTable(["varied", *QUANTITIES.values()], rows, "l" + "r" * len(QUANTITIES))


def _changes(stacks: pd.DataFrame, name: str, trimming: Optional[str] = None) -> list[str]:
    estimates = (change(stacks, name, quantity, trimming) for quantity in QUANTITIES)
    return [change_text(estimate) for estimate in estimates]


def errors_grid(errors: pd.DataFrame, stacks: pd.DataFrame) -> HtmlTable:
    """Return Tables 5.3.1 and 5.3.2 for the rows of each variant.

    Parameters
    ----------
    errors
        From `reproductions.frischholz2023.variant_errors`.
    stacks
        From `reproductions.frischholz2023.variants.read_variants`.
    """
    rows = []
    for row in errors.to_dict("records"):
        numbers = [f"{row[name]:.3f}" for name in QUARTILES]
        numbers += [f"{row[name]:.4f}" for name in ("mean_absolute_error", "held_out_error")]
        part = percent(row["mean_absolute_error"] / row["Q2"], 2)
        name = _title(stacks, str(row["variant"]))
        rows.append([name, str(row["trimming"]), str(row["model"]), *numbers, part])
    head = ["undone", "trimming rule", "model", *QUARTILES]
    head += ["mean absolute error", "on rows not trained on", "of the median prediction"]
    return HtmlTable(head, rows, "lll" + "r" * 7)


def change_text(change: Estimate) -> str:
    """Return a relative change with its noise.

    Examples
    --------
    >>> change_text(Estimate(-0.081, 0.02)), change_text(Estimate(-0.001, 0.02))
    ('-8 ± 2 %', '0 ± 2 %')
    >>> change_text(Estimate(0.0, 0.0))
    'none'
    """
    if change.value == 0 and change.noise == 0:
        return "none"
    noise = MISSING if np.isnan(change.noise) else f"{100 * change.noise:.0f}"
    return f"{signed_percentage(change.value)} ± {noise} %"


def signed_percentage(share: float) -> str:
    """Return a share as a whole percentage with its sign; zero has none.

    Examples
    --------
    >>> signed_percentage(0.123), signed_percentage(-0.001)
    ('+12', '0')
    """
    percentage = round(100 * share)
    return f"{percentage:+d}" if percentage else "0"


def quartiles_grid(stacks: pd.DataFrame) -> HtmlTable:
    """Return the quartiles of H/L of each variant with its own runs, by both trimming rules."""
    rows = [
        [
            _title(stacks, name),
            trimming,
            *(f"{quartile:.3f}" for quartile in quartiles(of_one, trimming)),
        ]
        for name, of_one in distinct_variants(stacks)
        for trimming in TRIMMINGS
    ]
    printed = [f"{quartile:.3f}" for quartile in THESIS_QUARTILES["rbf"]]
    rows.append(["Table 5.3.1, RBF", "not printed", *printed])
    return HtmlTable(["undone", "trimming rule", "Q1", "Q2", "Q3", "Q4"], rows, "llrrrr")


def _title(stacks: pd.DataFrame, variant: str) -> str:
    """Return a variant's title, which tells if a deviation changes nothing in the scene."""
    if variant in VARIATIONS:
        return VARIATION_LABELS[variant]
    if variant in (DEFAULTS, THESIS):
        return {DEFAULTS: "none", THESIS: "all: the preset thesis"}[variant]
    return f"{variant} (not switched)" if is_unswitched(stacks, variant) else variant
