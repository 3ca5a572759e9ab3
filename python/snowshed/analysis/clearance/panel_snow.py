"""Snow on a panel in a mean winter, month by month: covered days and blocked energy.

A panel counts as covered from a snowfall until its snow slides off or melts, and then produces
nothing.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Optional

from snowshed.season.accumulation import WinterDay
from snowshed.season.settings import DAY

#: Share of a month that must have an irradiance.
MEASURED = 0.9


@dataclass(frozen=True)
class PanelSnow:
    """The snow on a panel in a month of a mean winter.

    Attributes
    ----------
    days, covered_days
        Number of days of the record in the month, and of those with snow on the panel.
    blocked
        Share of the irradiation that falls on the covered panel, 0 to 1; None if less than nine
        tenths of the month have an irradiance.
    """

    days: float
    covered_days: float
    blocked: Optional[float]


def mean_months(seasons: Sequence[Sequence[WinterDay]]) -> dict[int, PanelSnow]:
    """Return the mean of several seasons by month, in the order of a winter.

    Months without snow on the panel are left out.

    Examples
    --------
    >>> from datetime import datetime
    >>> from snowshed.season import SeasonSettings, Weather, accumulate
    >>> falls = [(1, 0.1), (2, 0.0), (3, 0.0)]
    >>> rows = [Weather(day, datetime(2024, 1, day), fall, 100.0, -4.0) for day, fall in falls]
    >>> mean_months([accumulate(rows, SeasonSettings(adhesion=1e4), tilt=40.0)])
    {1: PanelSnow(days=3.0, covered_days=3.0, blocked=None)}
    """
    days: dict[int, float] = defaultdict(float)
    sunny: dict[int, float] = defaultdict(float)  # days with an irradiance
    covered: dict[int, float] = defaultdict(float)
    energy: dict[int, list[float]] = defaultdict(lambda: [0.0, 0.0])
    for season in seasons:
        for day, length in _lengths(season):
            month = day.weather.date.month
            is_covered = day.load > 0.0 and not day.released
            days[month] += length / len(seasons)
            covered[month] += is_covered * length / len(seasons)
            sunny[month] += (day.weather.irradiance is not None) * length / len(seasons)
            sun = max(day.weather.irradiance or 0.0, 0.0) * length
            energy[month][0] += sun
            energy[month][1] += is_covered * sun
    return {
        month: PanelSnow(
            round(days[month], 6),
            round(covered[month], 6),
            energy[month][1] / energy[month][0]
            if energy[month][0] and sunny[month] > MEASURED * days[month]
            else None,
        )
        for month in days
        if covered[month] > 0.0
    }


def _lengths(season: Sequence[WinterDay]) -> Iterable[tuple[WinterDay, float]]:
    """Yield the rows of a season, each with the days until the next."""
    length = 1.0
    for day, later in zip(season, [*season[1:], None]):
        if later is not None:
            length = (later.weather.date - day.weather.date).total_seconds() / DAY
        yield day, length
