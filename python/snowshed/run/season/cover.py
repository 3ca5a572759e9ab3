"""The natural snow cover on the ground during a season, on top of which the stack lies.

It is as deep as the season file says. Without a measured depth, it is a column of the season's
snowfalls that settles as the snow on the panel does, and melts in proportion to the degrees above
0 degrees C. Snow falls on the ground and on the stack alike, so that the cover's depth is added to
the stack's height.
"""

from __future__ import annotations

from collections.abc import Sequence

from snowshed.run.season.column import SnowColumn
from snowshed.run.season.settings import SeasonSettings
from snowshed.run.season.weather_row import Weather
from snowshed.snow.relations.new_snow import NEW_SNOW_DENSITY

DAY = 86400.0  # s
#: Melt, kg/m2 (mm of water) per day and degree above 0 degrees C: amid the values for snow that
#: Hock 2003, J. Hydrol. 282, 104-115, lists, which differ by a factor of four.
DEGREE_DAY_FACTOR = 4.0


def natural_cover(
    season: Sequence[Weather], settings: SeasonSettings, gravity: float = 9.81
) -> list[float]:
    """Return the depth of the natural snow cover at every row of a season, m.

    Parameters
    ----------
    season
        The rows, in order.
    settings
        Says where the depth comes from (`SeasonSettings.cover`), how snow settles, and the density
        of new snow.
    gravity
        m/s2.

    Examples
    --------
    >>> from datetime import datetime
    >>> rows = [Weather(2, datetime(2024, 12, 1), 0.4, 100.0, -4.0),
    ...         Weather(3, datetime(2024, 12, 2), 0.0, None, 3.0),
    ...         Weather(4, datetime(2024, 12, 4), 0.0, None, 3.0)]
    >>> [round(depth, 2) for depth in natural_cover(rows, SeasonSettings())]
    [0.4, 0.31, 0.1]
    """
    if settings.cover == "none":
        return [0.0] * len(season)
    if not isinstance(settings.cover, str):
        return [settings.cover] * len(season)
    snow = SnowColumn(load_factor=gravity)
    depths: list[float] = []
    measured = any(row.snow_depth is not None for row in season)
    for row, earlier in zip(season, [None, *season]):
        if measured:
            held = depths[-1] if depths else 0.0
            depths.append(held if row.snow_depth is None else row.snow_depth)
            continue
        if earlier is not None:
            elapsed = (row.date - earlier.date).total_seconds()
            snow.settle(settings.settling_law, elapsed, earlier.temperature)
            snow.melt(DEGREE_DAY_FACTOR * max(earlier.temperature, 0.0) * elapsed / DAY)
        if row.snowfall:
            density = row.density or NEW_SNOW_DENSITY[settings.density](row.temperature)
            snow.add(density * row.snowfall, density)
        depths.append(snow.thickness)
    return depths
