"""Plausibility of the rows of seasons: order, gaps, and amounts of snow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import date, datetime
from statistics import median

from snowshed._core import InputError
from snowshed.base.field_type import shown
from snowshed.base.formatting import plural
from snowshed.base.limits import MAX_WEATHER_GAP_DAYS
from snowshed.io.csv_table import TableRow
from snowshed.io.weather.clock import backwards
from snowshed.season.weather.columns import COLUMN_OF, COLUMNS, MAX_SNOWFALL
from snowshed.season.weather.extremes import RECORD_DAY, RECORD_WINTER, RECORD_WORDS
from snowshed.season.weather.row import Weather
from snowshed.season.weather.source import SnowSource

MAX_ROWS = 100_000  # daily data of the longest records, and hourly seasons
#: Median above which snowfalls cannot be in metres.
TYPICAL_SNOWFALL = 0.7  # m
DAY = 86400.0  # s
YEAR = 366.0  # days
YEARS = (1000, 9000)  # of measured or synthetic weather
#: Largest number of isolated rows that show a mistyped year.
MAX_LONE_ROWS = 3
#: Smallest gap between such rows and the others, days.
MIN_LONE_GAP_DAYS = 3 * YEAR
#: Temperature of a row, degrees C, at which no snow falls. It is well above that of all rain
#: (`gauge.ALL_RAIN`), because the mean of a day is not the temperature of its snowfall.
TOO_WARM_FOR_SNOW = 10.0
#: Median temperature of at least so many snowfalls, degrees C, at which most precipitation is rain.
MILD_FOR_SNOW, MIN_SNOWFALLS = 5.0, 5
NO_SNOW = "it never snows"
#: Usual friction of panels, and adhesion to them, Pa. Other numbers than 0 are noted.
USUAL = {"friction": (0.01, 2.0), "adhesion": (0.2, 1e4)}
HINT = "is it in cm, mm or inches?"


def check_rows(
    rows: Sequence[Weather], table_rows: Sequence[TableRow], name: str, *, snowless: bool = False
) -> None:
    """Raise InputError if rows cannot be the weather of seasons.

    Parameters
    ----------
    rows
        The weather.
    table_rows
        Position of each row, for messages.
    name
        The file.
    snowless
        Whether the file may have no snow, because a station may observe a winter without snow.
    """
    if not rows:
        raise InputError(f"{name}: no rows below the header")
    if len(rows) > MAX_ROWS:
        raise InputError(f"{name}: {len(rows)} rows; at most {MAX_ROWS} are allowed")
    for earlier, later, before, row in zip(rows, rows[1:], table_rows, table_rows[1:]):
        if later.date <= earlier.date:
            raise InputError(
                f"{row.where}, column date: {later.date.isoformat(' ')} is not after "
                f"{before.place}, {earlier.date.isoformat(' ')}"
                f"{backwards(rows[0].date, rows[-1].date)}"
            )
    _check_years(rows, table_rows)
    _check_amounts(rows, table_rows, name)
    if not snowless and not any(row.snowfall for row in rows):
        raise InputError(f"{name}: {NO_SNOW}; the snowfall of every row is 0")


def check_given_rows(
    rows: Sequence[object], name: str = "the season", *, ordered: bool = True
) -> list[Weather]:
    """Return rows made by hand; raises InputError if they cannot be the weather of seasons.

    Each row has checked its own values; their order and sums are checked here.

    Parameters
    ----------
    rows
        The rows; they may have no snow.
    name
        The argument, for messages.
    ordered
        Whether the rows are a season, in order.

    Examples
    --------
    >>> rows = [Weather(2, datetime(2024, 12, day), 0.1, None, -4.0) for day in (1, 3, 2)]
    >>> check_given_rows(rows)
    Traceback (most recent call last):
    snowshed._core.InputError: the season, row 3, column date: 2024-12-02 00:00:00 is not after \
row 2, 2024-12-03 00:00:00
    """
    weather: list[Weather] = []
    for number, row in enumerate(rows, 1):
        if not isinstance(row, Weather):
            raise InputError(f"{name}, row {number}: {shown(row)}; needed: Weather")
        weather.append(row)
    if ordered:
        positions = [
            TableRow(name, f"row {number}", number, {}) for number in range(1, len(rows) + 1)
        ]
        check_rows(weather, positions, name, snowless=True)
    return weather


def warm_snow(rows: Sequence[Weather]) -> list[str]:
    """Return a note if snow falls in air that is too warm for it.

    Examples
    --------
    >>> warm_snow([Weather(2, datetime(2024, 12, 1), 0.1, None, 25.0)])[0][:62]
    '1 snowfall in air of 10 °C and more, the warmest 25 °C on 2024'
    """
    warm = [row for row in rows if _is_warm_snow(row)]
    if not warm:
        return _mild_snow([row.temperature for row in rows if row.snowfall])
    warmest = max(warm, key=lambda row: row.temperature)
    return [
        f"{plural(len(warm), 'snowfall')} in air of {TOO_WARM_FOR_SNOW:g} °C and more, the warmest "
        f"{warmest.temperature:g} °C on {warmest.date.date()}, where precipitation is rain; are "
        "temperatures in degrees F, or sums of water in the column of snow?"
    ]


def unusual_numbers(rows: Sequence[Weather]) -> list[str]:
    """Return a note for each column of the panel whose numbers are unusual for its unit.

    Examples
    --------
    >>> unusual_numbers([Weather(2, datetime(2024, 12, 1), 0.1, None, -4.0, None, 0.05)])
    ['column adhesion_pa: 1 number beyond the usual 0.2 to 10000 Pa, such as 0.05; check its unit']
    """
    notes = []
    for field, (low, high) in USUAL.items():
        column = COLUMN_OF[field]
        values = [value for row in rows if (value := getattr(row, field))]
        unusual = [value for value in values if not low <= value <= high]
        if unusual:
            usual = f"{low:g} to {high:g} {COLUMNS[column].unit}".rstrip()
            notes.append(
                f"column {column}: {plural(len(unusual), 'number')} beyond the usual {usual}, such "
                f"as {unusual[0]:g}; check its unit"
            )
    return notes


def _mild_snow(temperatures: Sequence[float]) -> list[str]:
    """Return a note if half of the snow falls in air in which precipitation is usually rain."""
    if len(temperatures) < MIN_SNOWFALLS or median(temperatures) < MILD_FOR_SNOW:
        return []
    return [
        f"half of {len(temperatures)} snowfalls in air of {median(temperatures):g} °C and more, "
        "where precipitation is usually rain; are temperatures in degrees F?"
    ]


def _is_warm_snow(row: Weather) -> bool:
    return row.snowfall > 0.0 and row.temperature >= TOO_WARM_FOR_SNOW


def check_one_season(rows: Sequence[Weather]) -> None:
    """Raise InputError if more than a year passes between two rows of a season.

    Examples
    --------
    >>> rows = [Weather(2, datetime(year, 1, 1), 0.1, None, -5.0) for year in (2021, 2024)]
    >>> check_one_season(rows[:1])
    >>> try:
    ...     check_one_season(rows)
    ... except InputError as error:
    ...     print(str(error)[:62])
    the season, line 2, column date: 2024-01-01 is 1095 days after
    """
    for earlier, later in zip(rows, rows[1:]):
        days = _days(earlier, later)
        if days > YEAR:
            raise InputError(
                f"the season, line {later.line}, column date: {later.date.date()} is {days:.0f} "
                f"days after {earlier.date.date()} (line {earlier.line}); a season is one winter, "
                "and snow lies no longer; is a year mistyped?"
            )


def _days(earlier: Weather, later: Weather) -> float:
    return (later.date - earlier.date).total_seconds() / DAY


def _check_years(rows: Sequence[Weather], table_rows: Sequence[TableRow]) -> None:
    """Refuse implausible years, gaps of decades, and isolated years."""
    for number, (earlier, later) in enumerate(zip(rows, rows[1:]), 1):
        days = _days(earlier, later)
        if days <= YEAR:
            continue
        few = min(number, len(rows) - number) <= MAX_LONE_ROWS
        if days > MAX_WEATHER_GAP_DAYS or (
            few and days > MIN_LONE_GAP_DAYS and later.source is SnowSource.GIVEN
        ):
            raise InputError(
                f"{table_rows[number].where}, column date: {later.date.date()} is "
                f"{days / 365.25:.0f} "
                f"years after {table_rows[number - 1].place}, {earlier.date.date()}; is a year "
                "mistyped?"
            )
    for row, place in ((rows[0], table_rows[0]), (rows[-1], table_rows[-1])):
        if not YEARS[0] <= row.date.year <= YEARS[1]:
            raise InputError(
                f"{place.where}, column date: {row.date.date()}; allowed: the years {YEARS[0]} to "
                f"{YEARS[1]}; is a year mistyped?"
            )


def _check_amounts(rows: Sequence[Weather], table_rows: Sequence[TableRow], name: str) -> None:
    """Refuse amounts of a day or of a winter beyond the records."""
    falls = _daily_sums(rows)
    for day, (total, first) in falls.items():
        daily = first > 0 and (rows[first].date - rows[first - 1].date).total_seconds() <= DAY
        single = first + 1 == len(rows) or rows[first + 1].date.date() != day.date()
        # a single row may be the snow of several days
        most = RECORD_DAY if daily or not single else MAX_SNOWFALL
        if total > most:
            raise InputError(
                f"{table_rows[first].where}, column snowfall_m: {total:.3g} m of snow on "
                f"{day.date()}; "
                f"{RECORD_WORDS}; {HINT}"
            )
    totals = sorted(total for total, _ in falls.values() if total)
    if not totals:
        return
    middle = totals[len(totals) // 2]
    if len(totals) >= 3 and middle > TYPICAL_SNOWFALL:
        raise InputError(
            f"{name}, column snowfall_m: half of the snowfalls are {middle:g} m and more; {HINT}"
        )
    for begin, total in _yearly_sums(falls).items():
        if total > RECORD_WINTER:
            raise InputError(
                f"{name}, column snowfall_m: {total:.3g} m of snow in the year from {begin}; no "
                f"winter had more than {RECORD_WINTER:g} m (Leffler et al. 2001); {HINT}"
            )


def _yearly_sums(falls: Mapping[datetime, tuple[float, int]]) -> dict[date, float]:
    """Return the snow of each year from January and from July, m, by its first day."""
    sums: dict[date, float] = {}
    for day, (total, _) in falls.items():
        for begin in (date(day.year, 1, 1), date(day.year - (day.month < 7), 7, 1)):
            sums[begin] = sums.get(begin, 0.0) + total
    return sums


def _daily_sums(rows: Sequence[Weather]) -> dict[datetime, tuple[float, int]]:
    """Return the snow of each day, m, and the number of its first row."""
    falls: dict[datetime, tuple[float, int]] = {}
    for number, row in enumerate(rows):
        day = datetime(row.date.year, row.date.month, row.date.day)
        total, first = falls.get(day, (0.0, number))
        falls[day] = (total + row.snowfall, first)
    return falls
