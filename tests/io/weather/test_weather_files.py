"""Every format: files in the layout of their providers, and five damages to each."""

import gzip
import re
import zipfile

import pandas as pd
import pytest
from helpers import weather_files
from helpers.weather_files import FILES, METEOSWISS, NEW_SNOW, VARIANTS

from snowshed import InputError
from snowshed.io import read_station
from snowshed.io.weather.recognise import FORMATS
from snowshed.season import read_season
from snowshed.season.weather.gauge import snow_fraction
from snowshed.season.weather.reading import read_weather
from snowshed.snow.relations.new_snow import hedstrom_pomeroy_1998

BY_RULE = 24.0 / hedstrom_pomeroy_1998(-7.0)  # m
BY_DEPTH = 0.3  # m


def written(folder, content):
    file = folder / "station.txt"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return file


def check(file, fallen, rounding=0.0):
    rows, notes = read_weather(file)
    assert [(row.date.month, row.date.day) for row in rows] == [(1, 1), (1, 2), (1, 3)]
    temperatures = [row.temperature for row in rows]
    assert temperatures == pytest.approx([-5.0, -7.0, -6.0], abs=0.01 + rounding)
    assert rows[1].snowfall == pytest.approx(fallen, abs=1e-3)
    assert rows[0].snowfall == rows[2].snowfall == 0.0
    return rows, notes


def test_every_format_has_files():
    assert FILES.keys() == FORMATS.keys()
    assert all(len(damages) == 5 for _, _, damages in FILES.values())


@pytest.mark.parametrize("form", FILES)
def test_files_in_the_layout_of_their_provider_are_read(form, tmp_path):
    text, measured, _ = FILES[form]
    lines = text.splitlines()
    assert [name for name, layout in FORMATS.items() if layout.recognises(lines)] == [form]
    fallen = measured or (BY_DEPTH if form == "IMIS" else BY_RULE)
    rows, notes = check(written(tmp_path, text), fallen)
    if form != "TMY3":
        assert rows[1].snow_depth == pytest.approx(1.4, abs=0.01)
    if form not in ("TMY3", "iCSV"):
        assert rows[2].snow_depth is None  # missing, or failed a check of quality
    if measured is None:
        assert any("new snow follows" in note or "daily rise" in note for note in notes)
    check(written(tmp_path, text.replace("\n", "\r\n")), fallen)
    check(written(tmp_path, b"\xef\xbb\xbf" + text.encode()), fallen)


@pytest.mark.parametrize(
    ("form", "_", "content", "measured"), VARIANTS, ids=lambda value: str(value)[:40]
)
def test_other_layouts_of_providers_are_read(form, _, content, measured, tmp_path):
    file = written(tmp_path, content)
    assert read_station(file).format == form.partition(",")[0]
    rounded = form == "GHCN-daily, summaries" and '"18"' in str(content)  # whole degrees F
    check(file, NEW_SNOW if measured else BY_RULE, 0.3 if rounded else 0.0)


@pytest.mark.parametrize(
    ("form", "line", "old", "new", "message"),
    [(form, *damage) for form, (_, _, damages) in FILES.items() for damage in damages],
)
def test_a_damaged_file_is_refused_by_line_and_column(form, line, old, new, message, tmp_path):
    lines = FILES[form][0].split("\n")
    assert old in lines[line - 1], lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(old, new, 1)
    file = written(tmp_path, "\n".join(lines))
    with pytest.raises(InputError) as error:
        read_season(file)
    assert str(error.value).startswith(f"{file}, {message}")
    assert re.match("line [0-9]+, column .+: ", message)


@pytest.mark.parametrize(
    ("column", "value", "message"),
    [
        ("snowfall_m", "lots", "row 2, column snowfall_m: 'lots' is not a number"),
        ("snowfall_m", 30.0, "row 2, column snowfall_m: 30 is outside the allowed range"),
        ("temperature_c", 266.15, "row 2, column temperature_c: 266.15 is outside"),
        ("temperature_c", None, "row 2, column temperature_c: empty; give a number"),
        ("date", "2024-13-02", "row 2, column date: '2024-13-02' is not a date"),
    ],
)
def test_a_damaged_frame_is_refused_by_row_and_column(column, value, message):
    frame = pd.DataFrame(
        {"date": ["2024-01-01", "2024-01-02"], "snowfall_m": [0.2, 0.1], "temperature_c": [-5, -7]},
        dtype=object,
    )
    assert len(read_season(frame)) == 2
    frame.loc[1, column] = value
    with pytest.raises(InputError, match=f"^the season, {re.escape(message)}"):
        read_season(frame)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("HINTERALP\n2024-01-01,28,17,T\n", "line 2, column 1: rows of ACIS without the names"),
        ("SMET 1.1 BINARY\n[HEADER]\n", "line 1, column 3: 'BINARY'; allowed: ASCII"),
        ("# iCSV 1.0 UTF-8 2DTIMESERIES\n", "line 1, column 5: 2DTIMESERIES holds profiles"),
        (
            weather_files.summaries(lambda *_: "0", weather_files.ORDERED),
            "line 2, column TMAX: without a decimal in any row, its units are ambiguous",
        ),
        (  # in mm or in inches: either has amounts with one decimal
            weather_files.summaries(
                lambda name, value: "" if name[0] == "T" else weather_files.metric(name, value),
                weather_files.ORDERED,
            ),
            "line 2, column TMAX: with one decimal, as mm and inches have, and no temperature",
        ),
        (  # edited by hand
            weather_files.summaries(
                lambda name, value: (
                    weather_files.metric if name[0] == "T" else weather_files.standard
                )(name, value),
                weather_files.ORDERED,
            ),
            "line 2, column TMAX: with decimals of temperatures, and those of inches",
        ),
        (  # the data service writes whole degrees F in the order of the archive, too
            re.sub(r',"[^"]*_ATTRIBUTES"|,"[^"]*,7,0800"', "", weather_files.summaries()),
            "line 2, column TMAX: without a decimal in any row, its units are ambiguous",
        ),
        (
            weather_files.ICSV_UNITS.replace("|cm|", "|feet|"),
            "line 13, column units: 'feet' of HS; allowed: m, cm, mm",
        ),
        (weather_files.ICSV_UNITS.replace("|TA", "|T"), None),
        (weather_files.SMET.replace("timestamp", "time"), "line 14, column fields: neither"),
    ],
)
def test_unreadable_files_are_refused_with_the_reason(content, message, tmp_path):
    file = written(tmp_path, content)
    with pytest.raises(InputError, match=re.escape(f"{file}, {message}" if message else str(file))):
        read_season(file)


def test_damaged_packed_files_are_refused(tmp_path):
    packed = gzip.compress(weather_files.BY_STATION.encode())
    for damaged, message in (
        (packed[:60], "gzip: it ends too early"),
        (packed[:20] + b"\xff" * 30, "damaged: gzip"),
        (b"PK\x03\x04...", "a zip archive; unpack it"),
    ):
        with pytest.raises(InputError, match=message):
            read_season(written(tmp_path, damaged))


def test_a_packed_file_does_not_fill_the_memory(tmp_path):
    file = written(tmp_path, gzip.compress(b"0" * (65 << 20), 1))
    with pytest.raises(InputError, match="longer than 64 MB when unpacked"):
        read_season(file)


def test_slightly_negative_depths_become_zero(tmp_path):
    text = METEOSWISS.replace(";0;110", ";0;-4")
    assert read_season(written(tmp_path, text))[0].snow_depth == 0.0
    with pytest.raises(InputError, match="line 2, column htoautd0: -40 is outside"):
        read_season(written(tmp_path, METEOSWISS.replace(";0;110", ";0;-40")))


def test_older_epw_files_have_only_depths(tmp_path):
    rows = re.sub("^199[0-9],", "1996,", weather_files.epw_rows(older=True), flags=re.MULTILINE)
    text = weather_files.EPW_HEADER + rows  # days of one year, without a seam between them
    notes = check(written(tmp_path, text), BY_DEPTH)[1]
    assert any("new snow is the daily rise" in note for note in notes)
    nothing = re.sub(",(110|140|999),88", ",999,88", text)
    with pytest.raises(InputError, match=r"neither new snow, .* in any row of this EPW file"):
        read_season(written(tmp_path, nothing))


def test_daily_files_of_the_slf_have_no_temperature(tmp_path):
    text = "station_code,measure_date,hyear,HS,HN_1D\nHAL2,2024-01-01T06:00:00Z,2024,110.0,0.0\n"
    with pytest.raises(InputError, match="no air temperature in any row of this IMIS file"):
        read_season(written(tmp_path, text))


def test_gaps_are_noted(tmp_path):
    later = METEOSWISS.replace("03.01.2024", "09.01.2024")
    _, notes = read_weather(written(tmp_path, later))
    assert any("6 days are missing in 1 gap, from 2024-01-03" in note for note in notes)


def test_days_out_of_order_are_refused(tmp_path):
    twice = METEOSWISS.replace("03.01.2024", "02.01.2024")
    with pytest.raises(InputError, match=r"line 4, column date: .* is not after line 3"):
        read_season(written(tmp_path, twice))


def test_the_snow_fraction_decreases_between_snow_and_rain():
    assert snow_fraction(-1.1) == 1.0 and snow_fraction(3.3) == 0.0
    assert snow_fraction(0.0) == pytest.approx(0.75)


def test_plain_tables_are_not_stations(tmp_path):
    assert (
        read_station(written(tmp_path, "date,snowfall_m,temperature_c\n2024-01-01,0.1,-3\n"))
        is None
    )


@pytest.mark.parametrize(
    "entry",
    ["[Content_Types].xml", "xl/workbook.xml"],
)
def test_a_workbook_is_told_as_such(tmp_path, entry):
    with zipfile.ZipFile(tmp_path / "winter.xlsx", "w") as book:
        book.writestr(entry, "<x/>")
    with pytest.raises(InputError, match="a workbook of a spreadsheet program; save its sheet as"):
        read_season(tmp_path / "winter.xlsx")
