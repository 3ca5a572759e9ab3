"""Section 3.4: single-parameter fixation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from reproductions.common.hypothesis_tests import judge
from reproductions.common.section import Content
from reproductions.frischholz2023 import printed
from reproductions.frischholz2023.claims.fixation import FIXATION as CLAIMS
from reproductions.frischholz2023.stages import ThesisComputation
from reproductions.frischholz2023.studies import FIXATION, INDEX
from reproductions.frischholz2023.tables import (
    PANEL_FRICTION,
    SAVED_DPI,
    grouped,
    plus_minus,
    settings_grid,
    widenings,
)
from snowshed._core import InputError
from snowshed.analysis.sensitivity.noise import seeding_noise
from snowshed.analysis.sensitivity.report import evaluate_sensitivity
from snowshed.analysis.sensitivity.stored import StudyRuns, read_study_runs
from snowshed.plot.html_page import HtmlTable, Picture
from snowshed.scene.labels import label

if TYPE_CHECKING:
    import pandas as pd

TEXT = (
    "One parameter is held, all others of its group vary: mean and deviation of the stack, "
    "rescaled from 0 to 1 over the group (3.4.1). The yield parameters (M, p₀, β) and the "
    "hardening parameters (ξ, E) are separate groups. The thesis prints these results as figures "
    "only.",
    PANEL_FRICTION,
)
INDEX_NOISE_TEXT = (
    "Every point has one seeding, so the noise is that of the index S (the same scene), "
    "relative to the stack.",
)
TITLES = {"yield": ("3.4.1 and 3.4.2", "yield"), "hardening": ("3.4.3 and 3.4.4", "hardening")}


def build(work: ThesisComputation) -> Content:
    """Return the content; raises InputError if nothing of it is computed."""
    runs, folder = work.folder.runs, work.folder.of_stage("fixation")
    table = evaluate_sensitivity(runs, folder, "fixation", study=FIXATION)
    stored = read_study_runs(runs, FIXATION)
    has_own_noise = work.settings.fixation_seeds > 1
    noise = seeding_noise(stored if has_own_noise else _index_runs(work))
    table = with_noise(table, noise, work.settings.fixation_seeds)
    pictures = [
        Picture.read(
            folder / f"fixation-{group}.png",
            f"Fixation of the {names} parameters",
            f"As Figures {figures}. Envelope: one standard deviation over the other parameters.",
            dpi=SAVED_DPI,
        )
        for group, (figures, names) in TITLES.items()
        if (folder / f"fixation-{group}.png").is_file()
    ]
    scenes = work.study_stages["fixation"].scenes(FIXATION)
    tables = [
        ("Table 3.2.1: settings", settings_grid(printed.SENSITIVITY, scenes)),
        ("Stacks at each value (mean ± deviation over the others, m)", fixation_grid(table)),
    ]
    text = TEXT if has_own_noise else (*TEXT, *INDEX_NOISE_TEXT)
    claims = judge(CLAIMS, table)
    return Content(text, tables, pictures, claims)


def _index_runs(work: ThesisComputation) -> StudyRuns:
    try:
        return read_study_runs(work.folder.runs, INDEX)
    except InputError as error:
        raise InputError(f"its noise is that of the stage s-index: {error}") from None


def with_noise(table: pd.DataFrame, noise: pd.DataFrame, seeds: int) -> pd.DataFrame:
    """Return a `fixation_table` with ``noise_m``, the deviation of ``mean_m`` by the seeding.

    Parameters
    ----------
    table
        From `snowshed.analysis.sensitivity.fixation_table`.
    noise
        From `snowshed.analysis.sensitivity.seeding_noise`, relative to the stack, from any study of
        the same scene.
    seeds
        Random seeds per point.
    """
    keys = list(zip(table["event"], table["target"]))
    relative = np.array([noise["noise"].get(key, np.nan) for key in keys])
    relative *= widenings(table, noise)
    return table.assign(noise_m=relative * table["mean_m"] / np.sqrt(table["points"] * seeds))


def fixation_grid(table: pd.DataFrame) -> HtmlTable:
    """Return means and deviations, one row per parameter, value and target."""
    events = sorted(table["event"].unique())
    rows = []
    for (parameter, value, target), of_one in grouped(table, "parameter", "value", "target"):
        parameter_label = label(parameter)
        by_event = of_one.set_index("event")
        cells = [
            plus_minus(by_event.loc[event, "mean_m"], by_event.loc[event, "deviation_m"])
            for event in events
        ]
        rows.append([parameter_label.symbol, parameter_label.quantity(value), target, *cells])
    head = ["parameter", "value", "of the", *(f"event {event:g}" for event in events)]
    return HtmlTable(head, rows, "lll" + "r" * len(events))
