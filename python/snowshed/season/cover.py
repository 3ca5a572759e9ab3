"""The natural snow cover on the ground during a season, below the stack.

Its depth comes from the season file, with straight lines between readings. Before the first
reading, in gaps of more than two months, and after the last reading, the cover is a column of the
season's snowfalls. This column settles by the law of settling, melts in proportion to the degrees
above 0 degrees C, and after readings begins with the depth of the last one. Snow falls on the
ground and on the stack alike; therefore the cover's depth is added to the stack's height.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Optional

from snowshed.base.arguments import checked
from snowshed.season.settings import DAY, SeasonSettings
from snowshed.season.settling_column import SnowColumn
from snowshed.season.weather.checks import check_given_rows
from snowshed.season.weather.row import Weather
from snowshed.snow.relations.new_snow import NEW_SNOW_DENSITY

#: Longest time between two readings that are joined by a straight line, days.
MAX_INTERPOLATED_DAYS = 61
#: Density, kg/m3, of a cover of known depth only, in the middle of the bulk densities of seasonal
#: snow of Sturm et al. 2010, J. Hydrometeorol. 11, 1380-1394 (217 to 373 kg/m3, by climate class).
COVER_DENSITY = 300.0


@checked
def natural_cover(
    season: Sequence[Weather], settings: SeasonSettings, gravity: float = 9.81
) -> list[float]:
    """Return the depth of the natural snow cover at every row of a season, m.

    Parameters
    ----------
    season
        The rows, in order.
    settings
        Settings: source of the depth (`SeasonSettings.cover`), law of settling, and density of new
        snow.
    gravity
        Gravity, m/s2.

    Raises
    ------
    InputError
        If a row cannot be weather.

    Examples
    --------
    >>> from datetime import datetime
    >>> rows = [Weather(2, datetime(2024, 12, 1), 0.4, 100.0, -4.0),
    ...         Weather(3, datetime(2024, 12, 2), 0.0, None, 3.0),
    ...         Weather(4, datetime(2024, 12, 4), 0.0, None, 3.0)]
    >>> [round(depth, 2) for depth in natural_cover(rows, SeasonSettings())]
    [0.4, 0.31, 0.1]
    """
    return cover_depths(check_given_rows(season), settings, gravity)


def cover_depths(
    season: Sequence[Weather], settings: SeasonSettings, gravity: float
) -> list[float]:
    """Return what `natural_cover` returns, for rows that were read and so checked."""
    if settings.cover == "none":
        return [0.0] * len(season)
    if not isinstance(settings.cover, str):
        return [settings.cover] * len(season)
    measured = _measured_depths(season)
    snow = SnowColumn(load_factor=gravity)
    depths: list[float] = []
    for row, earlier, depth in zip(season, [None, *season], measured):
        if depth is not None:
            snow.clear()
            snow.add(depth * COVER_DENSITY, COVER_DENSITY)
            depths.append(depth)
            continue
        if earlier is not None:
            elapsed = (row.date - earlier.date).total_seconds()
            snow.settle(settings.settling_law, elapsed, earlier.temperature)
            snow.melt(settings.melt(earlier.temperature, elapsed))
        if row.snowfall:
            density = row.density or NEW_SNOW_DENSITY[settings.density](row.temperature)
            snow.add(density * row.snowfall, density)
        depths.append(snow.thickness)
    return depths


def end_of_readings(season: Sequence[Weather]) -> Optional[Weather]:
    """Return the row of the last reading of the depth if snow remains on the ground.

    Examples
    --------
    >>> from datetime import datetime
    >>> rows = [Weather(2, datetime(2024, 3, 1), 0.0, None, -4.0, snow_depth=0.6),
    ...         Weather(3, datetime(2024, 3, 2), 0.0, None, -4.0)]
    >>> end_of_readings(rows).line
    2
    """
    readings = [number for number, row in enumerate(season) if row.snow_depth is not None]
    if not readings or readings[-1] == len(season) - 1:
        return None
    last = season[readings[-1]]
    return last if last.snow_depth else None


def _measured_depths(season: Sequence[Weather]) -> list[Optional[float]]:
    """Return the depth at each row from readings, m; None in long gaps and outside the readings."""
    depths: list[Optional[float]] = [row.snow_depth for row in season]
    readings = [number for number, row in enumerate(season) if row.snow_depth is not None]
    for before, after in zip(readings, readings[1:]):
        first, last = season[before], season[after]
        span = (last.date - first.date).total_seconds()
        if after == before + 1 or span > MAX_INTERPOLATED_DAYS * DAY:
            continue
        low, high = first.snow_depth or 0.0, last.snow_depth or 0.0
        for number in range(before + 1, after):
            part = (season[number].date - first.date).total_seconds() / span
            depths[number] = low + part * (high - low)
    return depths
