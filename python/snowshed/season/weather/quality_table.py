"""The table of the winters of a file, for consoles and pages: the quality of their snow data."""

from __future__ import annotations

from snowshed.base.formatting import plural
from snowshed.season.weather.quality import WinterQuality
from snowshed.season.weather.season_record import WinterList, whole_percent
from snowshed.season.weather.source import SnowSource

HEAD = ("winter", "snow observed", "new snow, m", "source", "filled", "not known", "counts")
ALIGN = "lrrlrrl"
MAX_ROWS = 24  # on a console

LIST = "list of snowfalls"


def title(winters: WinterList) -> str:
    """Return the title of the table."""
    return f"Where the snow comes from (snow season {winters.season.text})"


def quality_rows(winters: WinterList) -> list[tuple[str, ...]]:
    """Return a row of texts for each winter, as `HEAD` names them.

    Examples
    --------
    >>> from snowshed.season.weather.generator import EXAMPLE_CLIMATE
    >>> from snowshed.season.weather.season_record import SeasonRecord
    >>> quality_rows(SeasonRecord(EXAMPLE_CLIMATE.winters(1, seed=1)).winters())[0][:4]
    ('2001/02', '169 of 169 days (100 %)', '3.37', 'season file')
    """
    return [_row(winter) for winter in winters.winters]


def console_rows(rows: list[tuple[str, ...]]) -> tuple[list[tuple[str, ...]], int]:
    """Return the rows for a console, and the number of further rows."""
    if len(rows) <= MAX_ROWS:
        return rows, 0
    half = MAX_ROWS // 2
    return [*rows[:half], ("...",) * len(HEAD), *rows[-half:]], len(rows) - 2 * half


def caption(winters: WinterList) -> str:
    """Return a line on the quality of the snow data of a season.

    Examples
    --------
    >>> from snowshed.season.weather.generator import EXAMPLE_CLIMATE
    >>> from snowshed.season.weather.season_record import SeasonRecord
    >>> caption(SeasonRecord(EXAMPLE_CLIMATE.winters(1, seed=1)).winters())
    'Snow of 2001/02: observed on 169 of 169 days (100 %), source: season file'
    """
    if len(winters.winters) > 1:
        return f"Snow of {len(winters.winters)} winters; well observed in {len(winters.counted)}"
    winter = winters.winters[0]
    filled = f"; filled: {_filled_text(winter)}" if winter.sources[SnowSource.FILLED] else ""
    observed = _observed_text(winter)
    days = observed if observed == LIST else f"observed on {observed}"
    return f"Snow of {winter.name}: {days}, source: {winter.source_text}{filled}"


def _row(winter: WinterQuality) -> tuple[str, ...]:
    missing = winter.sources[SnowSource.MISSING]
    return (
        winter.name,
        _observed_text(winter),
        f"{winter.snowfall:.2f}" if winter.rows else "",
        winter.source_text if winter.rows else "",
        _filled_text(winter) if winter.sources[SnowSource.FILLED] else "",
        plural(missing, "day") if missing else "",
        "yes" if winter.counts else "no",
    )


def _observed_text(winter: WinterQuality) -> str:
    if winter.listed and winter.rows:
        return LIST
    if not winter.rows:
        return "no rows"
    return f"{winter.observed} of {plural(winter.season, 'day')} ({whole_percent(winter.share)})"


def _filled_text(winter: WinterQuality) -> str:
    return f"{plural(winter.sources[SnowSource.FILLED], 'day')}, {winter.filled_snow:.2f} m"
