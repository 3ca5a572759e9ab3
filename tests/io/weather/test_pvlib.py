"""EPW and TMY3 as pvlib reads them: the same temperatures, water and depths."""

from datetime import datetime, timedelta

import numpy as np
import pytest
from synthetic_weather import epw, hourly, tmy3

from snowshed.io import read_station

iotools = pytest.importorskip("pvlib.iotools")
RANDOM = np.random.default_rng(3)


def days(count):
    """Return (end, temperature, depth in cm, mm, hours) of some days of one year."""
    return [
        (end, round(float(RANDOM.normal(-3, 6)), 1), int(RANDOM.integers(0, 150)),
         round(float(RANDOM.gamma(0.2, 2.0)), 1), 1)
        for end in hourly(datetime(2005, 1, 10), datetime(2005, 1, 10) + timedelta(count))
    ]  # fmt: skip


def columns(station):
    return {
        name: np.array([getattr(row, name) for row in station.rows], dtype=float)
        for name in ("temperature", "snow_depth", "precipitation")
    }


def test_epw(written):
    file = written(epw(days(8)), "a.epw")
    expected, site = iotools.read_epw(file)
    station = read_station(file)
    ours = columns(station)
    np.testing.assert_allclose(ours["temperature"], expected["temp_air"], atol=1e-9)
    np.testing.assert_allclose(100.0 * ours["snow_depth"], expected["snow_depth"], atol=1e-6)
    np.testing.assert_allclose(
        ours["precipitation"], expected["liquid_precipitation_depth"], atol=1e-9
    )
    assert (station.latitude, station.longitude) == (site["latitude"], site["longitude"])
    assert (station.altitude, station.utc_offset) == (site["altitude"], site["TZ"])


def test_tmy3(written):
    rows = [(end, warm, rain, hours) for end, warm, _, rain, hours in days(8)]
    file = written(tmy3(rows).replace("(hr)", "(hr)"), "a.csv")
    expected, site = iotools.read_tmy3(file, map_variables=True, encoding="iso-8859-1")
    station = read_station(file)
    ours = columns(station)
    np.testing.assert_allclose(ours["temperature"], expected["temp_air"], atol=1e-9)
    np.testing.assert_allclose(ours["precipitation"], expected["Lprecip depth (mm)"], atol=1e-9)
    assert (station.latitude, station.longitude) == (site["latitude"], site["longitude"])
    assert (station.altitude, station.utc_offset) == (site["altitude"], site["TZ"])
    ends = [row.end for row in station.rows]
    assert [time.replace(tzinfo=None) for time in expected.index.to_pydatetime()] == ends
