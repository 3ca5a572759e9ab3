"""The answer: the lowest height of the lower edge that shed snow does not reach.

Every case (a winter with drawn values) is simulated at candidate heights, which bisection selects:
snow that reaches an edge also reaches all lower edges. The runs are those of a study, kept in a
store, so that an interrupted answer resumes to the same result.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.clearance.grid_error import GridError, recorded_grid_error
from snowshed.analysis.clearance.panel_design import (
    MARGIN,
    PanelDesign,
    SnowRanges,
    check_base,
)
from snowshed.analysis.clearance.panel_snow import PanelSnow, mean_months
from snowshed.analysis.clearance.seasons import (
    SeasonCase,
    SeasonOutcome,
    cases_of,
    height_key,
    required_height,
)
from snowshed.analysis.clearance.statistics import CauseShare, Level, RequiredHeights
from snowshed.analysis.clearance.winters import Winter
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats, Integers
from snowshed.base.callers import argument
from snowshed.base.formatting import plural
from snowshed.base.json_values import JsonValue
from snowshed.base.notes import issue_note
from snowshed.base.paths import PathLike
from snowshed.base.progress import Reporter
from snowshed.season.rows import check_rows, snow_stays_on_a_row
from snowshed.season.settings import SeasonSettings
from snowshed.season.weather.season_record import WinterList
from snowshed.study.session import compute_runs
from snowshed.study.session import expected_duration as duration_of_runs
from snowshed.study.table import read_table

if TYPE_CHECKING:
    import pandas as pd

STUDY = "clearance"
#: Snow up to this depth counts as none, m.
FLAT = 0.01


@dataclass(frozen=True)
class HeightParts:
    """Parts of the required height of a season.

    Attributes
    ----------
    cover, pile, margin
        The natural snow cover, the shed snow on it, and the distance that the edge keeps, m.
    """

    cover: float
    pile: float
    margin: float


@checked
@dataclass(frozen=True)
class ClearanceResult:
    """The height of the lower edge that a panel needs.

    Attributes
    ----------
    design
        The panel.
    heights
        Candidate heights of the lower edge, m.
    cases
        Every winter with its draws.
    outcomes
        The simulated outcomes of each case, by rising height.
    ranges
        Ranges of the uncertain snow parameters.
    failed
        Number of runs that could not be computed; their cases are left out.
    winters
        Names of the winters that count.
    winter_list
        All winters of the file, with the quality of their snow data, if given.
    """

    design: PanelDesign
    heights: Sequence[float]
    cases: Sequence[SeasonCase]
    outcomes: Sequence[Sequence[SeasonOutcome]]
    ranges: SnowRanges
    failed: int = 0
    winters: Sequence[str] = field(default_factory=list)
    winter_list: Optional[WinterList] = None

    @cached_property
    def required(self) -> Floats:
        """The height that each case needs (n,), m."""
        return np.array([required_height(outcomes) for outcomes in self.outcomes])

    @property
    def shed_part(self) -> float:
        """Part of the required height that is shed snow, in the winters that need most."""
        parts = [self.height_parts(int(index)) for index in self._highest]
        heights = sum(self.required[self._highest])
        return sum(part.pile for part in parts) / heights if heights > 0.0 else 1.0

    @property
    def slide_offs(self) -> int:
        """Median number of slide-offs of a season that has any, in the winters that need most."""
        counts = [self.cases[index].slide_offs for index in self._highest]
        return int(np.median([count for count in counts if count] or [1]))

    @property
    def _highest(self) -> Integers:
        """Numbers of the seasons that need at least the median height (m,)."""
        return np.flatnonzero(self.required >= np.median(self.required))

    @property
    def is_simulated(self) -> bool:
        """Whether any snow slides, so that there are simulations."""
        return any(case.has_releases for case in self.cases)

    @cached_property
    def panel_snow(self) -> dict[int, PanelSnow]:
        """The snow on the panel in a mean winter, by month."""
        return mean_months([case.days for case in self.cases])

    @cached_property
    def grid_error(self) -> GridError:
        """The error of heights by the grid, from recorded runs of as many slide-offs."""
        case = self.cases[0]
        scene = case.panel_scene(self.heights[0]).data
        return recorded_grid_error(scene, case.cells_across, self.slide_offs)

    @cached_property
    def heights_by_probability(self) -> RequiredHeights:
        """The required height as a distribution with its uncertainty."""
        names = [case.winter.name for case in self.cases]
        return RequiredHeights(
            self.required,
            np.unique(names, return_inverse=True)[1].astype(float),
            self.ranges.positions([case.values for case in self.cases]),
            self.grid_error.size,
            self.shed_part,
            MARGIN + FLAT,
        )

    @property
    def levels(self) -> list[Level]:
        """The heights that stay clear in 50, 90 and 98 % of winters.

        The list is empty if fewer than two winters have snow.
        """
        return self.heights_by_probability.levels

    def at(self, probability: float) -> Level:
        """Return the height that stays clear with a probability of 0.5, 0.9 or 0.98 in a winter.

        Raises
        ------
        InputError
            If the probability is none of these, or fewer than two winters have snow.
        """
        levels = {level.probability: level for level in self.levels}
        if not levels:
            raise InputError(
                "probabilities need two winters with snow below the panel or more; here: "
                f"{self.snowy_winters}. ClearanceResult.highest is the height of the worst winter"
            )
        if probability not in levels:
            allowed = ", ".join(f"{value:g}" for value in levels)
            raise InputError(f"probability: {probability:g}; allowed: {allowed}")
        return levels[probability]

    @property
    def snowy_winters(self) -> int:
        """Number of winters with snow below the panel."""
        return self.heights_by_probability.snowy_winters

    @property
    def highest(self) -> tuple[float, float, float]:
        """The height that the worst winter of the record needed, and its 90 % interval, m."""
        return self.heights_by_probability.highest

    @property
    def shares(self) -> list[CauseShare]:
        """Causes of the width of the interval in the answer's sentence, the largest first."""
        return self.heights_by_probability.shares

    @property
    def worst_case_index(self) -> int:
        """Index of the case that needs the highest edge."""
        return int(np.argmax(self.required))

    def burial_probability(self, height: float) -> float:
        """Return the probability that snow reaches a lower edge at a height, m, in a winter.

        Raises
        ------
        InputError
            If fewer than two winters have snow.
        """
        burial = self.heights_by_probability.burial(height)
        if burial is None:
            raise InputError("fewer than two winters have snow: there is no probability of burial")
        return burial[0]

    def height_parts(self, index: int) -> HeightParts:
        """Return the parts of the required height of a case."""
        outcome = min(
            self.outcomes[index], key=lambda outcome: abs(outcome.height - self.required[index])
        )
        cover = max(min(outcome.cover, self.required[index] - MARGIN), 0.0)
        return HeightParts(cover, float(self.required[index]) - MARGIN - cover, MARGIN)

    @property
    def typical_case_index(self) -> int:
        """Index of the case nearest to the median, in another winter than the worst case."""
        worst = self.cases[self.worst_case_index].winter.name
        distances = np.abs(self.required - np.median(self.required))
        in_worst = np.array([case.winter.name == worst for case in self.cases])
        return int(np.argmin(np.where(in_worst, np.inf, distances)))

    @property
    def winters_text(self) -> str:
        """The number of winters behind the answer, such as "2 of 20 winters"."""
        number = len(self.winters)
        if self.winter_list is None or len(self.winter_list.winters) == number:
            return plural(number, "winter")
        if len(self.winter_list.counted) == number:
            return self.winter_list.counted_text
        return f"{number} of {plural(len(self.winter_list.winters), 'winter')}"

    def table(self) -> pd.DataFrame:
        """Return one row per case and simulated height."""
        import pandas as pd

        rows = []
        for number, (case, outcomes) in enumerate(zip(self.cases, self.outcomes), 1):
            for outcome in outcomes:
                contact = outcome.contact
                rows.append(
                    {
                        "slope_length_m": self.design.slope_length,
                        "tilt_deg": self.design.tilt,
                        "case": number,
                        "winter": case.winter.name,
                        **case.values,
                        "seed": case.seed,
                        "height_m": outcome.height,
                        "margin_m": outcome.margin,
                        "touched": int(contact is not None),
                        "first_contact": "" if contact is None else contact.date,
                        "cause": "" if contact is None else contact.cause,
                        "required_m": required_height(outcomes),
                    }
                )
        return pd.DataFrame(rows)


@checked
def required_clearance(
    design: PanelDesign,
    winters: Sequence[Winter],
    heights: Sequence[float],
    folder: PathLike,
    *,
    ranges: Optional[SnowRanges] = None,
    settings: Optional[SeasonSettings] = None,
    scene: Optional[Mapping[str, JsonValue]] = None,
    winter_list: Optional[WinterList] = None,
    jobs: Optional[int] = None,
    same_version: bool = False,
    progress: Optional[Reporter] = None,
) -> ClearanceResult:
    """Return the height of the lower edge that a panel needs.

    Parameters
    ----------
    design
        The panel.
    winters
        From `split_winters`.
    heights
        Candidates for the height of the lower edge above the ground, m.
    folder
        Folder of the store of runs; an interrupted answer resumes there.
    ranges
        Ranges of the uncertain snow parameters. [default: `SnowRanges()`]
    settings
        Settings of the seasons, except those that vary. [default: `SeasonSettings()`]
    scene
        Values of the scene by dotted path. Slabs and margin follow ``numerics.dx``.
    winter_list
        All winters of the file (`SeasonRecord.winters`), which the answer's text mentions.
    jobs
        Local processes at once. [default: the number of cores]
    same_version
        As for `Study.compute`.
    progress
        Called with a `Progress` a few times a second.

    Raises
    ------
    InputError
        If a height is outside the allowed range, or all runs failed.
    StudyError, StudyInterrupted
        As from `Study.compute`; the same call resumes.
    """
    ranges = ranges or SnowRanges()
    search = _search(design, winters, heights, ranges, settings, scene)
    own = settings is not None and settings.friction != SeasonSettings().friction
    if own and "friction" in ranges.spans:
        drawn = f"because {argument('ranges', option='range')} draw it"
        issue_note(f"`settings=`: its friction is not used, {drawn}")
    while search.undecided():
        runs = search.runs()
        compute_runs(
            folder, STUDY, [], list(runs.values()), jobs=jobs, same_version=same_version,
            progress=progress,
        )  # fmt: skip
        search.record_outcomes(read_table(folder, STUDY))
    complete = [number for number, outcomes in enumerate(search.outcomes) if outcomes]
    if not complete:
        raise InputError(f"{folder}: all runs failed; see its table")
    return ClearanceResult(
        design,
        search.heights,
        [search.cases[number] for number in complete],
        [sorted(search.outcomes[number], key=height_key) for number in complete],
        ranges,
        len(search.cases) - len(complete),
        list(dict.fromkeys(search.cases[number].winter.name for number in complete)),
        winter_list,
    )


def expected_duration(
    design: PanelDesign,
    winters: Sequence[Winter],
    heights: Sequence[float],
    *,
    ranges: Optional[SnowRanges] = None,
    settings: Optional[SeasonSettings] = None,
    scene: Optional[Mapping[str, Any]] = None,
    jobs: Optional[int] = None,
) -> tuple[float, int]:
    """Return the expected time of an answer, s, and its number of seasons.

    The parameters and the errors are those of `required_clearance`.
    """
    search = _search(design, winters, heights, ranges or SnowRanges(), settings, scene)
    scenes = [run.scene for run in search.runs().values()]
    seconds = duration_of_runs(scenes, jobs=jobs)[0] if scenes else 0.0
    return seconds * search.rounds, round(len(scenes) * search.rounds)


def _search(
    design: PanelDesign,
    winters: Sequence[Winter],
    heights: Sequence[float],
    ranges: SnowRanges,
    settings: Optional[SeasonSettings],
    scene: Optional[Mapping[str, JsonValue]],
) -> _Search:
    """Return the search of an answer, before any run.

    Raises
    ------
    InputError
        If a height is outside the allowed range, or the scene or the rows are wrong.
    """
    candidates = sorted(set(heights))
    if not candidates or not 0.0 < candidates[0] <= candidates[-1] <= 100.0:
        raise InputError(f"heights: {candidates}; needed: at least one from 0 to 100 m")
    check_base(scene or {})
    values = ranges.draw(len(winters))
    cases = cases_of(design, winters, values, settings or SeasonSettings(), scene or {})
    check_rows(design.rows, cases[0].panel_scene(candidates[0]).data)
    return _Search(cases, candidates)


class _Search:
    """Bisection for every case over the candidate heights."""

    def __init__(self, cases: Sequence[SeasonCase], heights: Sequence[float]) -> None:
        self.cases, self.heights = cases, heights
        self.outcomes: list[list[SeasonOutcome]] = [[] for _ in cases]
        self._low = [0] * len(cases)  # heights below are reached
        self._high = [len(heights)] * len(cases)  # heights from there on are clear
        self._runs: dict[tuple[int, int], Any] = {}

    @property
    def rounds(self) -> int:
        """Approximate number of simulations of each case."""
        return max(1, int(np.ceil(np.log2(len(self.heights) + 1) - 1e-9)))

    def undecided(self) -> list[tuple[int, int]]:
        """Return the undecided cases, each with the index of the height to simulate next."""
        return [
            (number, (low + high) // 2)
            for number, (low, high) in enumerate(zip(self._low, self._high))
            if low < high
        ]

    def runs(self) -> dict[tuple[int, int], Any]:
        """Return all runs so far, and those that are needed next."""
        for number, index in self.undecided():
            if self.cases[number].has_releases and (number, index) not in self._runs:
                self._runs[number, index] = self.cases[number].run_key(self.heights[index])
        return self._runs

    def record_outcomes(self, table: pd.DataFrame) -> None:
        """Read the outcomes of the runs, and halve the open intervals."""
        events = dict(tuple(table.groupby("hash"))) if len(table) else {}
        nothing = table.iloc[:0]
        for number, index in self.undecided():
            run = self._runs.get((number, index))
            rows = nothing if run is None else events.get(run.hash, nothing)
            case, height = self.cases[number], self.heights[index]
            failed = rows[rows["ended"] == "failed"]
            if snow_stays_on_a_row(case.design.rows, " ".join(failed["error"])):
                outcome = case.outcome_of_lying_snow(height)
            elif len(failed) or (run is not None and rows.empty):
                self._low[number] = self._high[number]  # left out
                self.outcomes[number] = []
                continue
            else:
                outcome = case.outcome(height, rows)
            self.outcomes[number].append(outcome)
            if outcome.contact is None:
                self._high[number] = index
            else:
                self._low[number] = index + 1
