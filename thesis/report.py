"""The report: ``thesis.html``, which needs no other file, and ``claims.csv``."""

from __future__ import annotations

import importlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime, timezone

from snowshed import _core
from snowshed._core import InputError
from snowshed.io.atomic import write_text
from snowshed.plot.html_page import Grid, template
from snowshed.run.machine import cpu_name
from thesis.claims.hypothesis_tests import (
    CONFIRMED,
    CONTRADICTED,
    SIGMAS,
    UNDECIDED,
    Finding,
    Judged,
)
from thesis.reproduction import Reproduction
from thesis.section import Section
from thesis.stage import State

TEMPLATE = "thesis.html.j2"
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
VERDICTS = (CONTRADICTED, CONFIRMED, UNDECIDED)


def write_report(found: Reproduction) -> list[Judged]:
    """Write the report from what is there; return the claims with their findings."""
    sections = [build(found, module, stage) for module, stage in SECTIONS.items()]
    claims = [claim for section in sections for claim in section.claims]
    write_text(found.folder.claims, claims_csv(claims))
    write_text(found.folder.report, render(found, sections, claims))
    return claims


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
        section = replace(section, claims=[_open(one, state) for one in section.claims])
    return section.lacking(*lines)


def _open(claim: Judged, state: State) -> Judged:
    """Leave a claim open: means over part of a design would compare unlike points."""
    words = f"the stage is not complete, {state.in_words()}"
    return replace(claim, finding=Finding(UNDECIDED, words))


def render(found: Reproduction, sections: Sequence[Section], claims: Sequence[Judged]) -> str:
    """Return the report as HTML."""
    return template("thesis", TEMPLATE).render(
        facts={
            "size": found.size.name,
            "version": _core.version,
            "machine": cpu_name(),
            "date": datetime.now(timezone.utc).date().isoformat(),
            "stages": "; ".join(f"{one.name} {one.state().in_words()}" for one in found.stages),
        },
        quick=found.size.name == "quick",
        sigmas=SIGMAS,
        counts=Counter(one.finding.verdict for one in claims),
        claims=claims_grid(claims),
        rules=rules_grid(claims),
        sections=sections,
        of_section=claims_grid,
    )


def claims_grid(claims: Sequence[Judged]) -> Grid:
    """Return claims and findings, contradictions first."""
    ordered = sorted(claims, key=lambda one: VERDICTS.index(one.finding.verdict))
    rows = [[one.finding.verdict, one.source, one.text, one.finding.sentence] for one in ordered]
    return Grid(["verdict", "section", "the thesis", "here"], rows, "llll")


def rules_grid(claims: Sequence[Judged]) -> Grid:
    """Return when each claim counts as confirmed."""
    rows = [[one.source, one.text, one.rule] for one in claims]
    return Grid(["section", "claim", "confirmed if"], rows, "lll")


def claims_csv(claims: Sequence[Judged]) -> str:
    """Return claims and findings as CSV."""
    import pandas as pd

    rows = [
        (one.source, one.text, one.rule, one.finding.verdict, one.finding.sentence)
        for one in claims
    ]
    columns = ["source", "claim", "confirmed_if", "verdict", "finding"]
    text: str = pd.DataFrame(rows, columns=columns).to_csv(index=False)
    return text
