"""The report: ``hagenmuller.html``, which needs no other file, and ``claims.csv``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from reproduction.hypothesis_tests import Judged, judge
from reproduction.report import Texts, common_facts, write_pages
from reproduction.section import Section

from hagenmuller.claims import ENGINE, PAPER, Tests
from hagenmuller.printed import YADE
from hagenmuller.reproduction import Reproduction
from hagenmuller.studies import MAKERS
from snowshed._core import InputError
from snowshed.analysis.grains.ratios import STRESSES, compare_variants
from snowshed.analysis.grains.sensitivity import FIGURE, evaluate_sensitivity
from snowshed.analysis.grains.variants import BASE
from snowshed.base.formatting import NOTHING
from snowshed.plot.html_page import Grid, Picture

if TYPE_CHECKING:
    import pandas as pd

ABOUT = (
    "Hagenmuller, Chambon and Naaim, <em>Microstructure-based modeling of snow mechanics: a "
    "discrete element approach</em> (The Cryosphere 9, 1969-1982, 2015): what it says of snow in "
    "confined compression, tested with snowshed. Its images and tables are not at hand: the snow "
    "is synthetic, and the numbers that stand beside ours were measured with Yade on one synthetic "
    "sample, by the same contact law."
)
QUICK = (
    "<strong>A quick reproduction.</strong> Samples of some 90 grains are below a representative "
    "volume: what they say of the paper's claims is not final. For 1000 grains and more use "
    "<code>--full</code>."
)
NOISE = (
    "Here it is the logarithm of a ratio of stresses, taken sample by sample. Its noise is the "
    "standard error by the scatter between samples, widened by Student's t, as samples are few. "
    "Hardly means by less than a factor of 1.3."
)
COMPARED = (
    "Stresses on the top plate in kPa, geometric means over the samples, with the factor by which "
    "samples differ; in brackets those of Yade on its one sample.",
)


def write_report(found: Reproduction) -> list[Judged]:
    """Write the report from what is there; return the claims with their findings."""
    try:
        tests = Tests(found.tests())
        claims = judge(PAPER, tests), judge(ENGINE, tests)
        tables = [
            (f"Stage {name}", stress_grid(compare_variants(table)))
            for name, table in zip(reversed(list(MAKERS)), tests.tables)
            if BASE in set(table["variant"])
        ]
        samples = [("Samples", sample_grid(tests.tables))]
    except InputError as error:
        claims, tables, samples = ([], []), [], []
        missing = [str(error)]
    else:
        missing = [
            f"stage {name}: {stage.state().in_words()}"
            for name, stage in found.stages.items()
            if not stage.state().finished
        ]
    sections = [
        Section("paper", "What the paper says", (), samples, (), claims[0], missing),
        Section("engine", "Beside Yade", COMPARED, tables, (), claims[1]),
        Section("sensitivity", "What matters", (), (), _pictures(found)),
    ]
    texts = Texts(
        "Snow from grains, reproduced", "the paper", ABOUT,
        QUICK if found.size.name == "quick" else "", NOISE,
    )  # fmt: skip
    facts = common_facts(found.size.name, list(found.stages.values()))
    return write_pages(
        found.folder / "hagenmuller.html", found.folder / "claims.csv", texts, facts, sections
    )


def _pictures(found: Reproduction) -> list[Picture]:
    folder = found.folder / "sensitivity"
    try:
        evaluate_sensitivity(found.comparisons["brittle"], found.runs, folder)
    except InputError:
        return []
    caption = "As of `snowshed grains sensitivity`; the numbers are in sensitivity/sensitivity.csv."
    return [Picture.read(folder / FIGURE, "Sensitivity", caption, dpi=160)]


def sample_grid(tables: Sequence[pd.DataFrame]) -> Grid:
    """Return what the samples of each variant are."""
    import pandas as pd

    found = pd.concat([one for one in tables if len(one)])
    rows = []
    for variant, own in found.drop_duplicates(["variant", "sample"]).groupby("variant", sort=False):
        numbers = [_span(own[name]) for name in ("final_particles", "spheres", "density_kg_m3")]
        rows.append([str(variant), str(len(own)), *numbers])
    return Grid(["variant", "samples", "grains", "spheres", "kg/m3"], rows, "lrrrr")


def _span(values: pd.Series) -> str:
    low, high = float(values.min()), float(values.max())
    return f"{low:,.0f}" if round(low) == round(high) else f"{low:,.0f} to {high:,.0f}"


def stress_grid(comparison: pd.DataFrame) -> Grid:
    """Return the stresses of each variant beside those of Yade."""
    known = set(comparison["stress"][np.isfinite(comparison["value_pa"])])
    stresses = [name for name in STRESSES if name in known]  # that the tests reach
    rows = []
    for variant in dict.fromkeys(comparison["variant"]):
        own = comparison[comparison["variant"] == variant].set_index("stress")
        printed = dict(zip(STRESSES, YADE.get(str(variant), (None,) * len(STRESSES))))
        rows.append([str(variant), *(_stress(own.loc[name], printed[name]) for name in stresses)])
    titles = [STRESSES[name] for name in stresses]
    return Grid(["variant", *titles], rows, "l" + "r" * len(stresses))


def _stress(row: pd.Series, printed: object) -> str:
    value, scatter = float(row["value_pa"]), float(row["scatter"])
    text = f"{value / 1e3:.3g}" if np.isfinite(value) else NOTHING
    text += f" x/ {np.exp(scatter):.2f}" if np.isfinite(scatter) else ""
    return text if printed is None else f"{text} [{printed:g}]"


def report_file(folder: Path) -> Path:
    """Return the report's file."""
    return folder / "hagenmuller.html"
