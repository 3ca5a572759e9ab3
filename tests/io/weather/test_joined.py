"""Several files of the same station."""

import json
import subprocess
import sys
from datetime import datetime, timedelta

import pandas as pd
import pytest
from helpers.weather_files import EPW
from synthetic_weather import ghcn, meteoswiss, smet

from snowshed import InputError
from snowshed.io import read_stations
from snowshed.season import read_season
from snowshed.season.weather.reading import read_weather

BEGIN = datetime(2022, 12, 1)
SNOW = meteoswiss("rre150d0;hns000d0;hto000d0", ["5.0;12;30", "0.0;0;30", "0;0;30"] * 4,
                  BEGIN, 24.0)  # fmt: skip
WARM = meteoswiss("tre200h0;rre150h0;htoauths", [f"{-4 + n % 2};0.5;" for n in range(288)], BEGIN)


def test_snow_and_temperature_of_a_station_in_two_files(written):
    snow, warm = written(SNOW, "nime.csv"), written(WARM, "smn.csv")
    with pytest.raises(InputError, match="no air temperature in any row"):
        read_season(snow)
    for rows, notes in (read_weather([snow, warm]), read_weather(snow, temperature=warm)):
        assert [row.date for row in rows] == [BEGIN + timedelta(n) for n in range(12)]
        assert sum(row.snowfall for row in rows) == pytest.approx(0.48)
        assert {row.temperature for row in rows} == {-3.5}
        assert {row.snow_depth for row in rows} == {0.3}
        for note in (
            "the temperature is from tre200h0 of smn.csv on 12 days",
            "precipitation is from rre150d0 of nime.csv on 12 days",
            "new snow is from hns000d0 of nime.csv on 12 days",
        ):
            assert note in notes
    assert read_season((str(snow), str(warm))) == rows


def test_water_of_two_files_does_not_count_twice(written):
    snow, warm = written(SNOW, "nime.csv"), written(WARM, "smn.csv")
    for files, total in (((snow, warm), 20.0), ((warm, snow), 143.5)):
        rows = read_stations(files).rows
        assert sum(row.precipitation or 0.0 for row in rows) == pytest.approx(total)


def test_files_of_successive_periods_are_joined(written):
    rows = ["-5.0;5.0;12;30"] * 3
    first, second, third = (
        written(meteoswiss("tre200d0;rre150d0;hns000d0;hto000d0", rows, begin, 24.0), f"{n}.csv")
        for n, begin in enumerate((BEGIN, BEGIN + timedelta(3), BEGIN + timedelta(5)))
    )
    read = read_stations([second, first, third])
    assert [row.time.day for row in read.rows] == [1, 2, 3, 4, 5, 6, 7, 8]
    assert sum(row.snowfall for row in read.rows) == pytest.approx(8 * 0.12)
    assert not any(row.seam for row in read.rows)  # one series of depths
    parts = "hns000d0 of 1.csv on 3 days, hns000d0 of 0.csv on 3 days, hns000d0 of 2.csv on 2 days"
    assert f"new snow is from {parts}" in read.notes


def test_the_source_of_the_depth_changes_at_a_seam(written):
    hand = written(smet("HS", ["0.30", "0.32"], begin=BEGIN, step=24.0), "hand.smet")
    sensor = written(smet("TA HS", ["268.15 0.60"] * 4, begin=BEGIN, step=24.0), "sensor.smet")
    read = read_stations([hand, sensor])
    assert [(row.snow_depth, row.seam) for row in read.rows] == [
        (0.30, False), (0.32, False), (0.60, True), (0.60, False),
    ]  # fmt: skip
    assert read.columns["snow_depth"] == "HS of hand.smet and HS of sensor.smet"


def test_a_requested_thermometer_takes_precedence(written):
    first = written(smet("TA HS", ["268.15 0.3"] * 3, step=24.0), "a.smet")
    second = written(smet("TA HS", ["263.15 0.9"] * 2, step=24.0), "b.smet")
    read = read_stations([first], temperature=second)
    assert [row.temperature for row in read.rows] == pytest.approx([-10.0, -10.0, -5.0])
    assert {row.snow_depth for row in read.rows} == {0.3}
    with pytest.raises(InputError, match=r"c.smet: no temperature of the air in any row"):
        read_stations([first], temperature=written(smet("HS", ["0.3"]), "c.smet"))


@pytest.mark.parametrize(
    ("column", "cell"), [("temperature_c", -4.0), ("temperature_c,snow_depth_m", "-4.0,0.3")]
)
def test_a_plain_table_completes_a_station(column, cell, written):
    snow = written(ghcn(*((day, "SNOW", 51 * (day % 2)) for day in range(1, 7))), "snow.csv")
    table = f"# by hand\ndate,{column}\n" + "".join(
        f"2024-01-{day:02d},{cell}\n" for day in range(1, 7)
    )
    rows, _ = read_weather(snow, temperature=written(table, "warm.csv"))
    assert {row.temperature for row in rows} == {-4.0}
    assert sum(row.snowfall for row in rows) == pytest.approx(0.153)
    with pytest.raises(InputError, match=r"line 2: .* unknown column 'warmth'; allowed: date,"):
        read_weather(snow, temperature=written(table.replace("temperature_c", "warmth"), "w.csv"))
    with pytest.raises(InputError, match=r"line 3, column temperature_c: '-4.0x' is not a number"):
        read_weather(snow, temperature=written(table.replace("-4.0", "-4.0x", 1), "w.csv"))


def test_periods_without_a_common_day_are_refused(written):
    later = meteoswiss("tre200h0", ["-4"] * 48, BEGIN + timedelta(400))
    with pytest.raises(InputError, match=r"have no day in common: a\.csv from 2022-12-01 to"):
        read_stations([written(SNOW, "a.csv"), written(later, "b.csv")])


def test_differing_names_and_positions_are_noted(written):
    snow = written(smet("HS", ["0.30"] * 3, step=24.0), "a.smet")
    text = smet("TA", ["268.15"] * 3, step=24.0)
    text = text.replace("= made", "= Other").replace("46.5", "46.6").replace("2000", "2300")
    notes = read_stations([snow, written(text, "b.smet")]).notes
    assert "b.smet is of Other, and a.smet of made; they are taken as one station" in notes
    assert "the stations of a.smet and b.smet are 11.1 km apart" in notes
    assert "the altitudes of a.smet and b.smet differ by 300 m" in notes


def test_times_are_converted_to_the_clock_of_the_first_file(written):
    hours = [f"{268.15 + n % 24:.2f}" for n in range(48)]
    snow = written(smet("HS", ["0.3"] * 48), "a.smet")  # UTC+1
    text = smet("TA", hours).replace("tz = 1", "tz = 0")
    read = read_stations([snow, written(text, "b.smet")])
    assert read.rows[0].temperature is None and read.rows[1].temperature == pytest.approx(-5.0)
    assert any("b.smet is converted from UTC+0 h to the clock of a.smet, UTC+1 h" in n
               for n in read.notes)  # fmt: skip


def test_impossible_combinations_of_files_are_refused(written):
    epw, snow = written(EPW, "a.epw"), written(SNOW, "nime.csv")
    with pytest.raises(InputError, match=r"a.epw: a typical year of the format EPW"):
        read_stations([epw, snow])
    with pytest.raises(InputError, match="201 weather files; at most 200"):
        read_stations([snow] * 201)
    frame = pd.DataFrame({"date": ["2024-01-01"], "snowfall_m": [0.1], "temperature_c": [-3.0]})
    with pytest.raises(InputError, match="is allowed with weather files only"):
        read_weather(frame, temperature=snow)


def test_a_file_that_adds_nothing_is_noted(written):
    text = smet("TA HS", ["268.15 0.3"] * 3, step=24.0)
    notes = read_stations([written(text, "a.smet"), written(text, "b.smet")]).notes
    assert "b.smet adds nothing" in notes


def commands(tmp_path, *arguments):
    code = [sys.executable, "-m", "snowshed", *arguments, "-o", "out"]
    return subprocess.run(code, cwd=tmp_path, capture_output=True, text=True)


@pytest.mark.parametrize(
    "files", [["nime.csv", "smn.csv"], ["nime.csv", "--temperature", "smn.csv"]]
)
def test_commands_take_several_files(files, written, tmp_path):
    written(SNOW, "nime.csv")
    written(WARM, "smn.csv")
    panel = ("--dim", "2", "--height", "1", "--length", "1", "--tilt", "10", "--dx", "0.05")
    done = commands(tmp_path, "season", *files, *panel)
    assert done.returncode == 0, done.stderr
    output = " ".join((done.stdout + done.stderr).split())
    assert "the temperature is from tre200h0 of smn.csv on 12 days" in output
    notes = json.loads((tmp_path / "out" / "season.json").read_text())["notes"]
    assert "new snow is from hns000d0 of nime.csv on 12 days" in notes


def test_clearance_takes_several_files(written, tmp_path):
    written(meteoswiss("hns000d0", ["12", "0", "0"] * 70, BEGIN, 24.0), "nime.csv")
    written(meteoswiss("tre200d0", ["-4"] * 210, BEGIN, 24.0), "smn.csv")
    panel = ("--slope-length", "2", "--tilt", "60", "--coverage", "0.5", "--dry-run")
    done = commands(tmp_path, "clearance", "nime.csv", "--temperature", "smn.csv", *panel)
    assert done.returncode == 0, done.stderr
    assert "1 winter" in done.stdout + done.stderr
    assert commands(tmp_path, "clearance", "nime.csv", "smn.csv", *panel).returncode == 0


def test_a_list_of_snowfalls_stays_a_list_beside_a_thermometer(written):
    snowfalls = ((1, 0.15), (5, 0.22), (12, 0.10))
    table = "date,snowfall_m\n" + "".join(f"2022-12-{day:02d},{fall}\n" for day, fall in snowfalls)
    rows, notes = read_weather(written(table, "own.csv"), temperature=written(WARM, "smn.csv"))
    assert [(row.date.day, row.snowfall) for row in rows if row.snowfall] == [*snowfalls]
    assert [row.date.day for row in rows] == [*range(1, 13)]
    assert any(note.startswith("own.csv: it lists snowfalls; each counts on the") for note in notes)
