"""Times: offsets from universal time, summer time, and typical and actual years."""

from datetime import date, datetime, timedelta, timezone

import pytest
from synthetic_weather import epw, hourly, imis, meteoswiss, smet, tmy3

from snowshed import InputError
from snowshed.io.weather.observation import time_of
from snowshed.io.weather.smet import read_smet
from snowshed.io.weather.swiss import FORMATS as SWISS_TIMES


def local(begin, count, step=0.5):
    """Return times of Central Europe with their offsets, across 29 October 2023."""
    change = datetime(2023, 10, 29, 1, tzinfo=timezone.utc)
    times = []
    for n in range(count):
        time = begin + timedelta(hours=step * n)
        times.append(time.astimezone(timezone(timedelta(hours=2 if time < change else 1))))
    return times


BEFORE = datetime(2023, 10, 28, 12, tzinfo=timezone.utc)
#: Spellings of an offset.
WRITINGS = {
    "+02:00": lambda time: time.isoformat(" "),
    "+0200": lambda time: time.strftime("%Y-%m-%d %H:%M%z"),
    "T": lambda time: time.isoformat(),
    "hours": lambda time: time.isoformat()[:-3],
}


@pytest.mark.parametrize("form", ["IMIS", "SMET", "iCSV", "table"])
@pytest.mark.parametrize("writing", WRITINGS)
def test_times_with_offsets_are_unique_at_the_end_of_summer_time(form, writing, written):
    from snowshed.io.weather.joined import read_stations

    times = [WRITINGS[writing](time) for time in local(BEFORE, 60)]
    if form == "IMIS":
        text = imis(times)
    elif form == "SMET":
        rows = "".join(f"{time.replace(' ', 'T')} 268.15 0.3\n" for time in times)
        text = smet("TA HS", []) + rows
    elif form == "iCSV":
        text = "# iCSV 1.0 UTF-8\n# fields = timestamp,TA,HS\n# [DATA]\n"
        text += "".join(f"{time},268.15,0.3\n" for time in times)
    else:
        text = "date,temperature_c\n" + "".join(f"{time},-5\n" for time in times)
    read = read_stations([written(text)])
    steps = {later.time - earlier.time for earlier, later in zip(read.rows, read.rows[1:])}
    assert steps == {timedelta(minutes=30)} and len(read.rows) == 60
    assert read.utc_offset == 1.0 and read.rows[0].time == datetime(2023, 10, 28, 13)
    assert any("2 UTC offsets; they are converted to UTC+1 h" in note for note in read.notes)


def test_a_single_offset_is_kept(station):
    read = station(imis([f"2024-01-01 {hour:02d}:00:00-07:00" for hour in range(24)]))
    assert read.utc_offset == -7.0 and read.rows[0].time == datetime(2024, 1, 1)
    read = station(imis([f"2024-01-01T{hour:02d}:00:00Z" for hour in range(24)]))
    assert read.utc_offset == 0.0


def test_offsets_in_only_some_rows_are_refused(station):
    times = ["2024-01-01 00:00:00+00:00", "2024-01-01 01:00:00"]
    with pytest.raises(InputError, match="01:00:00 has no UTC offset, but line 2 has one"):
        station(imis(times))
    with pytest.raises(InputError, match=r"line 3, .* has a UTC offset, but line 2 has none"):
        station(imis(times[::-1]))


def with_repeated_hour(form):
    """Return a file in local time, where the hour from 2 to 3 occurs twice."""
    begin = datetime(2024, 10, 26)
    times = [begin + timedelta(hours=n) for n in range(27)]
    times += [times[-1] + timedelta(hours=n) for n in range(0, 20)]
    if form == "IMIS":
        return imis([f"{time:%Y-%m-%d %H:%M}" for time in times])
    if form == "SMET":
        rows = (f"{time:%Y-%m-%dT%H:%M} 268.15 0.3\n" for time in times)
        return smet("TA HS", []) + "".join(rows)
    rows = (f"XYZ;{time:%d.%m.%Y %H:%M};-5;0.1\n" for time in times)
    return meteoswiss("tre200h0;rre150h0", []) + "".join(rows)


def test_every_day_of_eight_digits_is_its_own_day():
    """1 November 1953 is no minute of 1 January (as 1953-1-1 0:1 would be)."""
    first = date(2023, 1, 1)
    for number in range(365):
        day = first + timedelta(number)
        moment = datetime(day.year, day.month, day.day)
        assert time_of(f"{day:%Y%m%d}", "here", *SWISS_TIMES) == moment
        later = moment.replace(hour=23, minute=50)
        assert time_of(f"{later:%Y%m%d%H%M}", "here", *SWISS_TIMES) == later


@pytest.mark.parametrize("form", ["IMIS", "SMET", "MeteoSwiss"])
def test_a_repeated_hour_of_local_time_is_refused(form, station):
    with pytest.raises(InputError, match=r"is not after .*this hour occurs twice"):
        station(with_repeated_hour(form))


def test_unsorted_days_are_not_taken_for_summer_time(station):
    with pytest.raises(InputError, match="is not after line 2") as error:
        station(imis(["2024-01-05", "2024-01-04", "2024-01-06"]))
    assert "summer" not in str(error.value)


@pytest.mark.parametrize("step", [0.5, 1.0])
def test_a_missing_hour_of_local_time_is_noted(step, station):
    begin = datetime(2024, 3, 30)
    times = [begin + timedelta(hours=step * n) for n in range(int(48 / step))]
    summer_times = [time for time in times if not (time.day == 31 and time.hour == 2)]
    read = station(imis([f"{time:%Y-%m-%d %H:%M}" for time in summer_times]))
    assert any("is missing, as at the beginning of summer time" in note for note in read.notes)
    complete = station(imis([f"{time:%Y-%m-%d %H:%M}" for time in times]))
    assert complete.notes == []


@pytest.mark.parametrize("year", ["0024", "0202", "2924"])
def test_an_impossible_year_is_refused(year, station):
    with pytest.raises(InputError, match=r"line 2, column date: the year [0-9]+; allowed:"):
        station(imis([f"{year}-01-04", "2984-01-06"]))


def test_a_time_without_universal_time_is_refused(station):
    with pytest.raises(InputError, match="line 2, column date"):
        station(imis(["0001-01-01T00:00:00+10:00", "0001-01-02T00:00:00+09:00"]))


def year(number, months=range(1, 13), depth=0):
    begin, end = datetime(number, months[0], 1), datetime(number + months[-1] // 12,
                                                          months[-1] % 12 + 1, 1)  # fmt: skip
    return [(time, -5.0, depth, 0.1, 1) for time in hourly(begin, end) if time.hour % 6 == 0]


def typical(years, depths):
    return [row for month, (number, depth) in enumerate(zip(years, depths), 1)
            for row in year(number, [month], depth)]  # fmt: skip


YEARS = (1999, 2003, 2001, 2000, 2000, 2000, 2002, 2003, 2001, 2000, 1998, 2005)
DEPTHS = (10, 70, 15, 0, 0, 0, 0, 0, 0, 0, 5, 40)


@pytest.mark.parametrize("latitude", [46.5, -45.0])
def test_a_typical_year_begins_in_summer_and_has_seams(latitude, station):
    read = station(epw(typical(YEARS, DEPTHS), latitude))
    south = latitude < 0.0
    assert read.typical_year and read.latitude == latitude
    assert read.rows[0].time.month == (1 if south else 7)
    assert len({row.time.year for row in read.rows}) == (1 if south else 2)
    assert all(a.time < b.time for a, b in zip(read.rows, read.rows[1:]))
    jumps = [later for earlier, later in zip(read.rows, read.rows[1:])
             if later.snow_depth != earlier.snow_depth]  # fmt: skip
    assert len(jumps) == (5 if south else 6) and all(row.seam for row in jumps)
    assert sum(row.seam for row in read.rows) == 9  # not between months of one year
    assert any("it is a typical year" in note for note in read.notes)


def test_typical_years_of_tmy3_have_seams_too(station):
    rows = [(time, warm, rain, hours) for time, warm, _, rain, hours in typical(YEARS, DEPTHS)]
    for latitude in (46.5, -45.0):
        read = station(tmy3(rows, latitude))
        assert read.typical_year and read.latitude == latitude and len(read.rows) == 1460
        assert sum(row.seam for row in read.rows) == 9


def test_a_calendar_year_gets_a_seam_at_new_year(station):
    read = station(epw(year(2019)))
    assert read.typical_year and [row.time for row in read.rows if row.seam] == [
        datetime(2002, 1, 1, 5, 59)
    ]
    assert any("all of its months have the year 2019" in note for note in read.notes)


@pytest.mark.parametrize(
    "rows",
    [
        year(2019) + year(2020),
        year(2019) + year(2020) + year(2021),
        year(2019, range(7, 13)) + year(2020, range(1, 7)),  # a winter
        year(2019) + year(2021),  # a year is missing between them
        year(2020, range(11, 13)) + year(2021, range(1, 4)),
        year(2020, range(1, 4)),
    ],
)
@pytest.mark.parametrize("form", ["EPW", "TMY3"])
def test_actual_years_are_not_rearranged(form, rows, station):
    tmy3_rows = [(time, warm, rain, hours) for time, warm, _, rain, hours in rows]
    read = station(epw(rows) if form == "EPW" else tmy3(tmy3_rows))
    assert not read.typical_year and len(read.rows) == len(rows)
    assert read.rows[0].time == rows[0][0] - timedelta(minutes=1)
    assert not any(row.seam for row in read.rows)
    assert any("are taken as actual ones" in note for note in read.notes)


def test_two_typical_years_in_a_file_are_refused(station):
    rows = typical(YEARS, DEPTHS)
    with pytest.raises(InputError, match=r"07-01 05:59 occurs twice, also in line [0-9]+"):
        station(epw(rows + rows))


def test_positions_of_stations_are_read(station):
    icsv = (
        "# iCSV 1.0 UTF-8\n# geometry = POINTZ(170.5 -45.9 120)\n# srid = EPSG:4326\n"
        "# timezone = 12\n# fields = timestamp,TA\n# [DATA]\n2024-01-01T00:00:00,268.15\n"
    )
    read = station(icsv)
    assert (read.latitude, read.longitude, read.altitude) == (-45.9, 170.5, 120.0)
    assert read.utc_offset == 12.0
    read = station(smet("TA HS", ["268.15 0.3"]))
    assert (read.latitude, read.longitude, read.altitude, read.utc_offset) == (46.5, 9.8, 2000, 1)
    read = station(smet("TA HS", ["268.15 0.3"]).replace("46.5", "-999").replace("9.8", "-999"))
    assert read.latitude is None
    with pytest.raises(InputError, match=r"line 4, column latitude: '146.5'; allowed: -90 <="):
        station(smet("TA HS", ["268.15 0.3"]).replace("46.5", "146.5"))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("20240131T120000", datetime(2024, 1, 31, 12)),
        ("20240131", datetime(2024, 1, 31)),
        ("2024-01-31T12", datetime(2024, 1, 31, 12)),
        ("2024-01-31 12:00:01.5Z", datetime(2024, 1, 31, 12, 0, 1, 500000, timezone.utc)),
        ("20240131T1200-0330", datetime(2024, 1, 31, 15, 30, tzinfo=timezone.utc)),
        ("2024-02-29", datetime(2024, 2, 29)),
    ],
)
def test_all_forms_of_iso_times_are_read_on_all_versions_of_python(text, expected):
    """Python's own reader learnt the basic form in version 3.11."""
    assert time_of(text, "here") == expected


@pytest.mark.parametrize(
    "text",
    ["2024-01-31+01:00", "2024-W05-1", "2024-1-31", "2024-01-31T24:00", "2023-02-29", "2024-0131",
     "2024-01-31T1200:00", "2024-01-31T12:60", "20240131T12:00:0", "", "2024-01-31T12:00+25:00"],
)  # fmt: skip
def test_other_texts_are_no_times(text):
    with pytest.raises(InputError, match="is not a date such as 2024-12-31T06:00"):
        time_of(text, "here")


def test_comments_among_the_rows_of_smet_are_left_out():
    """The format allows both signs, in a line of their own or behind a row."""
    rows = ["268.15 0.0"] * 48
    plain = smet("TA PSUM", rows)
    lines = plain.splitlines(keepends=True)
    first = lines.index("[DATA]\n") + 1
    lines[first] = lines[first].rstrip("\n") + " ; maintenance\n"
    lines[first + 1 : first + 1] = ["; the sensor was moved\n", "  # and cleaned\n"]
    expected, read = (read_smet("a.smet", text.splitlines()) for text in (plain, "".join(lines)))
    assert [row.time for row in read.rows] == [row.time for row in expected.rows]
    assert len(read.rows) == 48
