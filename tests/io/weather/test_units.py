"""Units of files: read from the header, and refused if the numbers cannot be in them."""

import re

import pytest
from synthetic_weather import ghcn, imis, meteoswiss, smet

from snowshed import InputError

DEPTHS = (0.0, 0.10, 0.35, 0.30, 0.55, 0.50, 0.80, 0.78, 0.95, 1.10)  # m, by days


def depths_by(factor, step=24.0):
    return smet("TA HS", [f"268.15 {factor * depth:.4f}" for depth in DEPTHS], step=step)


def test_factors_of_a_header_are_applied(station):
    text = smet(
        "TA HS PSUM", ["-5.0 110 0.94"] * 3,
        "units_multiplier = 1 1 0.01 25.4\nunits_offset = 0 273.15 0 0\n",
    )  # fmt: skip
    row = station(text).rows[1]
    assert row.temperature == pytest.approx(-5.0) and row.snow_depth == pytest.approx(1.1)
    assert row.precipitation == pytest.approx(0.94 * 25.4)


@pytest.mark.parametrize(
    ("units", "cells"),
    [
        ("K,m,mm", "268.15,1.1,24"),
        ("degC,cm,kg/m2", "-5,110,24"),
        ("°F,in,in", "23,43.307,0.94488"),
        ("degF,mm,cm", "23,1100,2.4"),
        ("kelvin,inches,m", "268.15,43.307,0.024"),
    ],
)
def test_units_of_an_icsv_are_applied(units, cells, station):
    head = f"# iCSV 1.0 UTF-8\n# fields = timestamp,TA,HS,PSUM\n# units = -,{units}\n# [DATA]\n"
    rows = "".join(f"2024-01-{day:02d}T00:00:00,{cells}\n" for day in range(1, 4))
    for factors in ("", "# units_multipliers = 1,1,1,1\n# units_offsets = 0,0,0,0\n"):
        row = station(head.replace("# [DATA]", f"{factors}# [DATA]") + rows).rows[1]
        assert row.temperature == pytest.approx(-5.0, abs=1e-3)
        assert row.snow_depth == pytest.approx(1.1, abs=1e-4)
        assert row.precipitation == pytest.approx(24.0, abs=1e-3)


def test_a_factor_may_repeat_its_unit_but_not_contradict_it(station):
    head = (
        "# iCSV 1.0 UTF-8\n# fields = timestamp,TA,HS\n# units = -,K,cm\n"
        "# units_multipliers = 1,1,{}\n# [DATA]\n2024-01-01T00:00:00,268.15,110\n"
    )
    assert station(head.format("0.01")).rows[0].snow_depth == pytest.approx(1.1)
    with pytest.raises(InputError, match=r"line 3, column units: 'cm' of HS, and a factor 0\.001"):
        station(head.format("0.001"))


@pytest.mark.parametrize("unit", ["mm/h", "m s-1", "kg m-2 s-1", "ft"])
def test_a_unit_of_another_quantity_is_refused(unit, station):
    head = f"# iCSV 1.0 UTF-8\n# fields = timestamp,TA,PSUM\n# units = -,K,{unit}\n# [DATA]\n"
    with pytest.raises(InputError, match=f"column units: '{re.escape(unit)}' of PSUM; allowed: mm"):
        station(head + "2024-01-01T00:00:00,268.15,1.1\n")


@pytest.mark.parametrize("factor", [100.0, 1000.0, 39.37])
def test_a_depth_in_another_unit_is_refused_with_the_likely_one(factor, station):
    with pytest.raises(InputError, match=r"column HS: .*is it (really )?in (m|cm, mm or inches)\?"):
        station(depths_by(factor))
    with pytest.raises(InputError, match=r"column HS: half of the changes .* in cm, mm or"):
        station(depths_by(min(factor, 13.0)))
    assert len(station(depths_by(1.0)).rows) == 10


@pytest.mark.parametrize("step", [1.0, 24.0])
@pytest.mark.parametrize("warm", [268.15, 293.15])
def test_spikes_of_a_sensor_are_not_taken_for_another_unit(step, warm, station):
    rows = [f"{warm} {3.0 if n % 5 == 2 else 0.3}" for n in range(100)]
    assert len(station(smet("TA HS", rows, step=step)).rows) == 100


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (smet("TA HN", [f"268.15 {n % 2}" for n in range(20)], step=24.0),
         "column HN: half of the snowfalls are 1 m and more; is it in cm, mm or inches?"),
        (smet("TA PSUM", [f"268.15 {n % 2 * 240}" for n in range(20)], step=24.0),
         "column PSUM: half of the amounts are 240 mm and more; is it in tenths"),
        (smet("TA PSUM", ["268.15 0"] * 5 + ["268.15 600"]),
         "line 16, column PSUM: 600 mm in 1 hours; no more than 491 mm was ever measured"),
        (meteoswiss("tre200d0;rre150d0;hns000d0", ["-5;240;30", "-6;0;0"] * 6, step=24.0),
         "column rre150d0: half of the amounts are 240 mm"),
        (meteoswiss("tre200d0;rre150d0;hns000d0", ["-5;90;11", "-6;0;0"] * 6, step=24.0),
         "column rre150d0: 540 mm of water fell as 0.66 m of new snow below -2 °C, of 818 kg/m3"),
        (meteoswiss("tre200d0;hns000d0", ["23;30", "20;0"] * 6, step=24.0),
         "column tre200d0: half of the snow fell at 23 °C and more; is it in degrees F?"),
        (meteoswiss("tre200d0;hns000d0", ["-50;30", "-60;0"] * 6, step=24.0),
         "column tre200d0: half of the snow fell at -50 °C and less; is it in tenths of degrees"),
        (imis([f"2024-01-{day:02d}" for day in range(1, 13)], 23.0,
              [10 * n + 10 * (n % 2) for n in range(12)]),
         "column TA_30MIN_MEAN: half of the snow fell at 23 °C and more; is it in degrees F?"),
        ("Date,maxt,mint,pcpn,snow\n" + "".join(
            f"2024-01-{day:02d},-2.1,-8.0,{24 * (day % 2)}.0,{30 * (day % 2)}.0\n"
            for day in range(1, 13)),  # in degrees C, mm and cm
         "column snow: half of the snowfalls are 0.762 m and more"),
    ],
)  # fmt: skip
def test_implausible_numbers_are_refused_with_a_likely_unit(text, message, written):
    from snowshed.io import read_station

    file = written(text)
    with pytest.raises(InputError, match=re.escape(f"{file}, {message}")):
        read_station(file)


def test_depths_that_seem_to_be_in_metres_are_noted(station):
    times = [f"2024-01-{day:02d}" for day in range(1, 11)]
    read = station(imis(times, depths=[f"{depth + 0.003:.3f}" for depth in DEPTHS]))
    assert any("never exceeds 1.1 cm, with parts of a millimetre" in note for note in read.notes)
    shallow = station(imis(times, depths=[round(10 * depth) for depth in DEPTHS]))
    assert shallow.notes == []


@pytest.mark.parametrize("nodata", ["-999", "-9999", "-99.9", "nan", "NULL"])
def test_missing_values_follow_the_header(nodata, station):
    rows = [f"268.15 {nodata}", f"{nodata} 0.3", "268.15 0.3"]
    read = station(smet("TA HS", rows).replace("nodata = -999", f"nodata = {nodata}"))
    assert [row.snow_depth for row in read.rows] == [None, 0.3, 0.3]
    assert read.rows[1].temperature is None


def test_unread_columns_are_noted(station):
    read = station(meteoswiss("tre200d0;rre150d0;rreetpd0;htonewd9", ["-5;1;2;3"] * 3, step=24.0))
    assert "not read: rreetpd0, htonewd9" in read.notes


def test_snow_depth_alone_is_sufficient_for_a_station(station):
    read = station(smet("HS RH", [f"{depth} 0.5" for depth in DEPTHS], step=24.0))
    assert read.quantities == {"snow_depth"} and dict(read.columns) == {"snow_depth": "HS"}
    assert station(ghcn((1, "SNWD", 300), (2, "SNWD", 310))).quantities == {"snow_depth"}


def test_json_is_refused_with_advice(station):
    with pytest.raises(InputError, match="JSON; the weather of a station is read from tables"):
        station('{"meta": {"name": "A"}, "data": [["2024-01-01", "28", "17", "T", "T", "43"]]}')


def test_new_snow_in_metres_is_noted(station):
    rows = ["-5.0;0.12"] * 6
    text = meteoswiss("tre200d0;hns000d0", rows, step=24.0)  # its unit is the centimetre
    notes = station(text).notes
    assert "hns000d0 never exceeds 0.12 cm, although 6 values are not 0; check that it is " in str(
        notes
    )
    assert not any("never" in note for note in station(text.replace("0.12", "1.2")).notes)


def test_precipitation_in_metres_is_noted(station):
    notes = station(smet("TA PSUM", ["268.15 0.004"] * 6, step=24.0)).notes
    assert any(note.startswith("PSUM never exceeds 0.004 mm, although 6") for note in notes)


@pytest.mark.parametrize("mark", ["99.9", "999", "999.9"])
def test_precipitation_that_repeats_a_mark_of_missing_values_is_refused(mark, station):
    rows = ["-5.0;1.2"] * 4 + [f"-5.0;{mark}", "-5.0;0.4", f"-5.0;{mark}"]
    text = meteoswiss("tre200d0;rre150d0", rows, step=24.0)
    with pytest.raises(InputError, match=f"column rre150d0: {mark} mm occurs 2 times, first in li"):
        station(text)
    assert station(text.replace(f";{mark}", ";12.3", 1)).rows  # a single storm


def test_a_mark_of_missing_values_is_told_as_such(station):
    with pytest.raises(InputError, match=r"32767 is outside .*; if it stands for a missing value"):
        station(meteoswiss("tre200d0", ["-5.0", "32767"], step=24.0))


def test_a_file_that_begins_with_its_latest_row_is_told_as_such(station):
    head, *rows = imis([f"2023-12-01T00:{minute}:00+00:00" for minute in ("00", "30")]).split("\n")
    with pytest.raises(InputError, match="the latest row comes first: sort the rows by time"):
        station("\n".join([head, rows[1], rows[0]]))
