"""Section 3.3: the single-parameter sensitivity index."""

from __future__ import annotations

from typing import TYPE_CHECKING

from reproductions.common.hypothesis_tests import judge
from reproductions.common.section import Content
from reproductions.frischholz2023 import printed
from reproductions.frischholz2023.claims.s_index import S_INDEX
from reproductions.frischholz2023.stages import ThesisComputation
from reproductions.frischholz2023.studies import INDEX
from reproductions.frischholz2023.tables import (
    PANEL_FRICTION,
    SAVED_DPI,
    grouped,
    plus_minus,
    settings_grid,
    widenings,
)
from snowshed.analysis.sensitivity.noise import seeding_noise
from snowshed.analysis.sensitivity.parameter_values import PAIRS
from snowshed.analysis.sensitivity.report import evaluate_sensitivity
from snowshed.analysis.sensitivity.stored import read_study_runs
from snowshed.plot.html_page import HtmlTable, Picture
from snowshed.scene.labels import label

if TYPE_CHECKING:
    import pandas as pd

TEXT = (
    "S is the relative change of the stack over the relative change of one parameter, all others "
    "at their reference (3.3.1). The thesis prints its scores as a figure only, so its words "
    "are judged.",
    PANEL_FRICTION,
)
CAPTION = (
    "As Figure 3.3.1. Bars: 95 % by seeding noise; hollow where noise alone may make them. STEP 0 "
    "of the thesis is event 1."
)


def build(work: ThesisComputation) -> Content:
    """Return the content; raises InputError if nothing of it is computed."""
    folder = work.folder.of_stage("s-index")
    table = evaluate_sensitivity(work.folder.runs, folder, "s", study=INDEX)
    scenes = work.study_stages["s-index"].scenes(INDEX)
    picture = Picture.read(folder / "s.png", "Index S", CAPTION, dpi=SAVED_DPI)
    tables = [
        ("Table 3.2.1: settings, and the values of Table 3.3.1", _settings(scenes)),
        ("Index S ± standard error by seeding noise", index_grid(table)),
    ]
    noise = seeding_noise(read_study_runs(work.folder.runs, INDEX))
    errors = table["standard_error"] * widenings(table, noise)
    claims = judge(S_INDEX, table.assign(standard_error=errors))
    return Content(TEXT, tables, [picture], claims)


def _settings(scenes: list[str]) -> HtmlTable:
    """Return Table 3.2.1 with the values of Table 3.3.1 where they replace its own."""
    grid = settings_grid(printed.SENSITIVITY, scenes)
    pairs = {row.title: row for row in printed.SENSITIVITY if row.path in PAIRS}
    rows = [list(row) for row in grid.rows]
    for row in rows:
        if row[0] in pairs:
            path = pairs[row[0]].path
            row[1] = ", ".join(label(path).value(value) for value in PAIRS[path])
    note = "thesis (3.3.1 where a parameter varies; else its reference)"
    return HtmlTable(["parameter", note, "here", "unit"], rows, grid.align)


def index_grid(table: pd.DataFrame) -> HtmlTable:
    """Return S, one row per parameter and target."""
    events = sorted(table["event"].unique())
    rows = []
    for (parameter, target), of_one in grouped(table, "parameter", "target"):
        parameter_label = label(parameter)
        first = of_one.iloc[0]
        pair = parameter_label.change(first["nominal"], first["altered"])
        by_event = of_one.set_index("event")
        cells = [
            plus_minus(by_event.loc[event, "s"], by_event.loc[event, "standard_error"])
            for event in events
        ]
        rows.append([parameter_label.symbol, pair, target, *cells])
    head = ["parameter", "from → to", "of the", *(f"event {event:g}" for event in events)]
    return HtmlTable(head, rows, "lll" + "r" * len(events))
