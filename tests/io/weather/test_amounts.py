"""Amounts of several hours and days are neither counted twice nor lost."""

import gzip
from datetime import datetime, timedelta
from pathlib import Path

import pytest
from synthetic_weather import BEGIN, epw, ghcn, hourly, meteoswiss, smet, tmy3

from snowshed import InputError
from snowshed.io.weather.amounts import Total, without_overlap

DAY = datetime(2005, 1, 10)


def water(station):
    return sum(row.precipitation or 0.0 for row in station.rows)


def snow(station):
    return sum(row.snowfall or 0.0 for row in station.rows)


def hours_with(totals, days=4, missing=("-9900", "-9900")):
    """Yield the hours of some days; `totals` holds (mm, h) by the end, in hours from the start."""
    for n, end in enumerate(hourly(DAY, DAY + timedelta(days=days)), 1):
        yield (end, -5.0, *totals.get(n, missing))


@pytest.mark.parametrize(
    ("totals", "right"),
    [
        ({34: (10, 1), 36: (10, 3), 39: (10, 6), 51: (10, 24)}, 10.0),
        ({34: (2, 1), 36: (5, 3), 39: (5, 6), 51: (9, 24)}, 9.0),
        ({6: (4, 6), 12: (3, 6), 24: (9, 24)}, 9.0),
        ({24: (9, 24), 48: (1, 24)}, 10.0),
        ({1: (1, 1), 2: (1, 1), 3: (2, 3), 6: (2, 6)}, 2.0),
        ({5: (1, 1), 6: (1, 6)}, 1.0),
        ({12: (7, 12), 24: (7, 12)}, 14.0),
    ],
)
@pytest.mark.parametrize("form", ["TMY3", "EPW"])
def test_totals_are_not_summed_with_the_hours_that_they_contain(form, totals, right, station):
    if form == "TMY3":
        read = station(tmy3(hours_with(totals)))
    else:
        rows = hours_with(totals, missing=("999", "99"))
        read = station(epw((end, warm, 999, *rain) for end, warm, *rain in rows))
    assert water(read) == pytest.approx(right)
    assert any("overlap shorter ones" in note for note in read.notes) == (
        sum(amount for amount, _ in totals.values()) > right
    )


def test_a_total_beyond_its_hours_is_left_out_with_a_note(station):
    totals = {1: (0, 1), 2: (1, 1), 3: (0, 1), 6: (236, 6), 9: (4, 1)}
    read = station(tmy3(hours_with(totals)))
    assert water(read) == 5.0
    assert any("contradict the totals within them" in note for note in read.notes)


def test_totals_over_an_unknown_time_are_left_out_with_a_note(station):
    read = station(tmy3(hours_with({5: (3, 1), 7: (2, 99)})))
    assert water(read) == 3.0
    assert any("2 mm of precipitation in 1 rows are totals over an" in n for n in read.notes)


@pytest.mark.parametrize("unknown", ["99", "0", ""])
def test_without_periods_every_row_covers_its_hour(unknown, station):
    rows = [(end, -5.0, 999, 0.5, unknown) for end in hourly(DAY, DAY + timedelta(days=2))]
    read = station(epw(rows))
    assert water(read) == pytest.approx(24.0)
    assert {row.precipitation_hours for row in read.rows} == {1.0}


def test_a_negative_period_is_refused(station):
    with pytest.raises(InputError, match=r"line 9, column liquid precipitation quantity: '-3'"):
        station(epw([(DAY + timedelta(hours=1), -5.0, 999, 0.5, "-3")]))


def test_totals_of_a_file_in_pvlib(station):
    """The hours of Sand Point sum to 3022 mm; all of its totals to 7592."""
    pvlib = pytest.importorskip("pvlib")
    file = Path(pvlib.__file__).parent / "data" / "703165TY.csv"
    if not file.is_file():
        pytest.skip("this pvlib has no such file")
    read = station(file.read_bytes())
    hours = sum(row.precipitation or 0.0 for row in read.rows if row.precipitation_hours == 1.0)
    assert hours == 3022.0
    assert water(read) == pytest.approx(3022.0, rel=0.01)


def test_totals_conserve_water_against_a_sum_by_hours():
    rain = [0.0, 1.0, 2.0, 0.0, 3.0, 4.0, 0.0, 0.0, 5.0, 0.0, 1.0, 0.0]
    ends = list(hourly(DAY, DAY + timedelta(hours=12)))
    totals = [Total(end, 1.0, own) for end, own in zip(ends, rain)]
    totals += [Total(ends[n], 3.0, sum(rain[n - 2 : n + 1])) for n in (2, 5, 8, 11)]
    totals += [Total(ends[11], 12.0, sum(rain))]
    for part in (totals, totals[12:], totals[5:]):
        amounts, _ = without_overlap(part, 1.0, "mm")
        assert sum(amounts) == pytest.approx(sum(rain))


COUNTER = [0.0, 0.2, 0.2, 1.0, 1.4, 1.4, 2.0, 3.5, 4.0, 4.0, 4.2, 5.0, 5.0, 6.1]


@pytest.mark.parametrize(
    ("values", "right"),
    [
        (COUNTER, 6.1),
        ([100.0 + value for value in COUNTER], 6.1),
        (COUNTER + [6.05, 6.12, 7.0], 7.0),  # some of it evaporates
        (COUNTER + [7.0, 8.0, 9.0, 0.0, 0.5, 1.0], 10.0),  # emptied once
        (COUNTER + [6.1] * 20, 6.1),
    ],
)
def test_a_rising_counter_is_distinguished_from_amounts(values, right, station):
    read = station(smet("TA PSUM", [f"268.15 {value:.2f}" for value in values]))
    assert water(read) == pytest.approx(right)
    assert any("it is a counter" in note for note in read.notes)


def test_a_counter_that_is_emptied_every_day(station):
    day = [0.0] * 6 + [0.5 * n for n in range(18)]
    read = station(smet("TA PSUM", [f"268.15 {value:.2f}" for value in day * 5]))
    assert water(read) == pytest.approx(5 * 8.5)


@pytest.mark.parametrize(
    "values",
    [
        [0.0, 0.2, 0.5, 1.0, 1.4, 1.6, 2.0, 3.5, 4.0, 1.0, 0.2, 0.0, 0.0, 0.0],  # a storm
        [0.1] * 30,
        [0.0] * 20 + [1.0, 2.0],
        [0.0, 0.3, 0.0, 1.0] * 8,
    ],
)
def test_amounts_are_not_taken_for_a_counter(values, station):
    rows = [f"268.15 {value:.2f}" for value in values]
    read = station(smet("TA PSUM", rows, begin=BEGIN + timedelta(hours=1)))
    assert water(read) == pytest.approx(sum(values))
    assert read.notes == []


def test_snow_can_be_a_counter_too(station):
    read = station(smet("TA HN", [f"268.15 {value / 10:.3f}" for value in COUNTER]))
    assert snow(read) == pytest.approx(0.61)


def test_amounts_cover_the_time_since_the_previous_row(station):
    text = smet("TA PSUM", ["268.15 0.0"])
    for hour, amount in ((3, 1.0), (4, 2.0), (10, 3.0), (34, 4.0), (100, 5.0)):
        text += f"{BEGIN + timedelta(hours=hour):%Y-%m-%dT%H:%M} 268.15 {amount}\n"
    rows = station(text).rows
    assert [row.precipitation_hours for row in rows[1:]] == [3.0, 1.0, 6.0, 24.0, 6.0]
    assert sum(row.precipitation for row in rows if row.precipitation) == 15.0


def test_an_amount_over_midnight_belongs_to_both_days(station):
    text = smet("TA PSUM", ["268.15 0.0", "268.15 6.0"], begin=datetime(2024, 1, 10, 20), step=6.0)
    row = station(text).rows[1]
    shares = row.shares(row.precipitation_hours)
    assert {day.day: part for day, part in shares.items()} == {10: pytest.approx(2 / 3), 11: 1 / 3}


def test_the_last_hour_of_a_day_belongs_to_it(station):
    for text in (
        epw([(end, -5.0, 999, 1.0, 1) for end in hourly(DAY, DAY + timedelta(days=1))]),
        tmy3([(end, -5.0, 1.0, 1) for end in hourly(DAY, DAY + timedelta(days=1))]),
        meteoswiss("tre200h0;rre150h0", ["-5;1.0"] * 24, begin=DAY + timedelta(hours=1)),
        smet("TA PSUM", ["268.15 1.0"] * 24, begin=DAY + timedelta(hours=1)),
    ):
        for row in station(text).rows:
            assert row.shares(row.precipitation_hours) == {DAY.date(): 1.0}


ROLLING = [0.0] * 18 + [0.01 * n for n in range(1, 13)] + [0.12] * 12
ROLLING += [0.01 * n for n in range(11, -1, -1)] + [0.0] * 40


def test_rolling_sums_of_snow_are_recognised(station):
    read = station(smet("TA HN24", [f"268.15 {value:.3f}" for value in ROLLING]))
    assert read.rolling == {"snowfall"} and read.columns["snowfall"] == "HN24"
    assert {row.snowfall_hours for row in read.rows} == {24.0}
    daily = station(smet("TA HN24", ["268.15 0.1"] * 5, step=24.0))
    assert daily.rolling == frozenset() and snow(daily) == pytest.approx(0.5)


@pytest.mark.parametrize(("title", "hours"), [("rre024i0", 24), ("rre006i0", 6), ("rre003i0", 3)])
def test_rolling_sums_of_precipitation_are_thinned_out(title, hours, station):
    rain = [0.0] * 30 + [1.0] * 12 + [0.0] * 54
    sums = [sum(rain[max(n - hours + 1, 0) : n + 1]) for n in range(len(rain))]
    read = station(meteoswiss(f"tre200h0;{title}", [f"-5;{total}" for total in sums]))
    assert water(read) == pytest.approx(12.0)
    assert any("which do not overlap" in note for note in read.notes)


def test_the_choice_between_two_sums_is_noted(station):
    read = station(meteoswiss("tre200h0;rre150h0;rre024i0", ["-5;1.0;24.0"] * 48))
    assert water(read) == 47.0  # the first amount fell on the day before
    assert "the first rre150h0 (1) fell on the day before the file begins, and is left out" in [
        *read.notes
    ]
    assert read.columns["precipitation"] == "rre150h0"
    assert "precipitation is that of rre150h0 (48 values); not used: rre024i0 (48 values)" in [
        *read.notes
    ]


def test_a_column_with_values_is_preferred_to_an_empty_one(station):
    read = station(meteoswiss("tre200d0;hto000d0;htoautd0", ["-5;;30"] * 9 + ["-5;31;30"], step=24))
    assert read.columns["snow_depth"] == "htoautd0"
    assert {row.snow_depth for row in read.rows} == {0.3}
    read = station(smet("TA HN24 HN", ["268.15 0.24 0.01"] * 24))
    assert read.columns["snowfall"] == "HN" and read.rolling == frozenset()


MULTIDAY = ghcn(
    (1, "SNOW", 0), (2, "SNOW", 51), (5, "MDSF", 305), (5, "DASF", 3), (6, "SNOW", 0),
    (9, "MDPR", 300), (9, "DAPR", 3), (9, "TMAX", -10), (9, "TMIN", -90), (10, "PRCP", 20),
)  # fmt: skip


def check_multiday(read):
    assert snow(read) == pytest.approx(0.356) and water(read) == pytest.approx(32.0)
    by_day = {row.time.day: row for row in read.rows}
    assert by_day[5].snowfall_hours == 72.0 and by_day[9].precipitation_hours == 72.0
    assert [day.day for day in by_day[5].shares(72.0)] == [3, 4, 5]
    assert any("1 amounts of several days (MDSF), 0.305 m" in note for note in read.notes)
    assert any("1 amounts of several days (MDPR), 30 mm" in note for note in read.notes)


def fixed_width(rows):
    """Return by_station rows as lines of fixed width."""
    months = {}
    for line in rows.splitlines():
        _, date, element, value, measurement, quality, *_ = line.split(",")
        months.setdefault(element, {})[int(date[6:])] = (int(value), measurement, quality)
    return "\n".join(
        f"USC00999999202401{element}"
        + "".join("{:5d}{:1}{:1}7".format(*days.get(day, (-9999, "", ""))) for day in range(1, 32))
        for element, days in months.items()
    )


def summaries(rows):
    """Return by_station rows as daily summaries of the archive."""
    days, elements = {}, []
    for line in rows.splitlines():
        _, date, element, value, measurement, quality, *_ = line.split(",")
        days.setdefault(date, {})[element] = (value, f"{measurement},{quality},7,0800")
        elements += [element] if element not in elements else []
    names = [part for element in elements for part in (element, f"{element}_ATTRIBUTES")]
    text = ",".join(f'"{cell}"' for cell in ("STATION", "DATE", "LATITUDE", *names)) + "\n"
    for date, cell_by_element in sorted(days.items()):
        cells = ["USC00999999", f"{date[:4]}-{date[4:6]}-{date[6:]}", "-45.1"]
        cells += [part for element in elements for part in cell_by_element.get(element, ("", ""))]
        text += ",".join(f'"{cell}"' for cell in cells) + "\n"
    return text


LAYOUTS = {
    "by station": str,
    "gzip": lambda rows: gzip.compress(rows.encode()),
    "fixed width": fixed_width,
    "summaries": summaries,
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_amounts_of_several_days_count_over_their_days(layout, station):
    read = station(LAYOUTS[layout](MULTIDAY))
    check_multiday(read)
    assert read.latitude == (-45.1 if layout == "summaries" else None)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_amounts_over_unknown_days_cover_the_time_since_the_last(layout, station):
    rows = "".join(line for line in MULTIDAY.splitlines(True) if "DASF" not in line)
    read = station(LAYOUTS[layout](rows))
    assert {row.time.day: row.snowfall_hours for row in read.rows}[5] == 72.0
    assert any("1 without a number of days" in note for note in read.notes)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_flags_of_measurement_and_quality(layout, station):
    rows = ghcn(
        (1, "SNOW", 0, "T", ""), (2, "SNOW", 0, "P", ""), (3, "SNOW", 99, "", "X"),
        (4, "SNOW", 12), (2, "PRCP", 10), (3, "PRCP", 11, "P", ""), (3, "TMAX", 1),
    )  # fmt: skip
    read = station(LAYOUTS[layout](rows))
    by_day = {row.time.day: row for row in read.rows}
    assert [by_day[day].snowfall for day in (1, 2, 3, 4)] == [0.0, None, None, 0.012]
    assert by_day[3].precipitation is None
    assert "1 values failed a check of quality, and are left out" in read.notes
    assert "2 values are missing and only presumed to be 0, and are left out" in read.notes


@pytest.mark.parametrize("layout", ["by station", "summaries"])
def test_repeated_days_must_agree(layout, station):
    rows = ghcn((1, "SNOW", 10), (2, "SNOW", 20), (2, "SNOW", 30))
    text = LAYOUTS[layout](rows.rsplit("\n", 2)[0] + "\n")
    contradiction = LAYOUTS[layout](rows).splitlines()[-1]
    assert len(station(text + text.splitlines()[-1] + "\n").rows) == 2  # repeated values
    with pytest.raises(InputError, match="SNOW of 2024-01-02 occurs twice with different"):
        station(text + contradiction + "\n")


def test_the_number_of_days_of_a_total_must_be_positive(station):
    with pytest.raises(InputError, match=r"line 2, column DATA_VALUE \(DASF\): '0'; allowed: 1 to"):
        station(ghcn((5, "MDSF", 305), (5, "DASF", 0)))


def test_an_amount_of_acis_covers_the_days_before_it(station):
    head = "Date,maxt,mint,pcpn,snow,snwd\n"
    days = ["0.00,0.0,10", "S,S,10", "S,S,M", "0.94A,12.0A,22", "M,M,M", "0.10,T,20", "0.5A,M,M"]
    read = station(
        head + "".join(f"2024-01-0{n},28,17,{cells}\n" for n, cells in enumerate(days, 1))
    )
    by_day = {row.time.day: row for row in read.rows}
    assert by_day[4].snowfall == pytest.approx(12 * 0.0254) and by_day[4].snowfall_hours == 72.0
    assert by_day[4].precipitation_hours == 72.0 and by_day[7].precipitation_hours == 24.0
    assert by_day[2].snowfall is None and by_day[6].snowfall == 0.0
    assert water(read) == pytest.approx(25.4 * 1.54)
