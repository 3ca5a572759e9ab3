"""The report of a reproduction: one page that needs no other file, and ``claims.csv``."""

from __future__ import annotations

from collections import Counter
from datetime import datetime, timezone
from pathlib import Path

from reproductions.common.claims_tables import claims_csv, claims_table, rules_table
from reproductions.common.folder import ReproductionFolder
from reproductions.common.hypothesis_tests import SIGMAS, JudgedClaim
from reproductions.common.reproduction import Reproduction, Work
from reproductions.common.size import Settings, Size
from snowshed import _core
from snowshed.base.machine import cpu_name
from snowshed.io.atomic import write_text
from snowshed.plot.html_page import template

PACKAGE, TEMPLATE = "reproductions.common", "reproduction.html.j2"


def write_report(
    reproduction: Reproduction[Work], size: Size[Settings], folder: Path, work: Work
) -> list[JudgedClaim]:
    """Write the report and the table of the claims; return the claims with their findings.

    Parameters
    ----------
    reproduction
        The reproduction.
    size, folder
        The size, and the results folder.
    work
        Its stages, computed or not.
    """
    states = {stage.name: stage.state() for stage in work.stages}
    sections = [(section, section.content(work, states)) for section in reproduction.sections]
    judged_claims = [claim for _, content in sections for claim in content.claims]
    missing = dict.fromkeys(line for _, content in sections for line in content.missing)
    write_text(ReproductionFolder(folder).claims, claims_csv(judged_claims))
    facts = {
        "size": size.name,
        "version": _core.version,
        "machine": cpu_name(),
        "date": datetime.now(timezone.utc).date().isoformat(),
        "stages": "; ".join(f"{name} {state.text()}" for name, state in states.items()),
    }
    page = template(PACKAGE, TEMPLATE).render(
        publication=reproduction,
        caution=size.caution,
        facts=facts,
        sigmas=SIGMAS,
        counts=Counter(claim.finding.verdict for claim in judged_claims),
        claims=claims_table(judged_claims, reproduction.author),
        rules=rules_table(reproduction.claims),
        missing=list(missing),
        sections=sections,
        of_section=lambda some: claims_table(some, reproduction.author),
    )
    write_text(reproduction.report(folder), page)
    return judged_claims
