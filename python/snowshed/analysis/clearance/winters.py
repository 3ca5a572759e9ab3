"""Weather of many years, cut into winters, of which those count whose snow was observed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from snowshed._core import InputError
from snowshed.base.notes import tell
from snowshed.season.quality import COVERAGE
from snowshed.season.record import Record, WinterList, percent
from snowshed.season.weather_row import Weather


@dataclass(frozen=True)
class Winter:
    """The weather of one winter.

    Attributes
    ----------
    name
        Such as "2001/02", or "2001" in the south.
    days
        Its rows, in order.
    """

    name: str
    days: Sequence[Weather]

    @property
    def snowfall(self) -> float:
        """Depth of all its new snow, m."""
        return sum(day.snowfall for day in self.days)


def winters_of(season: Sequence[Weather], coverage: float = COVERAGE) -> list[Winter]:
    """Return the winters of many years of weather whose snow was observed.

    Years are cut in the station's summer, on 1 July in the north and on 1 January in the south.
    Winters whose snow was observed on less than the asked share of the days of the station's snow
    season are left out, and named in a note.

    Parameters
    ----------
    season
        From `read_season`.
    coverage
        Share of the days of the snow season, 0 to 1.

    Raises
    ------
    InputError
        If no winter counts, or the coverage is no share.

    Examples
    --------
    >>> from snowshed.season.generator import EXAMPLE_CLIMATE
    >>> [winter.name for winter in winters_of(EXAMPLE_CLIMATE.winters(2, seed=1))]
    ['2001/02', '2002/03']
    """
    found = Record(season).winters(coverage)
    winters = counted(found)
    for note in found.notes:
        tell(note)
    return winters


def counted(found: WinterList) -> list[Winter]:
    """Return the winters that count.

    Parameters
    ----------
    found
        From `Record.winters`.

    Raises
    ------
    InputError
        If none does, with the share of each.
    """
    winters = [Winter(winter.name, winter.rows) for winter in found.counted]
    if not winters:
        raise InputError(
            f"the weather: no winter whose snow was observed on {percent(found.coverage)} of the "
            f"days {found.season.words}: {found.left_out_words}; give a longer record, a "
            "smaller --coverage, or another column (--snow-from)"
        )
    return winters
