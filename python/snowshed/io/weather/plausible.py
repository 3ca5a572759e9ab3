"""Plausibility of a station's units, judged from all its numbers together.

Single numbers beyond every record are refused during reading. Here the median of many numbers
reveals a column in another unit; single faults of a sensor hardly change it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from datetime import date
from statistics import fmean, median

from snowshed._core import InputError
from snowshed.io.weather.columns import WORDS
from snowshed.io.weather.observation import DAY, Observation, Station

MIN_VALUES = 5  # number of values whose median can reveal a unit
#: Largest plausible median of the daily change of the snow depth, m.
MAX_MEDIAN_CHANGE = 0.5
#: Largest plausible median of new snow, m.
MAX_MEDIAN_NEW_SNOW = 0.7
#: Smallest and largest plausible median of the air's temperature during snowfall, degrees C.
MIN_MEDIAN_TEMPERATURE, MAX_MEDIAN_TEMPERATURE = -40.0, 12.0
#: Smallest snowfall that is compared with temperatures, m.
MIN_SNOWFALL = 0.01
#: Smallest rise of the snow depth that is compared with temperatures, m.
MIN_RISE = 0.1
#: Largest plausible median of the amounts of a wet day, mm.
MAX_MEDIAN_WET_DAY = 100.0
#: Largest plausible median of the amounts of shorter times, mm.
MAX_MEDIAN_WET_HOURS = 50.0
#: The largest amount of rain measured in D hours is 491 D^0.452 mm (WMO 2009, Manual on Estimation
#: of Probable Maximum Precipitation, WMO-No. 1045).
MAX_RAIN, EXPONENT = 491.0, 0.452
#: Largest plausible density of new snow on cold days, kg/m3.
MAX_DENSITY = 600.0
#: Temperature below which a day is cold, degrees C.
COLD_DAY_LIMIT = -2.0
MAX_SHALLOW_DEPTH = 0.15  # m
#: Amounts that may stand for a missing value, mm, and how often one shows that it does.
MARKS_OF_GAUGES, MIN_MARKS = (99.9, 999.0, 999.9), 2
#: Largest new snow of a record that may be in m or inches, m. Boards show at least half a cm.
MAX_SMALL_NEW_SNOW = 0.005
#: Largest precipitation of a record that may be in m, mm. Gauges show at least a tenth of a mm.
MAX_SMALL_PRECIPITATION = 0.1


def with_plausible_units(station: Station, source: str) -> Station:
    """Return a station, with notes on doubtful units.

    Raises
    ------
    InputError
        If a column cannot be in the unit of its format; the message names the likely unit.
    """
    for check in (
        _check_marks,
        _check_depths,
        _check_new_snow,
        _check_rain,
        _check_temperatures,
        _check_density,
    ):
        check(station, source)
    notes = [*_shallow_snow_notes(station), *_small_amount_notes(station)]
    return replace(station, notes=[*station.notes, *notes]) if notes else station


def _refused(station: Station, source: str, name: str, what: str) -> InputError:
    title = station.columns.get(name, WORDS[name])
    return InputError(f"{source}, column {title}: {what}")


def _changes(rows: Sequence[Observation]) -> list[tuple[date, float]]:
    """Return the changes of the depth from day to day, without spikes: medians of three days."""
    by_day: dict[date, list[float]] = {}
    for row in rows:
        if row.snow_depth is not None:
            by_day.setdefault(row.time.date(), []).append(row.snow_depth)
    joints = {row.time.date() for row in rows if row.seam}
    days = sorted(by_day)
    raw = [median(by_day[day]) for day in days]
    depths = [median(raw[max(n - 1, 0) : n + 2]) for n in range(len(raw))]
    return [
        (days[n], depths[n] - depths[n - 1])
        for n in range(1, len(days))
        if (days[n] - days[n - 1]).days == 1 and joints.isdisjoint(days[n - 1 : n + 2])
    ]


def _check_marks(station: Station, source: str) -> None:
    """Refuse precipitation that repeats a number that programs write for a missing value."""
    for mark in MARKS_OF_GAUGES:
        rows = [row for row in station.rows if row.precipitation == mark]
        if len(rows) >= MIN_MARKS:
            raise _refused(
                station, source, "precipitation",
                f"{mark:g} mm occurs {len(rows)} times, first in line {rows[0].line}; if it stands "
                "for a missing value, leave such cells empty",
            )  # fmt: skip


def _check_depths(station: Station, source: str) -> None:
    changes = [abs(change) for _, change in _changes(station.rows) if abs(change) > 1e-6]
    if len(changes) >= MIN_VALUES and median(changes) > MAX_MEDIAN_CHANGE:
        raise _refused(
            station, source, "snow_depth",
            f"half of the changes of the snow depth from day to day are {median(changes):g} m "
            "and more; is it in cm, mm or inches?",
        )  # fmt: skip


def _check_new_snow(station: Station, source: str) -> None:
    falls = [row.snowfall for row in station.rows if row.snowfall]
    if len(falls) >= MIN_VALUES and median(falls) > MAX_MEDIAN_NEW_SNOW:
        raise _refused(
            station, source, "snowfall",
            f"half of the snowfalls are {median(falls):g} m and more; is it in cm, mm or "
            "inches?",
        )  # fmt: skip


def _check_rain(station: Station, source: str) -> None:
    amounts: dict[bool, list[float]] = {True: [], False: []}
    for row in station.rows:
        if not row.precipitation:
            continue
        hours = row.precipitation_hours or DAY
        most = MAX_RAIN * max(hours, 0.1) ** EXPONENT
        if row.precipitation > most:
            raise InputError(
                f"{source}, line {row.line}, column "
                f"{station.columns.get('precipitation', 'precipitation')}: {row.precipitation:g} "
                f"mm in {hours:.3g} hours; no more than {most:.0f} mm was ever measured; is it in "
                "tenths of mm, or a counter?"
            )
        amounts[hours >= DAY].append(row.precipitation)
    for long, most in ((True, MAX_MEDIAN_WET_DAY), (False, MAX_MEDIAN_WET_HOURS)):
        if len(amounts[long]) >= MIN_VALUES and median(amounts[long]) > most:
            raise _refused(
                station, source, "precipitation",
                f"half of the amounts are {median(amounts[long]):g} mm and more; is it in "
                "tenths or hundredths of mm, or the sum of many hours?",
            )  # fmt: skip


def _check_temperatures(station: Station, source: str) -> None:
    rises = {day for day, change in _changes(station.rows) if change >= MIN_RISE}
    by_day: dict[date, list[float]] = {}
    snowy = []
    for row in station.rows:
        if row.temperature is None:
            continue
        if row.time.date() in rises:
            by_day.setdefault(row.time.date(), []).append(row.temperature)
        elif (row.snowfall or 0.0) >= MIN_SNOWFALL:
            snowy.append(row.temperature)
    snowy += [fmean(own) for own in by_day.values()]
    if len(snowy) < MIN_VALUES or MIN_MEDIAN_TEMPERATURE <= median(snowy) <= MAX_MEDIAN_TEMPERATURE:
        return
    unit = "degrees F" if median(snowy) > MAX_MEDIAN_TEMPERATURE else "tenths of degrees C"
    raise _refused(
        station, source, "temperature",
        f"half of the snow fell at {median(snowy):.3g} °C and "
        f"{'more' if median(snowy) > MAX_MEDIAN_TEMPERATURE else 'less'}; is it in {unit}?",
    )  # fmt: skip


def _check_density(station: Station, source: str) -> None:
    cold = [
        row
        for row in station.rows
        if row.snowfall
        and row.precipitation
        and row.snowfall_hours == row.precipitation_hours
        and row.temperature is not None
        and row.temperature < COLD_DAY_LIMIT
    ]
    water = sum(row.precipitation or 0.0 for row in cold)
    snow = sum(row.snowfall or 0.0 for row in cold)
    if len(cold) >= MIN_VALUES and water > MAX_DENSITY * snow:
        raise _refused(
            station, source, "precipitation",
            f"{water:.4g} mm of water fell as {snow:.3g} m of new snow below "
            f"{COLD_DAY_LIMIT:g} °C, of "
            f"{water / snow:.0f} kg/m3; is the water in mm, the snow in cm, or one of them wrong?",
        )  # fmt: skip


def _shallow_snow_notes(station: Station) -> list[str]:
    depths = [row.snow_depth for row in station.rows if row.snow_depth]
    broken = [depth for depth in depths if abs(1000.0 * depth - round(1000.0 * depth)) > 1e-3]
    if len(depths) < MIN_VALUES or max(depths) > MAX_SHALLOW_DEPTH or 2 * len(broken) < len(depths):
        return []
    title = station.columns.get("snow_depth", WORDS["snow_depth"])
    return [
        f"{title} never exceeds {100.0 * max(depths):.3g} cm, with parts of a millimetre; check "
        "that it is not in m"
    ]


def _small_amount_notes(station: Station) -> list[str]:
    """Return notes on amounts that are all too small for the unit of their column."""
    cases = (
        ("snowfall", MAX_SMALL_NEW_SNOW, 100.0, "cm"),
        ("precipitation", MAX_SMALL_PRECIPITATION, 1.0, "mm"),
    )
    notes = []
    for name, most, factor, unit in cases:
        amounts = [getattr(row, name) for row in station.rows if getattr(row, name)]
        if len(amounts) >= MIN_VALUES and max(amounts) < most:
            title = station.columns.get(name, WORDS[name])
            notes.append(
                f"{title} never exceeds {factor * max(amounts):.3g} {unit}, although "
                f"{len(amounts)} values are not 0; check that it is not in m"
            )
    return notes
