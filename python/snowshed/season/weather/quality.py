"""The quality of a winter's snow data: the share of observed days, and their sources.

A winter counts if its snow was observed on a given share of the days of the station's snow season.
Days in gaps, and filled days, do not count as observed. In a season file that only lists snowfalls,
days without a row count as days without snow.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date, timedelta
from typing import Optional

from snowshed._core import InputError
from snowshed.base.formatting import plural
from snowshed.io.weather.plain import LIST_SPACING_HOURS
from snowshed.season.weather.row import Weather
from snowshed.season.weather.source import SnowSource
from snowshed.season.weather.winter_years import Calendar, SnowSeason, snow_season_of

COVERAGE = 0.9  # share of the days of the snow season on which snow must have been observed
MAX_GAP_DAYS = 120  # days between two rows of a winter; longer spans are summers
MAX_ROW_GAP_DAYS = 3  # days between two rows of a table, covered by the later row
LIST_SPACING = timedelta(hours=LIST_SPACING_HOURS)


@dataclass(frozen=True)
class WinterQuality:
    """The quality of the snow data of a winter.

    Attributes
    ----------
    name
        Name, such as "2001/02", or "2001" in the south.
    rows
        Rows of the winter, in order; empty if the file has none.
    season
        The days that should be observed: those of the snow season.
    observed
        Number of days of the snow season with observed snow.
    sources
        Number of days by source, over the whole winter.
    filled_snow
        Depth of the snow that was filled, m.
    counts
        Whether the snow was observed on enough days.
    listed
        Whether the file lists snowfalls and omits other days.
    sums
        Totals of the file's columns on comparable days, m.
    """

    name: str
    rows: Sequence[Weather]
    season: int
    observed: int
    sources: Counter[SnowSource]
    filled_snow: float
    counts: bool
    listed: bool = False
    sums: Mapping[SnowSource, float] = field(default_factory=dict)

    @property
    def share(self) -> float:
        """Part of the days of the snow season on which snow was observed, 0 to 1."""
        return self.observed / self.season

    @property
    def snowfall(self) -> float:
        """Depth of all new snow of the winter, m."""
        return sum(row.snowfall for row in self.rows)

    @property
    def source_text(self) -> str:
        """Sources of its snow, the most frequent source first."""
        observing = [
            source.label
            for source, _ in Counter(self.sources).most_common()
            if source.observed and self.sources[source]
        ]
        return ", ".join(observing)


def check_coverage(coverage: float) -> float:
    """Return a share of days; raises InputError if it is not a share."""
    if not 0.0 <= coverage <= 1.0:
        raise InputError(f"coverage: {coverage:g}; allowed: a share from 0 to 1 (or 0 to 100 %)")
    return coverage


def qualities_of(
    rows: Sequence[Weather],
    calendar: Calendar,
    coverage: float = COVERAGE,
    sums: Optional[Mapping[int, Mapping[SnowSource, float]]] = None,
) -> tuple[list[WinterQuality], SnowSeason]:
    """Return the quality of each winter from the first to the last row, and the snow season.

    Parameters
    ----------
    rows
        The weather, in order.
    calendar
        The winters of the place.
    coverage
        Share of the days of the snow season on which snow must have been observed.
    sums
        Totals of the file's columns, m, by the year in which a winter begins.

    Examples
    --------
    >>> from snowshed.season.weather.generator import EXAMPLE_CLIMATE
    >>> winters, season = qualities_of(EXAMPLE_CLIMATE.winters(2, seed=1), Calendar())
    >>> [(winter.name, winter.observed, winter.counts) for winter in winters], season.text
    ([('2001/02', 165, True), ('2002/03', 165, True)], 'from 7 November to 20 April')
    """
    check_coverage(coverage)
    season = snow_season_of(rows, calendar)
    listed = is_list(rows)
    by_year: dict[int, list[Weather]] = {}
    for row in rows:
        by_year.setdefault(calendar.year(row.date.date()), []).append(row)
    qualities = []
    for year in range(min(by_year), max(by_year) + 1):
        own = by_year.get(year, [])
        begin, after = season.span(year)
        days = (after - begin).days
        seen = days if listed and own else observed_days(own, begin, after)
        qualities.append(
            WinterQuality(
                calendar.name(year),
                own,
                days,
                seen,
                Counter(row.source for row in own),
                sum(row.snowfall for row in own if row.source is SnowSource.FILLED),
                bool(own) and seen >= coverage * days,
                listed,
                (sums or {}).get(year, {}),
            )
        )
    return qualities, season


def is_list(rows: Sequence[Weather]) -> bool:
    """Return whether rows are a list of snowfalls: most lie more than a day apart."""
    if len(rows) < 2 or any(row.source is not SnowSource.GIVEN for row in rows):
        return False
    spans = [later.date - earlier.date for earlier, later in zip(rows, rows[1:])]
    return sorted(spans)[len(spans) // 2] > LIST_SPACING


def gap_notes(rows: Sequence[Weather]) -> list[str]:
    """Return a note on the days that a table of every day or hour lacks; none for a list.

    Longer spans, such as summers between winters, are no gaps.

    Examples
    --------
    >>> from datetime import datetime
    >>> rows = [Weather(2, datetime(2024, 12, day), 0.1, None, -5.0) for day in (1, 2, 3, 6)]
    >>> gap_notes(rows)
    ['no rows on 2 days in 1 gap, from 2024-12-04 to 2024-12-05: no snow is assumed there']
    """
    days = sorted({row.date.date() for row in rows})
    if is_list(rows) or any(row.source is not SnowSource.GIVEN for row in rows):
        return []
    gaps = [
        (earlier + timedelta(1), later - timedelta(1), (later - earlier).days - 1)
        for earlier, later in zip(days, days[1:])
        if 1 < (later - earlier).days <= MAX_GAP_DAYS
    ]
    if not gaps:
        return []
    first, last, _ = max(gaps, key=lambda gap: gap[2])
    where = "1 gap, " if len(gaps) == 1 else f"{len(gaps)} gaps, the longest "
    missing = plural(sum(days for *_, days in gaps), "day")
    return [f"no rows on {missing} in {where}from {first} to {last}: no snow is assumed there"]


def observed_days(rows: Sequence[Weather], begin: date, after: date) -> int:
    """Return the number of days with observed snow from the first date to before the second."""
    days = sorted({row.date.date().toordinal() for row in rows if row.source.observed})
    first, last = begin.toordinal(), after.toordinal()
    number = sum(first <= day < last for day in days)
    if any(row.source is not SnowSource.GIVEN for row in rows):
        return number
    for earlier, later in zip(days, days[1:]):
        if later - earlier - 1 <= MAX_ROW_GAP_DAYS:
            number += max(min(later, last) - max(earlier + 1, first), 0)
    return number


def spans(named: Sequence[tuple[str, Optional[str]]]) -> str:
    """Return winters with a text for each; neighbours with the same text are joined.

    Parameters
    ----------
    named
        All winters in order: the name of each, and its text, if any.

    Examples
    --------
    >>> spans([("1990/91", "40 %"), ("1991/92", "0 %"), ("1992/93", "0 %"), ("1993/94", None)])
    '1990/91 (40 %), 1991/92 to 1992/93 (0 %)'
    """
    groups: list[list[str]] = []
    before: Optional[str] = None
    for name, text in named:
        if text is not None and text == before:
            groups[-1][1] = name
        elif text is not None:
            groups.append([name, name, text])
        before = text
    return ", ".join(
        f"{first} ({text})" if first == last else f"{first} to {last} ({text})"
        for first, last, text in groups
    )
