"""The report of a reproduction: one page that needs no other file, and ``claims.csv``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path

from reproduction.claims_tables import claims_csv, claims_grid, rules_grid
from reproduction.hypothesis_tests import SIGMAS, Judged
from reproduction.section import Section
from reproduction.stage import Stage
from snowshed import _core
from snowshed.base.machine import cpu_name
from snowshed.io.atomic import write_text
from snowshed.plot.html_page import template

TEMPLATE = "reproduction.html.j2"


@dataclass(frozen=True)
class Texts:
    """What a report says of its publication.

    Attributes
    ----------
    title
        Of the page.
    author
        Heads the column of what the publication claims, such as "the thesis".
    about
        The publication, what is reproduced of it, and how to read the page; may hold HTML.
    caution
        What limits these results, such as a small size; may hold HTML; may be empty.
    noise
        Where the noise of the numbers comes from; may hold HTML.
    """

    title: str
    author: str
    about: str
    caution: str
    noise: str


def common_facts(size: str, stages: Sequence[Stage]) -> dict[str, str]:
    """Return what every report says of its making: size, version, machine, date, stages."""
    return {
        "size": size,
        "version": _core.version,
        "machine": cpu_name(),
        "date": datetime.now(timezone.utc).date().isoformat(),
        "stages": "; ".join(f"{one.name} {one.state().in_words()}" for one in stages),
    }


def write_pages(
    report: Path,
    claims_file: Path,
    texts: Texts,
    facts: Mapping[str, str],
    sections: Sequence[Section],
) -> list[Judged]:
    """Write the page and the table of the claims; return the claims with their findings.

    Parameters
    ----------
    report, claims_file
        The files.
    texts
        What the page says of the publication.
    facts
        Of the reproduction, by their names.
    sections
        In order.
    """
    claims = [claim for section in sections for claim in section.claims]
    write_text(claims_file, claims_csv(claims))
    page = template("reproduction", TEMPLATE).render(
        texts=texts,
        facts=facts,
        sigmas=SIGMAS,
        counts=Counter(one.finding.verdict for one in claims),
        claims=claims_grid(claims, texts.author),
        rules=rules_grid(claims),
        sections=sections,
        of_section=lambda some: claims_grid(some, texts.author),
    )
    write_text(report, page)
    return claims
