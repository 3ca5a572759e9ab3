"""Sections of a report: what they need, and what they hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Generic, Literal, TypeVar

from reproductions.common.hypothesis_tests import UNDECIDED, Finding, Judged
from reproductions.common.stage import State
from snowshed._core import InputError
from snowshed.plot.html_page import Grid, Picture

Work = TypeVar("Work")


@dataclass(frozen=True)
class Content:
    """The content of a section.

    Attributes
    ----------
    paragraphs
        What was computed and how, and what to know when reading.
    tables
        With their titles.
    pictures, claims
        Figures, and findings on the publication's claims.
    missing
        What is not there yet, a line each.
    """

    paragraphs: Sequence[str] = ()
    tables: Sequence[tuple[str, Grid]] = ()
    pictures: Sequence[Picture] = ()
    claims: Sequence[Judged] = ()
    missing: Sequence[str] = ()


@dataclass(frozen=True)
class Section(Generic[Work]):
    """A section of the report.

    Attributes
    ----------
    name, title
        For links, and as its heading.
    build
        From the computation to the content; raises InputError if too little is computed.
    stages
        Names of the stages that it is of.
    judged
        When its claims are judged: on "any" part of the stages, when they have "ended" with or
        without failures, or when all of them is "done". Before that, claims stay open: means over
        part of a design compare unlike points.
    """

    name: str
    title: str
    build: Callable[[Work], Content]
    stages: Sequence[str]
    judged: Literal["any", "ended", "done"] = "any"

    def content(self, work: Work, states: Mapping[str, State]) -> Content:
        """Return the content; where something is missing it says what.

        Parameters
        ----------
        work
            The computation.
        states
            The state of each of its stages.
        """
        own = {name: states[name] for name in self.stages if name in states}
        parts = {name: state for name, state in own.items() if not state.complete}
        lines = [f"stage {name}: {state.in_words()}" for name, state in parts.items()]
        try:
            content = self.build(work)
        except InputError as error:
            return Content(missing=[*lines, str(error)])
        for state in parts.values():
            if self.judged == "done" or (self.judged == "ended" and not state.finished):
                content = _left_open(content, state)
        return replace(content, missing=[*content.missing, *lines])


def _left_open(content: Content, state: State) -> Content:
    finding = Finding(UNDECIDED, f"the stage is not complete, {state.in_words()}")
    return replace(content, claims=[replace(one, finding=finding) for one in content.claims])
