"""The sections of the report: the paper's claims, Yade's numbers, and the sensitivity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from reproductions.common.hypothesis_tests import judge
from reproductions.common.section import Content
from reproductions.hagenmuller2015.claims import ENGINE, PAPER
from reproductions.hagenmuller2015.printed import YADE
from reproductions.hagenmuller2015.stages import GrainsComputation
from reproductions.hagenmuller2015.studies import MAKERS
from snowshed.analysis.grains.ratios import STRESSES, compare_variants
from snowshed.analysis.grains.sensitivity import FIGURE, evaluate_variants
from snowshed.analysis.grains.variants import BASE
from snowshed.base.formatting import MISSING
from snowshed.plot.html_page import HtmlTable, Picture

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

STRESSES_TEXT = (
    "The tables have stresses on the top plate in kPa: geometric means over the samples, with the "
    "factor by which samples differ. Numbers in brackets are the stresses of Yade's one sample.",
)


def paper(work: GrainsComputation) -> Content:
    """Return the paper's claims, and the samples."""
    samples = [("Samples", sample_grid(work.tests.tables))]
    return Content(tables=samples, claims=judge(PAPER, work.tests))


def engine(work: GrainsComputation) -> Content:
    """Return the stresses beside those of Yade."""
    tables = [
        (f"Stage {name}", stress_grid(compare_variants(table)))
        for name, table in zip(reversed(list(MAKERS)), work.tests.tables)
        if BASE in set(table["variant"])
    ]
    return Content(STRESSES_TEXT, tables, claims=judge(ENGINE, work.tests))


def sensitivity(work: GrainsComputation) -> Content:
    """Return the sensitivity of the strength."""
    folder = work.folder.of_stage("sensitivity")
    evaluate_variants(work.comparisons["brittle"], work.folder.runs, folder)
    caption = "As by `snowshed grains sensitivity`; the numbers are in sensitivity/sensitivity.csv."
    return Content(pictures=[Picture.read(folder / FIGURE, "Sensitivity", caption, dpi=160)])


def sample_grid(tables: Sequence[pd.DataFrame]) -> HtmlTable:
    """Return the samples of each variant."""
    import pandas as pd

    tests = pd.concat([table for table in tables if len(table)])
    rows = []
    for variant, own in tests.drop_duplicates(["variant", "sample"]).groupby("variant", sort=False):
        numbers = [
            _range_text(own[name]) for name in ("final_particles", "spheres", "density_kg_m3")
        ]
        rows.append([str(variant), str(len(own)), *numbers])
    return HtmlTable(["variant", "samples", "grains", "spheres", "kg/m3"], rows, "lrrrr")


def _range_text(values: pd.Series) -> str:
    low, high = float(values.min()), float(values.max())
    return f"{low:,.0f}" if round(low) == round(high) else f"{low:,.0f} to {high:,.0f}"


def stress_grid(comparison: pd.DataFrame) -> HtmlTable:
    """Return the stresses of each variant beside those of Yade."""
    known = set(comparison["stress"][np.isfinite(comparison["value_pa"])])
    stresses = [name for name in STRESSES if name in known]  # that the tests reach
    rows = []
    for variant in dict.fromkeys(comparison["variant"]):
        own = comparison[comparison["variant"] == variant].set_index("stress")
        printed = dict(zip(STRESSES, YADE.get(str(variant), (None,) * len(STRESSES))))
        rows.append([str(variant), *(_stress(own.loc[name], printed[name]) for name in stresses)])
    titles = [STRESSES[name] for name in stresses]
    return HtmlTable(["variant", *titles], rows, "l" + "r" * len(stresses))


def _stress(row: pd.Series, printed: object) -> str:
    value, scatter = float(row["value_pa"]), float(row["scatter"])
    text = f"{value / 1e3:.3g}" if np.isfinite(value) else MISSING
    text += f" x/ {np.exp(scatter):.2f}" if np.isfinite(scatter) else ""
    return text if printed is None else f"{text} [{printed:g}]"
