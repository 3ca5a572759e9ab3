"""The laboratory experiment: chapter 2, with the calibrated snow of chapter 4."""

from __future__ import annotations

from typing import TYPE_CHECKING

from reproductions.common.hypothesis_tests import JudgedClaim, judge
from reproductions.common.section import Content
from reproductions.frischholz2023 import printed
from reproductions.frischholz2023.claims import lab as claims
from reproductions.frischholz2023.figures import growth_figure
from reproductions.frischholz2023.settings import MEASURED_FRICTION
from reproductions.frischholz2023.stages import ThesisComputation
from reproductions.frischholz2023.studies import LABORATORIES, RELEASE
from reproductions.frischholz2023.tables import grouped, plus_minus, settings_grid
from snowshed._core import InputError
from snowshed.base.formatting import percent
from snowshed.plot.html_page import HtmlTable, Picture
from snowshed.snow.stack.quantities import QUANTITIES
from snowshed.study.table import read_table

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = {
    "panel.tilt": "tilt",
    "panel.friction": "friction",
    **{f"{name}_m": name for name in QUANTITIES},
}
TEXT = (
    "Five slabs slide off the model panel one after another; particles carry over from event to "
    "event. The thesis does not print the friction between snow and panel (it measured a static "
    "coefficient of 0.6 to 0.8 on Plexiglas), so stacks are given for each friction that was "
    "computed, and claims are judged at 0.6.",
    "The thesis prints the measured stacks as figures only (2.4.1 to 2.4.4), so our stacks "
    "cannot be compared with numbers. Claims about them are judged on simulated stacks. Only the "
    "mean stack follows from numbers: mean errors of 0.010 m (about 10 %) and 0.061 m (about 20 %) "
    "in Table 4.3.1 give a height of about 0.10 m and a length of about 0.30 m.",
)
CAPTION = (
    "As Figures 2.4.1 to 2.4.4, simulated. Bars: deviation between seedings. The origin is the "
    "panel's centre."
)


def build(work: ThesisComputation) -> Content:
    """Return the content; raises InputError if nothing of it is computed."""
    stage = work.study_stages["lab"]
    rows = lab_rows(work)
    released = release_rows(read_table(work.folder.runs, RELEASE))
    scenes = [scene for name in (*_laboratories(work), RELEASE) for scene in stage.scenes(name)]
    tables = [
        ("Tables 2.3.1, 4.1.1 and 4.3.1: settings", settings_grid(printed.LABORATORY, scenes)),
        ("Stacks after each event (mean ± deviation between seedings)", stacks_grid(rows)),
        ("At 30 degrees", release_grid(released)),
        ("The same claims for other dimensions and frictions", variants_grid(rows)),
    ]
    picture = Picture.drawn(growth_figure(rows), "lab-growth", "Growth of the stacks", CAPTION)
    return Content(TEXT, tables, [picture], judge_laboratory(rows, released))


def lab_rows(work: ThesisComputation) -> pd.DataFrame:
    """Return the stacks at 40 and 50 degrees, one row per run and event."""
    import pandas as pd

    tables = [read_table(work.folder.runs, name) for name in _laboratories(work)]
    table = pd.concat(tables, ignore_index=True).rename(columns=COLUMNS)
    rows = table[["dimension", *COLUMNS.values(), "seed", "event"]].dropna()
    if rows.empty:
        raise InputError("no stack at 40 or 50 degrees is computed yet")
    return rows


def _laboratories(work: ThesisComputation) -> list[str]:
    return [LABORATORIES[dimension] for dimension in work.settings.lab_dimensions]


def release_rows(table: pd.DataFrame) -> pd.DataFrame:
    """Return the last event of each run at 30 degrees, with the part that stayed on the panel."""
    table = table.rename(columns=COLUMNS).dropna(subset=["on_panel_kg", "mass_kg"])
    last = table.sort_values("event").groupby(["friction", "seed"]).tail(1).copy()
    last["stayed"] = last["on_panel_kg"] / (last["on_panel_kg"] + last["mass_kg"])
    return last[["friction", "seed", "event", "stayed", "ended", "height", "length"]]


def judge_laboratory(rows: pd.DataFrame, released: pd.DataFrame) -> list[JudgedClaim]:
    """Return the findings in 3D, else in 2D, at the lowest friction that the thesis measured."""
    measured = rows["friction"][rows["friction"] >= MEASURED_FRICTION]
    friction = measured.min() if len(measured) else rows["friction"].max()
    three, two = (_variant(rows, dimension, friction) for dimension in (3, 2))
    return [
        *judge(claims.GROWTH, three if len(three) else two),
        *judge(claims.DIMENSIONS, (three, two)),
        *judge(claims.RELEASE, released),
    ]


def variants_grid(rows: pd.DataFrame) -> HtmlTable:
    """Return the verdict of every claim for every dimension and friction."""
    variants = dict(grouped(rows, "dimension", "friction"))
    verdicts = [
        [claim.finding.verdict for claim in judge(claims.GROWTH, of_variant)]
        for of_variant in variants.values()
    ]
    head = ["claim", *(f"{d:g}D, friction {mu:g}" for d, mu in variants)]
    table = [[claim.text, *of_claim] for claim, *of_claim in zip(claims.GROWTH, *verdicts)]
    return HtmlTable(head, table, "l" * len(head))


def stacks_grid(rows: pd.DataFrame) -> HtmlTable:
    """Return mean stacks, one row per dimension, friction, tilt and event."""
    keys = ("dimension", "friction", "tilt", "event")
    table = [
        [
            f"{dimension:g}D",
            f"{friction:g}",
            f"{tilt:g}°",
            f"{event:g}",
            *(plus_minus(of_one[name].mean(), of_one[name].std()) for name in QUANTITIES),
        ]
        for (dimension, friction, tilt, event), of_one in grouped(
            rows.sort_values(list(keys)), *keys
        )
    ]
    head = ["", "friction", "tilt", "event", *(f"{name}, m" for name in QUANTITIES)]
    return HtmlTable(head, table, "llll" + "r" * len(QUANTITIES))


def release_grid(rows: pd.DataFrame) -> HtmlTable:
    """Return the outcome of the slabs at 30 degrees."""
    table = [
        [f"{row['friction']:g}", f"{row['event']:g}", percent(row["stayed"], 2), row["ended"]]
        for _, row in rows.sort_values(["friction", "seed"]).iterrows()
    ]
    return HtmlTable(["friction", "events", "snow that stays on the panel", "ended"], table, "lrrl")


def _variant(rows: pd.DataFrame, dimension: float, friction: float) -> pd.DataFrame:
    return rows[(rows["dimension"] == dimension) & (rows["friction"] == friction)]
