"""Weather files as their providers write them, recognised by their content."""

from snowshed.io.weather.joined import read_stations
from snowshed.io.weather.observation import Observation, Station
from snowshed.io.weather.recognise import FORMATS, read_station

__all__ = ["FORMATS", "Observation", "Station", "read_station", "read_stations"]
