"""Rows of `Weather` made in memory: they are checked as those of weather files."""

from dataclasses import replace
from datetime import date, datetime, timedelta, timezone

import pandas as pd
import pytest

from snowshed import InputError, Scene, SnowshedNote, UnusualValueNote
from snowshed.base.notes import record_notes
from snowshed.cli.main import main
from snowshed.season import (
    SeasonSettings,
    Weather,
    accumulate,
    natural_cover,
    read_season,
    run_season,
    snow_balance,
)

ROW = Weather(2, datetime(2024, 12, 1), 0.2, 100.0, -4.0)


def rows_with(**values: object) -> list[Weather]:
    return [ROW, replace(ROW, **{"date": ROW.date + timedelta(days=1), **values})]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            {"snowfall": 20.0},
            "snowfall on 2024-12-01: 20 is outside the allowed range (0 <= value <= 3",
        ),
        ({"snowfall": -0.1}, "snowfall on 2024-12-01: -0.1 is outside"),
        ({"snowfall": "0.2"}, "snowfall on 2024-12-01: '0.2'; needed: a number"),
        ({"snowfall": None}, "snowfall on 2024-12-01: None; needed: a number"),
        ({"temperature": 268.0}, "temperature on 2024-12-01: 268 is outside"),
        ({"temperature": float("nan")}, "temperature on 2024-12-01: nan is outside"),
        ({"density": 0.1}, "density on 2024-12-01: 0.1 is outside the allowed range (10 <= value"),
        ({"friction": -1.0}, "friction on 2024-12-01: -1 is outside"),
        ({"adhesion": True}, "adhesion on 2024-12-01: True; needed: a number"),
        ({"date": "2024-12-02"}, "date: '2024-12-02'; needed: a datetime"),
        ({"date": date(2024, 12, 2)}, "date: a date without a time; needed: a datetime"),
        ({"date": datetime(2024, 12, 2, tzinfo=timezone.utc)}, "date: has a time zone"),
        ({"line": "two"}, "line: 'two'; needed: a whole number"),
    ],
)
def test_a_row_that_cannot_be_weather_is_refused_where_it_is_made(values, message):
    with pytest.raises(InputError) as caught:
        replace(ROW, **values)
    assert str(caught.value).startswith(message)


USES = (
    read_season,
    lambda rows: accumulate(rows, SeasonSettings(), 40.0),
    lambda rows: natural_cover(rows, SeasonSettings()),
)


@pytest.mark.parametrize("use", USES)
def test_rows_out_of_order_are_refused(use):
    with pytest.raises(InputError, match="row 2, column date: 2024-11-02 00:00:00 is not after"):
        use(rows_with(date=datetime(2024, 11, 2)))


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


WARM = "1 snowfall in air of 10 °C and more"


def test_snow_in_warm_air_is_told():
    table = pd.DataFrame(
        {"date": ["2024-12-01", "2024-12-02"], "snowfall_m": [0.1, 0.2], "temperature_c": [-4, 25]}
    )
    for season in (table, rows_with(temperature=25.0)):
        with pytest.warns(SnowshedNote, match=WARM):
            read_season(season)


def test_temperatures_of_deep_winter_in_fahrenheit_are_told():
    cold = [replace(ROW, date=ROW.date + timedelta(days=d), temperature=6.0 + d) for d in range(4)]
    with record_notes() as notes:
        read_season(cold)
    assert notes == []  # a few mild snowfalls are no sign
    cold.append(replace(ROW, date=ROW.date + timedelta(days=9)))
    with pytest.warns(UnusualValueNote, match="half of 5 snowfalls in air of 7 °C and more"):
        read_season(cold)


def test_accumulation_tells_of_snow_in_warm_air():
    with pytest.warns(SnowshedNote, match=WARM):
        accumulate(rows_with(temperature=25.0), SeasonSettings(), 40.0)


def test_rows_that_were_read_are_told_of_once():
    rows = rows_with(temperature=25.0)
    with record_notes() as notes:
        accumulate(read_season(rows), SeasonSettings(), 40.0)
    assert sum(WARM in note for note in notes) == 1
    with pytest.warns(SnowshedNote, match=WARM):  # the same rows, which nobody read
        accumulate(rows, SeasonSettings(), 40.0)


def test_warm_snow_that_joins_a_season_after_reading_is_told():
    season = read_season(rows_with(temperature=-4.0))
    season.append(replace(ROW, date=datetime(2024, 12, 5), temperature=25.0))
    with pytest.warns(SnowshedNote, match=WARM):
        accumulate(season, SeasonSettings(), 40.0)


def test_a_season_tells_of_snow_in_warm_air_once(tmp_path):
    flat = Scene.preset("lab-40").set("panel.tilt", 20)
    with record_notes() as notes:
        result = run_season(rows_with(temperature=25.0), flat, tmp_path / "s", pictures=False)
    for texts in (notes, result.notes):
        assert sum(WARM in note for note in texts) == 1


def table_of(dates):
    return pd.DataFrame({"date": dates, "snowfall_m": 0.1, "temperature_c": -4.0})


def test_days_missing_in_a_daily_table_are_noted():
    """A list of snowfalls and the summer between two winters have no gaps."""
    days = pd.date_range("2024-01-01", "2024-03-31", freq="D")
    record = read_season(table_of(days))
    assert not record.notes
    with pytest.warns(SnowshedNote, match="no rows on 20 days in 1 gap, from 2024-01-31 to 2024-"):
        read_season(table_of(days[:30].append(days[50:])))
    with pytest.warns(
        SnowshedNote, match="no rows on 1 day in 1 gap, from 2024-02-29 to 2024-02-29"
    ):
        read_season(table_of(days[days != "2024-02-29"]))
    assert read_season(table_of(days[::6])).notes == ()
    assert read_season(table_of(days.append(days + pd.Timedelta(days=366)))).notes == ()


def test_a_dry_run_counts_days_and_not_rows(tmp_path, capsys):
    """Hourly tables have 24 rows on a day."""
    hours = pd.date_range("2024-01-01", periods=72, freq="h")
    table_of(hours).assign(snowfall_m=0.004).to_csv(tmp_path / "hours.csv", index=False)
    panel = ["--dim=2", "--height=0.8", "--length=2", "--tilt=40", "--dx=0.05"]
    arguments = ["season", str(tmp_path / "hours.csv"), *panel, "-o", str(tmp_path / "out")]
    assert main([*arguments, "--dry-run"]) == 0
    assert "in 3 days" in capsys.readouterr().out
