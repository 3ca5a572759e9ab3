"""The answer: the lowest height of the lower edge at which the snow stays clear of it.

Every case (a winter with drawn values) is simulated at the candidate heights that decide where its
snow first reaches the edge, by bisection: a higher edge is not reached before a lower one. The runs
are those of a study, kept in a store, so that an interrupted answer goes on to the same result.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.clearance.design import Design, Ranges
from snowshed.analysis.clearance.seasons import Case, Outcome, cases_of
from snowshed.analysis.clearance.statistics import Level, Share, levels_of, shares_of
from snowshed.analysis.clearance.winters import Winter
from snowshed.base.arrays import Floats
from snowshed.base.json_values import JsonValue
from snowshed.base.progress import Reporter
from snowshed.season.record import WinterList
from snowshed.season.settings import SeasonSettings
from snowshed.study.session import compute_runs, expected_duration
from snowshed.study.table import read_table

if TYPE_CHECKING:
    import pandas as pd

STUDY = "clearance"


@dataclass(frozen=True)
class Answer:
    """What height of the lower edge a panel needs.

    Attributes
    ----------
    design
        The panel.
    heights
        Candidate heights of the lower edge, m.
    cases
        Every winter with its draws.
    outcomes
        For each case, what was simulated, by rising height.
    failed
        Runs that could not be computed; their cases are left out.
    winters
        Names of the winters that count.
    known
        How well the snow of each winter of the file is known; None: not asked.
    """

    design: Design
    heights: Sequence[float]
    cases: Sequence[Case]
    outcomes: Sequence[Sequence[Outcome]]
    failed: int = 0
    winters: Sequence[str] = field(default_factory=list)
    known: Optional[WinterList] = None

    @property
    def required(self) -> Floats:
        """The height that each case needs (n,), m."""
        return np.array([required_height(found) for found in self.outcomes])

    @property
    def levels(self) -> list[Level]:
        """The height that stays clear with 50, 90 and 98 % probability of a winter."""
        return levels_of(self.required, self._winter_numbers)

    @property
    def shares(self) -> list[Share]:
        """What the required height varies with, and how much, the largest first."""
        values = {
            name: np.array([case.values[name] for case in self.cases])
            for name in self.cases[0].values
        }
        return shares_of(self.required, self._winter_numbers, values)

    @property
    def worst(self) -> int:
        """The case that needs the highest edge."""
        return int(np.argmax(self.required))

    def buried(self, height: float) -> float:
        """Return the probability of a winter that snow reaches a lower edge at a height, m."""
        return float((self.required > height).mean())

    @property
    def winters_in_words(self) -> str:
        """From how many winters the answer is, such as "2 of 20 winters"."""
        number = len(self.winters)
        if self.known is None or len(self.known.winters) == number:
            return "1 winter" if number == 1 else f"{number} winters"
        return self.known.words

    @property
    def _winter_numbers(self) -> Floats:
        names = [case.winter.name for case in self.cases]
        return np.unique(names, return_inverse=True)[1].astype(float)

    def table(self) -> pd.DataFrame:
        """Return one row per case and height that was simulated."""
        import pandas as pd

        rows = []
        for number, (case, found) in enumerate(zip(self.cases, self.outcomes), 1):
            for one in found:
                contact = one.contact
                rows.append(
                    {
                        "slope_length_m": self.design.slope_length,
                        "tilt_deg": self.design.tilt,
                        "case": number,
                        "winter": case.winter.name,
                        **case.values,
                        "seed": case.seed,
                        "height_m": one.height,
                        "margin_m": one.margin,
                        "touched": int(contact is not None),
                        "first_contact": "" if contact is None else contact.date,
                        "cause": "" if contact is None else contact.cause,
                        "required_m": required_height(found),
                    }
                )
        return pd.DataFrame(rows)


def required_height(found: Sequence[Outcome]) -> float:
    """Return the height of the lower edge at which the snow just stays clear, m.

    Between the highest edge that it reaches and the next one it is interpolated; beyond the
    heights that were simulated it follows from the margin at the nearest.

    Examples
    --------
    >>> from snowshed.season.clearance import Contact
    >>> touched = Contact("2024-12-24", 1, "crest")
    >>> required_height([Outcome(1.0, -0.1, touched), Outcome(2.0, 0.9, None)])
    1.1
    """
    reached = [one for one in found if one.contact is not None]
    clear = [one for one in found if one.contact is None]
    if not clear:
        return max(reached, key=lambda one: one.height).height - reached[-1].margin
    above = min(clear, key=lambda one: one.height)
    if not reached:
        return max(above.height - above.margin, 0.0)
    below = max(reached, key=lambda one: one.height)
    part = -below.margin / (above.margin - below.margin)
    return below.height + part * (above.height - below.height)


def clearance_of(
    design: Design,
    winters: Sequence[Winter],
    heights: Sequence[float],
    folder: Path,
    *,
    ranges: Optional[Ranges] = None,
    settings: Optional[SeasonSettings] = None,
    scene: Optional[Mapping[str, JsonValue]] = None,
    known: Optional[WinterList] = None,
    jobs: Optional[int] = None,
    progress: Optional[Reporter] = None,
) -> Answer:
    """Return what height of the lower edge a panel needs.

    Parameters
    ----------
    design
        The panel.
    winters
        From `winters_of`.
    heights
        Candidates for the height of the lower edge above the ground, m.
    folder
        Of the store of runs; an interrupted answer goes on there.
    ranges
        What nobody knows; None: the defaults.
    settings
        Of the seasons, but for what varies; None: the defaults.
    scene
        Values of the scene by dotted path, such as ``numerics.dx``.
    known
        How well the snow of each winter of the file is known (`Record.winters`), for the words.
    jobs
        Local processes at once; None: as many as there are cores.
    progress
        Called with a `Progress` a few times a second.

    Raises
    ------
    InputError
        If a height is not one of a panel, or all runs failed.
    StudyError, StudyInterrupted
        As of `Study.compute`; the same call goes on.
    """
    candidates = sorted(set(heights))
    if not candidates or not 0.0 < candidates[0] <= candidates[-1] <= 100.0:
        raise InputError(f"heights: {candidates}; needed: at least one from 0 to 100 m")
    values = (ranges or Ranges()).drawn(len(winters))
    cases = cases_of(design, winters, values, settings or SeasonSettings(), scene or {})
    search = _Search(cases, candidates)
    while search.open():
        runs = search.runs()
        compute_runs(folder, STUDY, [], list(runs.values()), jobs=jobs, progress=progress)
        search.take(read_table(folder, STUDY))
    kept = [number for number, found in enumerate(search.outcomes) if found]
    if not kept:
        raise InputError(f"{folder}: all runs failed; see its table")
    return Answer(
        design,
        candidates,
        [cases[number] for number in kept],
        [sorted(search.outcomes[number], key=lambda one: one.height) for number in kept],
        len(cases) - len(kept),
        [winter.name for winter in winters],
        known,
    )


def forecast(
    design: Design,
    winters: Sequence[Winter],
    heights: Sequence[float],
    *,
    ranges: Optional[Ranges] = None,
    settings: Optional[SeasonSettings] = None,
    scene: Optional[Mapping[str, Any]] = None,
    jobs: Optional[int] = None,
) -> tuple[float, int]:
    """Return how long an answer will take, s, and of how many seasons it is.

    Parameters are those of `clearance_of`.
    """
    values = (ranges or Ranges()).drawn(len(winters))
    cases = cases_of(design, winters, values, settings or SeasonSettings(), scene or {})
    search = _Search(cases, sorted(set(heights)))
    scenes = [run.scene for run in search.runs().values()]
    seconds = expected_duration(scenes, jobs=jobs)[0] if scenes else 0.0
    return seconds * search.rounds, round(len(scenes) * search.rounds)


class _Search:
    """Bisection for every case over the candidate heights."""

    def __init__(self, cases: Sequence[Case], heights: Sequence[float]) -> None:
        self.cases, self.heights = cases, heights
        self.outcomes: list[list[Outcome]] = [[] for _ in cases]
        self._low = [0] * len(cases)  # heights below are reached
        self._high = [len(heights)] * len(cases)  # heights from there on are clear
        self._runs: dict[tuple[int, int], Any] = {}

    @property
    def rounds(self) -> int:
        """How often each case is simulated, about."""
        return max(1, int(np.ceil(np.log2(len(self.heights) + 1) - 1e-9)))

    def open(self) -> list[tuple[int, int]]:
        """Return the cases that are not decided, each with the height to simulate next."""
        return [
            (number, (low + high) // 2)
            for number, (low, high) in enumerate(zip(self._low, self._high))
            if low < high
        ]

    def runs(self) -> dict[tuple[int, int], Any]:
        """Return all runs so far, with those that are needed next."""
        for number, place in self.open():
            if self.cases[number].slides and (number, place) not in self._runs:
                self._runs[number, place] = self.cases[number].run(self.heights[place])
        return self._runs

    def take(self, table: pd.DataFrame) -> None:
        """Take what the runs gave, and halve what is open."""
        events = dict(tuple(table.groupby("hash"))) if len(table) else {}
        nothing = table.iloc[:0]
        for number, place in self.open():
            run = self._runs.get((number, place))
            rows = nothing if run is None else events.get(run.hash, nothing)
            if (rows["ended"] == "failed").any() or (run is not None and rows.empty):
                self._low[number] = self._high[number]  # left out
                self.outcomes[number] = []
                continue
            found = self.cases[number].outcome(self.heights[place], rows)
            self.outcomes[number].append(found)
            if found.contact is None:
                self._high[number] = place
            else:
                self._low[number] = place + 1
