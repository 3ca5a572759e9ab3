"""A season of snowfalls on a panel: gathering, letting go, piling up, and burying the panel."""

from snowshed.season.accumulation import Day, accumulate
from snowshed.season.driver import SeasonResult, run_season
from snowshed.season.release import Balance, balance
from snowshed.season.settings import SeasonSettings
from snowshed.season.weather import Weather, read_season

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
