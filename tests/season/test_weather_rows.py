"""Rows of `Weather` made in memory: they are checked as those of weather files."""

from dataclasses import replace
from datetime import date, datetime, timedelta, timezone

import pandas as pd
import pytest

from snowshed import InputError, SnowshedNote
from snowshed.season import (
    Climate,
    SeasonSettings,
    Weather,
    accumulate,
    natural_cover,
    read_season,
    snow_balance,
)

ROW = Weather(2, datetime(2024, 12, 1), 0.2, 100.0, -4.0)


def rows_with(**values: object) -> list[Weather]:
    return [ROW, replace(ROW, date=ROW.date + timedelta(days=1), **values)]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            {"snowfall": 20.0},
            "row 2, snowfall: 20 is outside the allowed range (0 <= value <= 3",
        ),
        ({"snowfall": -0.1}, "row 2, snowfall: -0.1 is outside"),
        ({"snowfall": "0.2"}, "row 2, snowfall: '0.2'; needed: a number"),
        ({"snowfall": None}, "row 2, snowfall: None; needed: a number"),
        ({"temperature": 268.0}, "row 2, temperature: 268 is outside"),
        ({"temperature": float("nan")}, "row 2, temperature: nan is outside"),
        ({"density": 0.1}, "row 2, density: 0.1 is outside the allowed range (10 <= value <= 700"),
        ({"friction": -1.0}, "row 2, friction: -1 is outside"),
        ({"adhesion": True}, "row 2, adhesion: True; needed: a number"),
        ({"date": "2024-12-02"}, "row 2, date: '2024-12-02'; needed: a datetime"),
        ({"date": date(2024, 12, 2)}, "row 2, date: a date without a time; needed: a datetime"),
        ({"date": datetime(2024, 12, 2, tzinfo=timezone.utc)}, "row 2, date: has a time zone"),
        ({"date": datetime(2024, 11, 2)}, "row 2, column date: 2024-11-02 00:00:00 is not after"),
    ],
)
@pytest.mark.parametrize(
    "use",
    [
        read_season,
        lambda rows: accumulate(rows, SeasonSettings(), 40.0),
        lambda rows: natural_cover(rows, SeasonSettings()),
    ],
)
def test_rows_that_cannot_be_weather_are_refused(use, values, message):
    rows = [ROW, replace(ROW, **{"date": ROW.date + timedelta(days=1), **values})]
    with pytest.raises(InputError) as caught:
        use(rows)
    assert message in str(caught.value)


def test_a_climate_is_not_fitted_to_rows_that_cannot_be_weather():
    with pytest.raises(InputError, match="days, row 2, snowfall: 20 is outside"):
        Climate.fit(rows_with(snowfall=20.0))


def test_a_row_of_another_type_is_refused():
    with pytest.raises(InputError, match="both files and rows"):
        read_season([ROW, "snow.csv"])
    with pytest.raises(InputError, match=r"season\[0\]: \(2, 0.2\); needed: Weather"):
        accumulate([(2, 0.2)], SeasonSettings(), 40.0)


@pytest.mark.parametrize("tilt", [-40.0, 95.0, 400.0, float("nan")])
def test_a_tilt_that_no_panel_has_is_refused(tilt):
    for use in (lambda: accumulate([ROW], SeasonSettings(), tilt),
                lambda: snow_balance(10.0, tilt, 0.7, 0.0)):  # fmt: skip
        with pytest.raises(InputError, match=r"tilt: .* is outside the allowed range"):
            use()


def test_snow_in_warm_air_is_told():
    table = pd.DataFrame(
        {"date": ["2024-12-01", "2024-12-02"], "snowfall_m": [0.1, 0.2], "temperature_c": [-4, 25]}
    )
    for season in (table, rows_with(temperature=25.0)):
        with pytest.warns(SnowshedNote, match="1 snowfall in air of 10 °C and more"):
            read_season(season)
