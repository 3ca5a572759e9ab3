"""The report: ``thesis.html``, which needs no other file, and ``claims.csv``."""

from __future__ import annotations

import importlib

from reproduction.hypothesis_tests import Judged
from reproduction.report import Texts, common_facts, write_pages
from reproduction.section import Section
from reproduction.stage import State

from snowshed._core import InputError
from thesis.reproduction import Reproduction

#: The modules of `thesis.sections`, in order, and the stage that each needs.
SECTIONS = {
    "lab": "lab",
    "s_index": "s-index",
    "fixation": "fixation",
    "calibration": "calibration",
    "deviations": "deviations",
    "geometry": "geometry",
    "regression": "regression",
}
#: Sections whose claims compare means over a design: a run that failed makes them unlike.
DESIGNS = ("lab", "s_index", "fixation")
ABOUT = (
    "Frischholz, <em>Snow slide-off from solar panels with the Material Point Method</em> (master "
    "thesis, EPFL and SLF): its laboratory experiment and chapters 3 to 5, computed again with "
    "snowshed. Every table stands beside the numbers that the thesis prints; every claim has a "
    "verdict."
)
QUICK = (
    "<strong>A quick reproduction.</strong> Coarse cells, 2D instead of 3D in chapters 3 and 4, "
    "few seedings and few values: it shows the way. Its verdicts are those of these settings, not "
    "of the thesis's; for these use <code>--full</code>."
)
NOISE = (
    "Its noise is that of the seeding: another placement of the particles gives another stack. "
    "Deviations between seedings are pooled over the points that a claim compares and divided by "
    "the root of the number of runs a mean is over; where there are few seedings, they are "
    "widened by Student's t. Where slopes are fitted, the noise is their standard error; for "
    "scores of the regressions it is the standard error over the outer folds, for errors and "
    "quartiles that over the panels. Rules that say <em>no noise</em> compare numbers as they "
    "are."
)


def write_report(found: Reproduction) -> list[Judged]:
    """Write the report from what is there; return the claims with their findings."""
    sections = [build(found, module, stage) for module, stage in SECTIONS.items()]
    quick = found.size.name == "quick"
    texts = Texts("The thesis reproduced", "the thesis", ABOUT, QUICK if quick else "", NOISE)
    facts = common_facts(found.size.name, found.stages)
    return write_pages(found.folder.report, found.folder.claims, texts, facts, sections)


def build(found: Reproduction, module: str, stage: str) -> Section:
    """Return a section; where something is missing it says what."""
    states = {one.name: one.state() for one in found.stages}
    state = states.get(stage, State(0, 0, 0))
    whole = state.finished and not state.failed
    lines = [] if whole else [f"stage {stage}: {state.in_words()}"]
    try:
        made = importlib.import_module(f"thesis.sections.{module}")
        section: Section = made.build(found)
    except InputError as error:
        return Section(stage, f"Stage {stage}", missing=[*lines, str(error)])
    if not state.finished or (state.failed and module in DESIGNS):
        section = section.left_open(state.in_words())
    return section.lacking(*lines)
