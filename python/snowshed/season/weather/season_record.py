"""The weather of a file: its rows, the assumptions made in reading, and its winters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Optional

from snowshed.base.arguments import checked
from snowshed.base.formatting import plural
from snowshed.season.weather.quality import COVERAGE, WinterQuality, qualities_of, spans
from snowshed.season.weather.row import Weather
from snowshed.season.weather.source import SnowSource
from snowshed.season.weather.winter_years import Calendar, SnowSeason, calendar_of


class ReadSeason(list[Weather]):
    """The rows of a season, and the notes that were issued when they were read.

    Examples
    --------
    >>> season = ReadSeason([], ["snow in warm air"])
    >>> len(season), season.notes
    (0, ('snow in warm air',))
    """

    def __init__(self, rows: Sequence[Weather], notes: Sequence[str]) -> None:
        super().__init__(rows)
        self.notes = tuple(notes)


@checked
@dataclass(frozen=True)
class SeasonRecord:
    """The weather of a season or of many winters.

    Attributes
    ----------
    rows
        Rows in order.
    notes
        Assumptions made in reading, a sentence each.
    latitude
        Latitude, degrees; if unknown, temperatures decide which half of the year is winter.
    sums
        Totals of the file's columns, m, by the year in which a winter begins.
    """

    rows: Sequence[Weather]
    notes: Sequence[str] = ()
    latitude: Optional[float] = None
    sums: Mapping[int, Mapping[SnowSource, float]] = field(default_factory=dict)

    @cached_property
    def calendar(self) -> Calendar:
        """Beginnings and names of the winters."""
        return calendar_of(self.rows, self.latitude)

    def winters(self, coverage: float = COVERAGE) -> WinterList:
        """Return the quality of each winter.

        Parameters
        ----------
        coverage
            Share of the days of the snow season on which snow must have been observed.

        Raises
        ------
        InputError
            If `coverage` is not a share.

        Examples
        --------
        >>> from snowshed.season.weather.generator import EXAMPLE_CLIMATE
        >>> rows = EXAMPLE_CLIMATE.winters(3, seed=1)
        >>> winters = SeasonRecord(rows[:500]).winters()
        >>> winters.counted_text, winters.excluded_text
        ('2 of 3 winters', '2003/04 (79 %)')
        """
        qualities, season = qualities_of(self.rows, self.calendar, coverage, self.sums)
        return WinterList(qualities, season, coverage)


@dataclass(frozen=True)
class WinterList:
    """The winters of a file, good and bad.

    Attributes
    ----------
    winters
        All winters, in order.
    season
        The months in which snow must have been observed.
    coverage
        Required share of observed days.
    """

    winters: Sequence[WinterQuality]
    season: SnowSeason
    coverage: float

    @property
    def counted(self) -> list[WinterQuality]:
        """The winters that count."""
        return [winter for winter in self.winters if winter.counts]

    @property
    def counted_text(self) -> str:
        """Number of winters that count, such as "2 of 20 winters"."""
        return f"{len(self.counted)} of {plural(len(self.winters), 'winter')}"

    @property
    def excluded_text(self) -> str:
        """The winters that do not count, by name, with the share of their days; may be empty."""
        return spans([(winter.name, _shortfall(winter)) for winter in self.winters])

    @property
    def notes(self) -> list[str]:
        """Notes on the winters that count, and on the others."""
        notes = []
        if self.excluded_text:
            notes.append(
                f"left out are the winters whose snow was observed on less than "
                f"{whole_percent(self.coverage)} of the days {self.season.text}: "
                f"{self.excluded_text}"
            )
        if any(winter.listed for winter in self.winters):
            notes.append(
                "the file lists snowfalls; its days without a row count as days without snow"
            )
        return notes

    @property
    def shortfalls(self) -> list[str]:
        """Notes on the winters with too few days of observed snow."""
        return [
            f"the snow of {winter.name} was observed on {winter.observed} of {winter.season} days "
            f"{self.season.text} ({whole_percent(winter.share)}); the snowfall of the others is "
            "unknown"
            for winter in self.winters
            if winter.rows and not winter.counts and SnowSource.GIVEN not in winter.sources
        ]

    def data(self) -> list[dict[str, object]]:
        """Return the winters as JSON data."""
        return [
            {
                "winter": winter.name,
                "days_of_snow_season": winter.season,
                "observed_days": winter.observed,
                "new_snow_m": round(winter.snowfall, 4),
                "days_by_source": {source.label: days for source, days in winter.sources.items()},
                "filled_snow_m": round(winter.filled_snow, 4),
                "sums_m": {source.label: round(total, 4) for source, total in winter.sums.items()},
                "counts": winter.counts,
            }
            for winter in self.winters
        ]


def _shortfall(winter: WinterQuality) -> Optional[str]:
    """Return why a winter does not count; None: it does."""
    if winter.counts:
        return None
    return whole_percent(winter.share) if winter.rows else "no rows"


def whole_percent(share: float) -> str:
    """Return a share in whole percent, rounded down."""
    return f"{int(100.0 * share + 1e-9)} %"
