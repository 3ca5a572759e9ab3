"""The new snow of a day, its source, and changes of the depth that are not snowfall."""

import random
from datetime import date, datetime, timedelta

import numpy as np
import pytest
from helpers.station_files import days, elements, ghcn, smet, snows, warmth

from snowshed import InputError
from snowshed.io import Observation, Station
from snowshed.season.weather.daily_means import days_of_station
from snowshed.season.weather.reading import read_record
from snowshed.season.weather.source import SnowSource

WINTER = (date(2023, 11, 1), date(2024, 4, 30))
HOURS = [datetime(2023, 11, 1) + timedelta(hours=n) for n in range(24 * 182)]
COLD = 265.15  # K
NO_TEMPERATURE = {"TMAX": None, "TMIN": None}
STEPS = 12  # number of hourly rises of the depth by 0.2 m


def total(record):
    return sum(row.snowfall for row in record.rows)


def row_on(record, day):
    return next(row for row in record.rows if row.date.date() == day)


def has_note(record, *words):
    return any(all(word in note for word in words) for note in record.notes)


def depth(time):
    """Return a depth that rises every other week by 0.2 m."""
    return 0.3 + 0.2 * ((time - HOURS[0]).days // 14)


def hourly(folder, function, fields="TA HS"):
    return read_record(smet(folder / "x.smet", [(t, (COLD, *function(t))) for t in HOURS], fields))


def daily_depths(folder, depths, warm=-5.0):
    """Read a record with a depth (m) a day from 1 November 2023; None: no reading, "": no row."""
    rows = [
        (day, {"TMAX": 10 * warm, "TMIN": 10 * warm, "SNWD": None if deep is None else 1000 * deep})
        for day, deep in zip(days(*WINTER), depths)
        if deep != ""
    ]
    return read_record(ghcn(folder / "depths.csv", rows))


# --- depth -----------------------------------------------------------------------------------


def test_noise_of_a_sensor_is_not_counted(tmp_path):
    chance = random.Random(1)
    record = hourly(tmp_path, lambda t: (max(depth(t) + chance.gauss(0.0, 0.03), 0.0),))
    assert total(record) == pytest.approx(0.2 * STEPS, rel=0.06)
    assert {row.source for row in record.rows} == {SnowSource.DEPTH}


def test_a_rise_over_a_gap_is_spread_over_its_days(tmp_path):
    record = daily_depths(tmp_path, [0.2] * 49 + [""] * 36 + [1.1] * 97)
    assert max(row.snowfall for row in record.rows) < 0.03
    assert total(record) == pytest.approx(0.9, abs=0.01)
    day_in_gap = row_on(record, date(2024, 1, 5))
    assert (
        day_in_gap.source is SnowSource.FILLED
        and "rise of 0.90 m over 37 days" in day_in_gap.reason
    )
    assert has_note(record, "rises by 0.90 m in the 37 days to 2024-01-25", "not snowfall of a day")
    assert not record.winters().counted


def test_a_rise_over_a_summer_is_not_counted(tmp_path):
    rows = [
        (day, {"TMAX": -50, "TMIN": -50, "SNWD": 0 if day.month < 7 else 500})
        for day in (
            *days(date(2024, 4, 1), date(2024, 4, 30)),
            *days(date(2024, 11, 1), date(2024, 11, 30)),
        )
    ]
    record = read_record(ghcn(tmp_path / "x.csv", rows))
    assert total(record) == 0.0 and has_note(record, "it never snows in this file")
    assert has_note(record, "rises by 0.50 m from 2024-04-30", "not counted")


def test_a_station_without_snow_is_read_and_its_winter_counts(tmp_path):
    record = daily_depths(tmp_path, [0.3] * 182)
    assert has_note(record, "it never snows in this file")
    assert record.winters().counted_text == "1 of 1 winter"


def test_depths_on_weekdays_cover_the_weekend(tmp_path):
    deep, depths = 0.0, []
    for number, day in enumerate(days(*WINTER)):
        deep += 0.1 if number % 7 == 3 else 0.0
        depths.append(deep if day.weekday() < 5 else None)
    record = daily_depths(tmp_path, depths)
    assert total(record) == pytest.approx(2.6, abs=0.11)
    (winter,) = record.winters().winters
    assert winter.counts and winter.sources[SnowSource.MISSING] == 0


@pytest.mark.parametrize("size", [0.8, 2.5, 9.0])
def test_a_spike_is_not_counted(tmp_path, size):
    depths = [0.3] * 30 + [0.5] * 40 + [0.5 + size] + [0.5] * 40
    record = daily_depths(tmp_path, depths)
    assert total(record) == pytest.approx(0.2)
    assert row_on(record, date(2024, 1, 10)).snow_depth is None
    assert has_note(record, "1 reading of the snow depth (2024-01-10)", "spike")


def test_a_rise_above_the_record_is_not_counted(tmp_path):
    record = daily_depths(tmp_path, [0.3] * 30 + [0.5] * 40 + [2.9] * 40)
    assert total(record) == pytest.approx(0.2)
    assert has_note(record, "rises by 2.40 m", "no more than 1.93 m was ever measured in 24 hours")


def test_snow_that_melts_is_counted(tmp_path):
    """0.35 m of wet snow are gone after two mild days."""
    record = daily_depths(tmp_path, [0.0] * 30 + [0.35, 0.0] + [0.0] * 40, warm=4.0)
    assert total(record) == pytest.approx(0.35)


def test_after_a_drop_out_only_the_difference_is_counted(tmp_path):
    record = daily_depths(tmp_path, [0.8] * 30 + [0.0] * 3 + [1.0] * 40)
    assert total(record) == pytest.approx(0.2)
    assert has_note(record, "3 readings of the snow depth", "drop-out")


def test_moving_a_sensor_is_not_counted(tmp_path):
    chance = random.Random(2)
    moved = datetime(2024, 1, 20, 13)
    record = hourly(tmp_path, lambda t: (depth(t) + chance.gauss(0.0, 0.004) + (t > moved),))
    assert total(record) == pytest.approx(0.2 * STEPS, rel=0.06)
    assert has_note(record, "jumps 1 time faster than snow falls (+1.0", "on 2024-01-20")


def test_a_depth_that_is_read_once_a_day_may_rise_within_an_hour(tmp_path):
    record = hourly(tmp_path, lambda t: (0.5 * ((t - HOURS[0]).days // 14),))
    assert total(record) == pytest.approx(0.5 * STEPS)


def test_joints_between_months_of_typical_years_are_not_counted():
    rows = [
        Observation(n, time, -5.0, snow_depth=1.2 if time.month == 2 else 0.2 + 0.01 * time.day)
        for n, time in enumerate(datetime(2002, 1, 1) + timedelta(hours=n) for n in range(24 * 50))
    ]
    level = days_of_station(Station("EPW", "", rows, typical_year=True)).level
    assert level.max() - level[0] == pytest.approx(0.30)


# --- columns that contradict each other ------------------------------------------------------


@pytest.mark.parametrize("water", [0.0, 0.1, 4.7])
def test_for_a_gauge_that_misses_snow_the_depth_is_used(tmp_path, water):
    fall = lambda t: water * ((t - HOURS[0]).days % 14 == 0 and t.hour == 3)  # noqa: E731
    record = hourly(tmp_path, lambda t: (depth(t), fall(t)), "TA HS PSUM")
    assert total(record) == pytest.approx(0.2 * STEPS)
    assert {row.source for row in record.rows} == {SnowSource.DEPTH}
    assert has_note(record, "contradict each other", "snow depth 2.4 m", "the snow depth is used")


def test_a_gauge_that_agrees_with_the_depth_is_used(tmp_path):
    fall = lambda t: 13.7 * ((t - HOURS[0]).days % 14 == 0 and t.hour == 3)  # noqa: E731
    record = hourly(tmp_path, lambda t: (depth(t), fall(t)), "TA HS PSUM")
    assert {row.source for row in record.rows} == {SnowSource.GAUGE}
    assert not has_note(record, "contradict")
    record = read_record(tmp_path / "x.smet", "depth")
    assert {row.source for row in record.rows} == {SnowSource.DEPTH}


def test_for_a_constant_depth_the_gauge_is_used(tmp_path):
    fall = lambda t: 13.7 * ((t - HOURS[0]).days % 14 == 0 and t.hour == 3)  # noqa: E731
    record = hourly(tmp_path, lambda t: (1.0, fall(t)), "TA HS PSUM")
    assert {row.source for row in record.rows} == {SnowSource.GAUGE}
    assert has_note(record, "contradict each other", "snow depth 0 m", "the precipitation is used")


def several_winters(folder, **elements_of):
    first, last = date(2000, 7, 1), date(2003, 6, 30)
    rows, deep = [], 0.0
    for day in days(first, last):
        deep = (
            deep + 100.0 if snows(day) else max(deep - (10.0 if warmth(day) < 0.0 else 80.0), 0.0)
        )
        values = {name: function(day, deep) for name, function in elements_of.items()}
        rows.append((day, {**elements(day), **values}))
    return read_record(ghcn(folder / "x.csv", rows))


def test_for_missing_entries_of_new_snow_the_depth_is_used(tmp_path):
    """In one winter, or in all winters, the depth rises and the new snow is always 0."""

    def new_snow(day, _):
        return 0.0 if date(2001, 7, 1) <= day < date(2002, 7, 1) else 100.0 * snows(day)

    record = several_winters(tmp_path, SNOW=new_snow, SNWD=lambda _, deep: deep)
    sources = [winter.source_text for winter in record.winters().winters]
    assert sources == ["new snow", "snow depth", "new snow"]
    assert has_note(record, "2001/02: new snow 0 m, snow depth 2 m")
    record = several_winters(tmp_path, SNOW=lambda *_: 0.0, SNWD=lambda _, deep: deep)
    assert total(record) == pytest.approx(6.0, abs=0.1)
    assert has_note(record, "2000/01: new snow 0 m, snow depth 2 m")


def test_new_snow_is_not_replaced_by_precipitation(tmp_path):
    """A gauge with more snow than measured by hand is noted, but the new snow by hand is used."""
    record = several_winters(tmp_path, PRCP=lambda day, _: 300.0 if snows(day) else 0.0)
    assert {row.source for row in record.rows} == {SnowSource.HAND}
    assert has_note(record, "contradict each other", "the new snow is used, not the precipitation")


# --- amounts, days and temperatures -----------------------------------------------------------


def test_new_snow_of_rolling_days_is_counted_once(tmp_path):
    """0.12 m fall from 18 to 6 o'clock; every row holds the sum of the last 24 hours."""
    hours = [datetime(2024, 1, 10) + timedelta(hours=n) for n in range(96)]
    fallen = np.array([0.01 * (18 < n <= 30) for n in range(96)])
    rolling = [fallen[max(n - 23, 0) : n + 1].sum() for n in range(96)]
    rows = [(time, (268.15, amount)) for time, amount in zip(hours, rolling)]
    record = read_record(smet(tmp_path / "x.smet", rows, "TA HN24"))
    assert total(record) == pytest.approx(0.12)


def test_measured_snow_counts_without_a_temperature(tmp_path):
    """A month without temperatures, in one of three winters and in the only winter."""
    rows = [
        (day, elements(day) | (NO_TEMPERATURE if (day.year, day.month) == (2002, 1) else {}))
        for day in days(date(2000, 7, 1), date(2003, 6, 30))
    ]
    complete = [(day, elements(day)) for day, _ in rows]
    record = read_record(ghcn(tmp_path / "x.csv", rows))
    assert total(record) == pytest.approx(total(read_record(ghcn(tmp_path / "y.csv", complete))))
    assert len(record.winters().counted) == 3
    assert has_note(record, "no temperature on 25 days", "mean of the same days of the year")
    assert row_on(record, date(2002, 1, 16)).temperature == pytest.approx(-6.0, abs=0.3)
    single = [row for row in rows if row[0] >= date(2001, 7, 1) and row[0] < date(2002, 7, 1)]
    record = read_record(ghcn(tmp_path / "z.csv", single))
    assert has_note(record, "no temperature on 25 days", "interpolated")
    assert (
        row_on(record, next(d for d, _ in single if snows(d) and d.year == 2002)).snowfall == 0.12
    )


def test_new_snow_beyond_the_record_is_left_out(tmp_path):
    rows = [
        (day, elements(day) | ({"SNOW": 2500.0} if day == date(2024, 1, 20) else {}))
        for day in days(*WINTER)
    ]
    record = read_record(ghcn(tmp_path / "x.csv", rows))
    assert row_on(record, date(2024, 1, 20)).source is SnowSource.MISSING
    assert has_note(record, "new snow of 2.50 m on 2024-01-20 is left out", "1.93 m")


def test_precipitation_without_temperature_is_not_observed_snow(tmp_path):
    rows = [
        (day, elements(day, snow=None, PRCP=90.0 if snows(day) else 0.0)
         | (NO_TEMPERATURE if day.month == 1 else {}))
        for day in days(*WINTER)
    ]  # fmt: skip
    record = read_record(ghcn(tmp_path / "x.csv", rows))
    january_rows = [
        row for row in record.rows if row.snowfall and row.date.month == 1 and 4 < row.date.day < 27
    ]
    assert {row.source for row in january_rows} == {SnowSource.FILLED}


def test_a_requested_column_must_exist(tmp_path):
    file = ghcn(tmp_path / "x.csv", [(day, elements(day)) for day in days(*WINTER)])
    with pytest.raises(InputError, match="no precipitation in any row of this GHCN-daily file"):
        read_record(file, "gauge")
    with pytest.raises(InputError, match="snow from: 'radar'; allowed: auto, new-snow"):
        read_record(file, "radar")
    table = tmp_path / "table.csv"
    table.write_text("date,snowfall_m,temperature_c\n2024-01-01,0.2,-4\n")
    with pytest.raises(InputError, match="its snow is that of its column snowfall_m"):
        read_record(table, "depth")
