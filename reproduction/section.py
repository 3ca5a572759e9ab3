"""A section of a report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from reproduction.hypothesis_tests import UNDECIDED, Finding, Judged
from snowshed.plot.html_page import Grid, Picture


@dataclass(frozen=True)
class Section:
    """A section of the report.

    Attributes
    ----------
    name, title
        For links, and as its heading.
    paragraphs
        What was computed and how, and what to know when reading.
    tables
        With their titles.
    pictures, claims
        Figures, and what was found of the publication's claims.
    missing
        What is not there yet, a line each.
    """

    name: str
    title: str
    paragraphs: Sequence[str] = ()
    tables: Sequence[tuple[str, Grid]] = ()
    pictures: Sequence[Picture] = ()
    claims: Sequence[Judged] = ()
    missing: Sequence[str] = ()

    def lacking(self, *lines: str) -> Section:
        """Return the section with more lines on what is missing."""
        return replace(self, missing=[*self.missing, *lines])

    def left_open(self, state: str) -> Section:
        """Return the section with open claims: those of part of a design compare unlike points.

        Parameters
        ----------
        state
            How far the design is, in words.
        """
        words = f"the stage is not complete, {state}"
        claims = [replace(one, finding=Finding(UNDECIDED, words)) for one in self.claims]
        return replace(self, claims=claims)
