"""Section 5.1: stacks below panels of other sizes and tilts."""

from __future__ import annotations

import numpy as np
import pandas as pd

from reproductions.common.hypothesis_tests import judge
from reproductions.common.section import Content
from reproductions.frischholz2023 import printed
from reproductions.frischholz2023.claims.geometry import GEOMETRY, INPUTS
from reproductions.frischholz2023.figures import geometry_figure
from reproductions.frischholz2023.stages import ThesisComputation
from reproductions.frischholz2023.studies import TILTS, geometry
from reproductions.frischholz2023.tables import settings_grid
from snowshed._core import InputError
from snowshed.analysis.regression.dataset import geometry_table as shipped_rows
from snowshed.analysis.regression.rows import StackRows
from snowshed.io.csv_table import read_csv
from snowshed.plot.html_page import HtmlTable, Picture
from snowshed.study.table import read_table

TEXT = (
    "Panels in 2D with the calibrated snow, a slab 5 cm thick and as long as the panel, level "
    "ground. The thesis prints the single variations as a figure only (5.1.1), so its words "
    "are judged: each over all rows that share the other inputs, not only at the reference panel.",
)
CAPTION = "As Figure 5.1.1: each input in turn, the others at the reference panel."


def build(work: ThesisComputation) -> Content:
    """Return the content; raises InputError if the rows are missing."""
    rows = work.rows.read()
    table = geometry_table(rows)
    drawn = pd.concat([table, *_more_tilts(work)], ignore_index=True)
    picture = Picture.drawn(geometry_figure(drawn), "geometry", "Single variations", CAPTION)
    source = f"Rows of the table {work.table.name}." if work.table is not None else ""
    text = [*TEXT, *([source] if source else [])]
    if rows.moving or rows.left_out:
        text.append(
            f"{rows.moving} stacks still moved when their event's time was over; {rows.left_out} "
            "rows without a stack (the run failed, or the snow stayed on the panel) are left out."
        )
    tables = [
        ("Tables 5.1.1 and 5.2.1: the data set", inputs_grid(table)),
        *_settings(work),
        ("How it was computed", columns_grid(read_csv(work.rows.file))),
    ]
    claims = judge(GEOMETRY, table)
    return Content(text, tables, [picture], claims)


def geometry_table(rows: StackRows) -> pd.DataFrame:
    """Return rows as a table for claims and figures."""
    return pd.DataFrame(rows.inputs, columns=list(INPUTS)).assign(**rows.targets)


def inputs_grid(table: pd.DataFrame) -> HtmlTable:
    """Return the values of the inputs, the thesis's beside ours."""
    ours = {
        name: ", ".join(f"{value:g}" for value in np.unique(table[column]))
        for name, column in zip(printed.PANELS, INPUTS)
    }
    rows = [[name, thesis, ours[name]] for name, thesis in printed.PANELS.items()]
    rows.append(["rows", printed.PANEL_ROWS, str(len(table))])
    return HtmlTable(["input", "thesis", "here"], rows, "lll")


def columns_grid(table: pd.DataFrame) -> HtmlTable:
    """Return the settings of the rows from their table, the thesis's beside ours."""
    rows = [
        [row.title, row.text, ", ".join(str(value) for value in np.unique(table[row.path]))]
        for row in printed.PANEL_SETTINGS
        if row.path in table
    ]
    return HtmlTable(["setting", "thesis", "here"], rows, "lll")


def _settings(work: ThesisComputation) -> list[tuple[str, HtmlTable]]:
    """Return the common settings of all panels, unless the table is the user's."""
    if work.table is not None and work.table != shipped_rows(scheme=work.settings.scheme):
        return []
    scene = geometry(work.settings)[0].runs()[0].scene
    return [("Table 5.1.1: settings of all panels", settings_grid(printed.PANELS_SCENE, [scene]))]


def _more_tilts(work: ThesisComputation) -> list[pd.DataFrame]:
    """Return the panels of Table 5.1.1 that are not in the data set, if they are computed."""
    if work.table is not None:
        return []
    try:
        table = read_table(work.folder.runs, TILTS).dropna(subset=["height_m", "length_m"])
    except InputError:
        return []
    names = {"panel.height": "panel_height", "panel.length": "panel_length"}
    names.update({"panel.tilt": "panel_tilt", "height_m": "height", "length_m": "length"})
    table = table.rename(columns=names)[["event", *names.values()]]
    return [table.assign(ratio=table["height"] / table["length"])]
