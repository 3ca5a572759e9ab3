"""Weather of many years, cut into winters: those with observed snow count."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.callers import argument
from snowshed.base.notes import InputNote, issue_note
from snowshed.season.weather.quality import COVERAGE
from snowshed.season.weather.row import Weather
from snowshed.season.weather.season_record import SeasonRecord, WinterList, whole_percent


@checked
@dataclass(frozen=True)
class Winter:
    """The weather of one winter.

    Attributes
    ----------
    name
        Such as "2001/02", or "2001" in the south.
    days
        The rows of the winter, in order.
    """

    name: str
    days: Sequence[Weather]

    @property
    def snowfall(self) -> float:
        """Depth of all its new snow, m."""
        return sum(day.snowfall for day in self.days)


@checked
def split_winters(season: Sequence[Weather], coverage: float = COVERAGE) -> list[Winter]:
    """Return the winters with observed snow in many years of weather.

    Years are cut in the station's summer, on 1 July in the north and on 1 January in the south.
    A winter is left out, and named in a note, if its snow was observed on too small a share of the
    days of the station's snow season.

    Parameters
    ----------
    season
        From `read_season`.
    coverage
        Share of the days of the snow season, 0 to 1.

    Raises
    ------
    InputError
        If no winter counts, or the coverage is not a share.

    Examples
    --------
    >>> from snowshed.season.weather.generator import EXAMPLE_CLIMATE
    >>> [winter.name for winter in split_winters(EXAMPLE_CLIMATE.winters(2, seed=1))]
    ['2001/02', '2002/03']
    """
    record = SeasonRecord(season).winters(coverage)
    winters = counted_winters(record)
    for note in record.notes:
        issue_note(note, InputNote)
    return winters


def counted_winters(winter_list: WinterList) -> list[Winter]:
    """Return the winters that count.

    Parameters
    ----------
    winter_list
        From `SeasonRecord.winters`.

    Raises
    ------
    InputError
        If no winter counts; the message lists the share of each.
    """
    winters = [Winter(winter.name, winter.rows) for winter in winter_list.counted]
    if not winters:
        raise InputError(
            "the weather: no winter has snow observed on "
            f"{whole_percent(winter_list.coverage)} of the "
            f"days {winter_list.season.text}: {winter_list.excluded_text}; give a longer record, a "
            f"smaller {argument('coverage')}, or another column ({argument('snow_from')})"
        )
    return winters
