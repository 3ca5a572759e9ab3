"""Accumulation of snow on a panel, row after row of the season file, until it is released."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Optional

from snowshed.base.arguments import checked
from snowshed.base.notes import InputNote, issue_note
from snowshed.running.ageing.ageing import Ageing, Interval
from snowshed.season.release import SnowBalance, snow_balance
from snowshed.season.settings import SeasonSettings
from snowshed.season.settling_column import SnowColumn
from snowshed.season.weather.checks import check_given_rows, check_one_season, warm_snow
from snowshed.season.weather.row import Weather
from snowshed.season.weather.season_record import ReadSeason
from snowshed.snow.relations.new_snow import NEW_SNOW_DENSITY


@dataclass(frozen=True)
class WinterDay:
    """The snow on the panel at one row of the season file.

    Attributes
    ----------
    weather
        The row.
    density
        Density of the row's snowfall, kg/m3, measured or estimated; None without snowfall.
    load, thickness
        Mass of the snow on the panel after the snowfall, kg per m2 of the panel, and its thickness
        normal to the panel, m.
    balance
        Driving and resisting stress of this snow.
    released
        Whether the snow was released.
    event
        Number of the slide-off that follows, from 1; None if the snow stayed, or waits for later
        releases (`SeasonSettings.pool_below`).
    slab_load, slab_thickness
        Load and thickness of the slab that slides, in the units of `load` and `thickness`.
    """

    weather: Weather
    density: Optional[float]
    load: float
    thickness: float
    balance: SnowBalance
    released: bool = False
    event: Optional[int] = None
    slab_load: float = 0.0
    slab_thickness: float = 0.0


@checked
def accumulate(
    season: Sequence[Weather], settings: SeasonSettings, tilt: float, gravity: float = 9.81
) -> list[WinterDay]:
    """Return the snow on a panel at every row of a season.

    Snow of a depth h on level ground has the thickness h cos(Phi) normal to the panel, because its
    mass per area of the ground is the same. All snow is released at once (`snow_balance`). It melts
    by degree-days (`SeasonSettings.melt`). Wind is left out. A note tells of snowfalls in warm air,
    unless `read_season` has told of them.

    Parameters
    ----------
    season
        The rows, in order.
    settings
        The settings of accumulation and release.
    tilt
        Phi, the tilt of the panel, degrees.
    gravity
        Gravity, m/s2.

    Raises
    ------
    InputError
        If a row cannot be weather, more than a year passes from one row to the next, or the tilt
        is not that of a panel.

    Examples
    --------
    >>> from datetime import datetime
    >>> row = Weather(2, datetime(2024, 12, 1), 0.2, 100.0, -4.0)
    >>> day, = accumulate([row], SeasonSettings(adhesion=50.0), tilt=60.0)
    >>> round(day.load), round(day.balance.driving), round(day.balance.resisting), day.event
    (10, 85, 84, 1)
    """
    earlier = season.notes if isinstance(season, ReadSeason) else ()
    for note in warm_snow(check_given_rows(season)):
        if note not in earlier:
            issue_note(note, InputNote)
    return snow_on_panel(season, settings, tilt, gravity)


def snow_on_panel(
    season: Sequence[Weather], settings: SeasonSettings, tilt: float, gravity: float = 9.81
) -> list[WinterDay]:
    """Return what `accumulate` returns, for rows that were read and so checked and noted."""
    check_one_season(season)
    slope = math.cos(math.radians(tilt)) if tilt < 90.0 else 0.0  # nothing lies on a fence
    snow = SnowColumn(load_factor=gravity * slope)
    days: list[WinterDay] = []
    for row, earlier in zip(season, [None, *season]):
        if earlier is not None:
            elapsed = (row.date - earlier.date).total_seconds()
            snow.settle(settings.settling_law, elapsed, earlier.temperature)
            snow.melt(settings.melt(earlier.temperature, elapsed))
        density = _density(row, settings)
        if density is not None:
            snow.add(settings.catch * density * row.snowfall * slope, density)
        held = _balance(row, settings, snow.mass, tilt, gravity)
        days.append(WinterDay(row, density, snow.mass, snow.thickness, held, held.releases))
        if held.releases:
            snow.clear()
    return _slide_offs(days, settings.pool_below)


def _slide_offs(days: Sequence[WinterDay], pool_below: float) -> list[WinterDay]:
    """Return the days with their slide-offs.

    Thin releases wait until they make a slab together; the rest slides after the last row.
    """
    releases = [number for number, day in enumerate(days) if day.released]
    numbered = list(days)
    event, load, thickness = 0, 0.0, 0.0
    for number in releases:
        load, thickness = load + days[number].load, thickness + days[number].thickness
        if thickness >= pool_below or number == releases[-1]:
            event += 1
            numbered[number] = replace(
                days[number], event=event, slab_load=load, slab_thickness=thickness
            )
            load, thickness = 0.0, 0.0
    return numbered


def pauses(days: Sequence[WinterDay]) -> dict[int, list[Interval]]:
    """Return the time between each event and the one before, for every event but the first.

    The temperature of a row of the season file holds until the next row.
    """
    intervals: dict[int, list[Interval]] = {}
    waiting: Optional[list[Interval]] = None
    for day, earlier in zip(days, [None, *days]):
        if earlier is not None and waiting is not None:
            elapsed = (day.weather.date - earlier.weather.date).total_seconds()
            waiting.append(Interval(elapsed, earlier.weather.temperature))
        if day.event is not None:
            if waiting is not None:
                intervals[day.event] = waiting
            waiting = []
    return intervals


def stack_ageing(days: Sequence[WinterDay], settings: SeasonSettings) -> Optional[Ageing]:
    """Return the ageing of the stack between the events of a season; None without ageing."""
    return settings.ageing(pauses(days)) if settings.ages else None


def _density(row: Weather, settings: SeasonSettings) -> Optional[float]:
    if not row.snowfall:
        return None
    if row.density is not None:
        return row.density
    relation = NEW_SNOW_DENSITY[settings.density]
    return relation(row.temperature)


def _balance(
    row: Weather, settings: SeasonSettings, load: float, tilt: float, gravity: float
) -> SnowBalance:
    friction = settings.friction if row.friction is None else row.friction
    wet = settings.is_wet(row.temperature, row.irradiance or 0.0)
    usual = 0.0 if wet else settings.adhesion
    adhesion = usual if row.adhesion is None else row.adhesion
    return snow_balance(load, tilt, friction, adhesion, gravity)
