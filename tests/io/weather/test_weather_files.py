"""Every format: a file as its provider writes it, and five damaged ones."""

import pytest
from weather_files import FILES, METEOSWISS, SMET

from snowshed import InputError
from snowshed.io.weather import FORMATS, read_station
from snowshed.run.season import read_season
from snowshed.run.season.observed import snow_fraction
from snowshed.run.season.weather import read_weather
from snowshed.snow.relations.new_snow import hedstrom_pomeroy_1998


def written(folder, text):
    file = folder / "station.txt"
    file.write_text(text)
    return file


def test_every_format_has_files():
    assert FILES.keys() == FORMATS.keys()


@pytest.mark.parametrize("form", FILES)
def test_a_file_as_its_provider_writes_it(form, tmp_path):
    text, fallen, _ = FILES[form]
    file = written(tmp_path, text)
    assert [one.recognises(text.splitlines()) for one in FORMATS.values()].count(True) == 1
    rows, notes = read_weather(file)
    assert [row.temperature for row in rows] == pytest.approx([-5.0, -7.0, -6.0])
    by_rule = 24.0 / hedstrom_pomeroy_1998(-7.0)
    by_depth = 0.3
    expected = fallen or (by_depth if form == "IMIS" else by_rule)
    assert rows[1].snowfall == pytest.approx(expected, abs=1e-3)
    assert rows[0].snowfall == rows[2].snowfall == 0.0
    if form in ("SMET", "iCSV", "EPW", "MeteoSwiss", "IMIS", "GHCN-daily, fixed width"):
        assert rows[1].snow_depth == pytest.approx(1.4)
    if fallen is None:
        assert any("new snow follows" in note or "daily rise" in note for note in notes)


@pytest.mark.parametrize(
    ("form", "old", "new", "message"),
    [(form, *damage) for form, (_, _, damages) in FILES.items() for damage in damages],
)
def test_a_damaged_file_is_refused_by_line_and_column(form, old, new, message, tmp_path):
    text = FILES[form][0]
    assert old in text
    file = written(tmp_path, text.replace(old, new, 1))
    with pytest.raises(InputError) as error:
        read_season(file)
    assert message in str(error.value)
    assert str(error.value).startswith(str(file))


def test_units_of_a_smet_file_are_converted(tmp_path):
    header = "units_offset = 0 273.15 0 0 0\nunits_multiplier = 1 1 0.01 0.01 1\n"
    text = SMET.replace("[DATA]", f"{header}[DATA]")
    for kelvin, cell in (("268.15", "-5"), ("266.15", "-7"), ("267.15", "-6")):
        text = text.replace(kelvin, cell)
    for metres, cell in ((" 1.10 ", " 110 "), (" 1.40 ", " 140 "), (" 1.35 ", " 135 ")):
        text = text.replace(metres, cell)
    rows = read_season(written(tmp_path, text))
    assert (rows[1].temperature, rows[1].snow_depth) == pytest.approx((-7.0, 1.4))


def test_gaps_are_told(tmp_path):
    later = METEOSWISS.replace("03.01.2024", "09.01.2024")
    _, notes = read_weather(written(tmp_path, later))
    assert any("6 days are missing in 1 gaps, the longest from 2024-01-03" in one for one in notes)


def test_days_out_of_order_are_refused(tmp_path):
    twice = METEOSWISS.replace("03.01.2024", "02.01.2024")
    with pytest.raises(InputError, match=r"line 4, column date: .* is not after line 3"):
        read_season(written(tmp_path, twice))


def test_between_all_snow_and_all_rain_the_part_of_snow_falls():
    assert snow_fraction(-1.1) == 1.0 and snow_fraction(3.3) == 0.0
    assert snow_fraction(0.0) == pytest.approx(0.75)


def test_no_station_is_a_plain_table(tmp_path):
    assert (
        read_station(written(tmp_path, "date,snowfall_m,temperature_c\n2024-01-01,0.1,-3\n"))
        is None
    )
