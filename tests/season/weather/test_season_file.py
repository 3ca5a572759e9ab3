"""Season files: allowed contents, and messages on other contents."""

import dataclasses
import datetime
import re

import numpy as np
import pandas as pd
import pytest

from snowshed import InputError
from snowshed.season import read_season
from snowshed.season.weather.reading import read_record

HEADER = "date,snowfall_m,density_kg_m3,temperature_c"


def read(folder, *lines, header=HEADER):
    file = folder / "season.csv"
    file.write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")
    return read_season(file)


def test_a_season_file_is_read(tmp_path):
    rows = read(
        tmp_path,
        "# December",
        "2024-12-01,0.2,100,-4",
        "",
        "2024-12-02T18:00, 0 ,, 1.5",
        "2025-01-01,0.1,,-9",
    )
    assert [row.line for row in rows] == [3, 5, 6]
    assert [row.snowfall for row in rows] == [0.2, 0.0, 0.1]
    assert [row.density for row in rows] == [100.0, None, None]
    assert rows[1].date == datetime.datetime(2024, 12, 2, 18)


def test_days_may_have_friction_and_adhesion(tmp_path):
    header = "adhesion_pa,date,temperature_c,friction,snowfall_m"
    first, second = read(tmp_path, "50,2024-12-01,-4,0.6,0.1", ",2024-12-02,-4,,0.1", header=header)
    assert (first.friction, first.adhesion, first.density) == (0.6, 50.0, None)
    assert (second.friction, second.adhesion) == (None, None)


def test_times_with_offsets_are_compared_as_instants(tmp_path):
    rows = read(tmp_path, "2024-12-01T00:30+01:00,0.1,,0", "2024-12-01T00:00+00:00,0.1,,0")
    assert (rows[1].date - rows[0].date).total_seconds() == 1800


GOOD = "2024-12-01,0.2,100,-4"
BAD_ROWS = [
    ("2024-12-02,0.2,100", "line 3: not a table: 3 cells in 4 columns"),
    ("2024-12-02,0.2,100,-4,7", "line 3: not a table: 5 cells in 4 columns"),
    ("yesterday,0.2,100,-4", "line 3, column date: 'yesterday' is not a date such as"),
    ("2024-11-30,0.2,100,-4", "line 3, column date: 2024-11-30 00:00:00 is not after line 2"),
    ("2024-12-01,0.2,100,-4", "line 3, column date: 2024-12-01 00:00:00 is not after line 2"),
    ("2024-12-02,much,100,-4", "line 3, column snowfall_m: 'much' is not a number"),
    ("2024-12-02,-0.1,100,-4", r"column snowfall_m: -0.1 is outside the allowed range \(0 <= "),
    ("2024-12-02,nan,100,-4", "line 3, column snowfall_m: 'nan' is not a number"),
    ("2024-12-02,1_000,100,-4", "line 3, column snowfall_m: '1_000' is not a number"),
    ("2024-12-02,\u0663,100,-4", "line 3, column snowfall_m: '\u0663' is not a number"),
    ("9999-12-31T23:59-14:00,0.2,100,-4", "line 3, column date: '9999-.*' has a UTC offset, but "),
    ("2024-12-02,,100,-4", "line 3, column snowfall_m: empty; give a number"),
    ("2024-12-02,0.2,5000,-4", "line 3, column density_kg_m3: 5000 is outside .* <= 700 kg/m3"),
    ("2024-12-02,0.2,100,inf", "line 3, column temperature_c: 'inf' is not a number"),
    ('2024-12-02,"0.2,100,-4', "line 3: not a table: unexpected end"),
]


@pytest.mark.parametrize(("row", "message"), BAD_ROWS)
def test_bad_rows_are_refused_with_file_and_line(tmp_path, row, message):
    with pytest.raises(InputError, match=rf"season\.csv, .*{message}"):
        read(tmp_path, GOOD, row)


BAD_HEADERS = [
    ("date,snow,temperature_c", "line 1: unknown column 'snow'; allowed: date, snowfall_m"),
    ("[" * 20_000, rf"line 1: unknown column '{re.escape('[' * 60)}'\.\.\.; allowed: "),
    ("date,snowfall_m", "line 1: no column 'temperature_c'; needed: date, snowfall_m"),
    ("date,date,snowfall_m,temperature_c", "line 1: not a table: the column 'date' occurs twice"),
]


@pytest.mark.parametrize(("header", "message"), BAD_HEADERS)
def test_bad_headers_are_refused(tmp_path, header, message):
    with pytest.raises(InputError, match=message):
        read(tmp_path, GOOD, header=header)


def test_files_without_a_season_are_refused(tmp_path):
    with pytest.raises(InputError, match="no rows below the header"):
        read(tmp_path)
    with pytest.raises(InputError, match="it never snows"):
        read(tmp_path, "2024-12-01,0,,-4")
    with pytest.raises(InputError, match=r"season\.csv: empty; the first line names the columns"):
        read(tmp_path, header="# nothing")
    (tmp_path / "season.csv").write_bytes(HEADER.encode() + b"\n2024-12-01,0.2,\xff,0\n")
    with pytest.raises(InputError, match="line 2: not a table: not UTF-8 text"):
        read_season(tmp_path / "season.csv")
    with pytest.raises(OSError, match="No such file"):
        read_season(tmp_path / "none.csv")


def frame(**columns):
    dates = pd.to_datetime(["2024-12-01T06:00", "2024-12-02T00:00", "2024-12-05T00:00"])
    defaults = {"date": dates, "snowfall_m": [0.1 + 0.2, 0.0, 0.1], "temperature_c": [-4, 1.5, -9]}
    return pd.DataFrame({**defaults, **columns})


def test_a_table_and_its_file_give_the_same_season(tmp_path):
    table = frame(density_kg_m3=[100.0, None, 1 / 3 + 80])
    table.to_csv(tmp_path / "season.csv", index=False)
    rows, read = read_season(table), read_season(tmp_path / "season.csv")
    assert [dataclasses.replace(row, line=row.line + 1) for row in rows] == read
    assert rows[0].snowfall == 0.1 + 0.2 and rows[1].density is None
    assert read_season(table.set_index("date")) == rows
    assert read_season(rows) == rows


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"snowfall_cm": [1, 2, 3]}, "the season: unknown column 'snowfall_cm'; allowed: date"),
        ({"snowfall_m": [0.1, -0.1, 0.2]}, "the season, row 2, column snowfall_m: -0.1 is outside"),
        ({"temperature_c": [0, None, 1]}, "row 2, column temperature_c: empty; give a number"),
        ({"date": ["2024-12-01"] * 3}, "row 2, column date: .* is not after row 1"),
        ({"snowfall_m": [0, 0, 0]}, "the season: it never snows"),
    ],
)
def test_bad_tables_are_refused_with_row_and_column(columns, message):
    with pytest.raises(InputError, match=message):
        read_season(frame(**columns))


def test_units_of_a_table_must_match_its_columns():
    table = frame()
    table.attrs["units"] = {"snowfall_m": "m", "temperature_c": "degC"}
    read_season(table)
    table.attrs["units"] = {"snowfall_m": "cm"}
    with pytest.raises(InputError, match="column snowfall_m: its units are 'cm'; convert it to m"):
        read_season(table)


def test_snowfall_in_centimetres_is_refused(tmp_path):
    file = tmp_path / "season.csv"
    file.write_text("date,snowfall_m,temperature_c\n2024-12-01,8,-3\n")
    with pytest.raises(InputError, match=r"column snowfall_m: 8 is outside .*is it in cm, mm or"):
        read_season(file)
    file.write_text(
        "date,snowfall_m,temperature_c\n2024-12-01,2,-3\n2024-12-02,1.5,-3\n2024-12-03,1,-3\n"
    )
    with pytest.raises(InputError, match=r"half of the snowfalls are 1.5 m and more"):
        read_season(file)


def test_days_with_an_offset_stay_on_their_date(tmp_path):
    rows = read(tmp_path, *(f"2024-12-0{day}T00:00+01:00,0.1,,-4" for day in (1, 2)))
    assert [row.date for row in rows] == [datetime.datetime(2024, 12, day) for day in (1, 2)]


def test_local_days_of_summer_and_winter_stay_on_their_dates():
    days = pd.date_range("2024-10-26", "2024-10-29", tz="Europe/Zurich")
    rows = read_season(pd.DataFrame({"snowfall_m": 0.1, "temperature_c": -3.0}, index=days))
    assert [row.date.day for row in rows] == [26, 27, 28, 29]
    assert not rows.notes


def test_hours_of_summer_time_are_converted_to_standard_time_with_a_note(tmp_path):
    with pytest.warns(UserWarning, match=r"2 UTC offsets; they are converted to UTC\+1 h"):
        rows = read(tmp_path, "2024-10-26T06:00+02:00,0.1,,0", "2024-10-27T06:00+01:00,0.1,,0")
    assert [row.date.hour for row in rows] == [5, 6]


def test_offsets_in_some_rows_only_are_refused(tmp_path):
    with pytest.raises(
        InputError, match=r"line 3, column date: .* has a UTC offset, but line 2 has"
    ):
        read(tmp_path, "2024-12-01,0.1,,-4", "2024-12-02T00:00+01:00,0.1,,-4")


def test_a_time_without_a_universal_time_is_refused(tmp_path):
    rows = ("2024-12-01T00:00+14:00,0.1,,-4", "9999-12-31T23:59-14:00,0.1,,-4")
    with pytest.raises(InputError, match=r"line 3, column date: .* has no universal time"):
        read(tmp_path, *rows)


def test_adhesion_in_kilopascals_is_noted(tmp_path):
    header = "date,snowfall_m,temperature_c,adhesion_pa"
    with pytest.warns(UserWarning, match=r"column adhesion_pa: 1 number beyond the usual"):
        read(tmp_path, "2024-12-01,0.1,-4,0.08", "2024-12-02,0.1,-4,0", header=header)


@pytest.mark.parametrize("mark", [";", "\t", "|"])
def test_another_separator_is_named(tmp_path, mark):
    with pytest.raises(InputError, match=r"line 1: its cells are separated by .*by commas"):
        read(tmp_path, mark.join(["2024-12-01", "0,1", "", "-4"]), header=HEADER.replace(",", mark))


def test_rows_from_the_last_to_the_first_are_told_as_such(tmp_path):
    with pytest.raises(InputError, match=r"the latest row comes first: sort the rows by time"):
        read(tmp_path, "2024-12-02,0.1,,-4", "2024-12-01,0.1,,-4")


def test_a_mark_of_a_missing_value_is_told_as_such(tmp_path):
    with pytest.raises(InputError, match=r"-999 is outside .*; if it stands for a missing value"):
        read(tmp_path, "2024-12-01,-999,,-4")


def test_the_column_of_rows_cannot_be_chosen(tmp_path):
    rows = [*read(tmp_path, "2024-12-01,0.1,,-4")]
    with pytest.raises(InputError, match=r"snow from: depth: allowed with weather files only"):
        read_record(rows, snow_from="depth")


@pytest.mark.parametrize(
    ("season", "message"),
    [
        ((row for row in []), "the season: .*generator.*; needed: a DataFrame"),
        (np.zeros((3, 3)), "(?s)the season: array.*; needed: a DataFrame"),
        (
            pd.DataFrame({"snowfall_m": [0.1]}, index=[["2024-12-01"], [-4.0]]),
            "its index has 2 levels; needed: one",
        ),
    ],
    ids=["generator", "array", "levels"],
)
def test_what_is_no_table_is_refused(season, message):
    with pytest.raises(InputError, match=message):
        read_season(season)
