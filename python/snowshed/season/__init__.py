"""A season of snowfalls: accumulation on a panel, release, and the growth of the stack below it."""

from snowshed.season.accumulation import Day, accumulate
from snowshed.season.driver import SeasonResult, run_season
from snowshed.season.release import Balance, balance
from snowshed.season.settings import SeasonSettings
from snowshed.season.weather import read_season
from snowshed.season.weather_row import Weather

__all__ = [
    "Balance",
    "Day",
    "SeasonResult",
    "SeasonSettings",
    "Weather",
    "accumulate",
    "balance",
    "read_season",
    "run_season",
]
