"""Sections of a report: their stages, and their content."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Generic, Literal, TypeVar

from reproductions.common.hypothesis_tests import UNDECIDED, Finding, JudgedClaim
from reproductions.common.stage import State
from snowshed._core import InputError
from snowshed.plot.html_page import HtmlTable, Picture

Work = TypeVar("Work")


@dataclass(frozen=True)
class Content:
    """The content of a section.

    Attributes
    ----------
    paragraphs
        Texts on the computation, with notes for readers.
    tables
        Tables with their titles.
    pictures, claims
        Figures, and findings on the publication's claims.
    missing
        Missing parts, a line each.
    """

    paragraphs: Sequence[str] = ()
    tables: Sequence[tuple[str, HtmlTable]] = ()
    pictures: Sequence[Picture] = ()
    claims: Sequence[JudgedClaim] = ()
    missing: Sequence[str] = ()


@dataclass(frozen=True)
class Section(Generic[Work]):
    """A section of the report.

    Attributes
    ----------
    name, title
        Anchor of links, and heading.
    build
        Function from the computation to the content; raises InputError if too little is computed.
    stages
        Names of its stages.
    judged
        Condition for judging its claims: "any": always; "ended": all work of its stages is done or
        has failed; "done": all is done. Otherwise claims stay undecided, because means over part of
        a design compare different points.
    """

    name: str
    title: str
    build: Callable[[Work], Content]
    stages: Sequence[str]
    judged: Literal["any", "ended", "done"] = "any"

    def content(self, work: Work, states: Mapping[str, State]) -> Content:
        """Return the content, with a line for each missing part.

        Parameters
        ----------
        work
            The computation.
        states
            The state of each of its stages.
        """
        own = {name: states[name] for name in self.stages if name in states}
        parts = {name: state for name, state in own.items() if not state.complete}
        lines = [f"stage {name}: {state.text()}" for name, state in parts.items()]
        try:
            content = self.build(work)
        except InputError as error:
            return Content(missing=[*lines, str(error)])
        for state in parts.values():
            if self.judged == "done" or (self.judged == "ended" and not state.finished):
                content = _undecided_content(content, state)
        return replace(content, missing=[*content.missing, *lines])


def _undecided_content(content: Content, state: State) -> Content:
    finding = Finding(UNDECIDED, f"the stage is not complete, {state.text()}")
    return replace(content, claims=[replace(claim, finding=finding) for claim in content.claims])
