"""A season of snowfalls: accumulation on a panel, release, and the growth of the stack below it."""

from snowshed.run.season.accumulation import Day, accumulate
from snowshed.run.season.driver import SeasonResult, run_season
from snowshed.run.season.release import Balance, balance
from snowshed.run.season.settings import SeasonSettings
from snowshed.run.season.weather import read_season
from snowshed.run.season.weather_row import Weather

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
