"""The quality of winters: coverage, names, north and south, gaps of years."""

from datetime import date

import pytest
from helpers.station_files import days, elements, ghcn, warmth

from snowshed import InputError, SnowshedNote
from snowshed.analysis import split_winters
from snowshed.cli.main import main
from snowshed.cli.weather_options import ShareType
from snowshed.season import SeasonSettings, accumulate, read_season
from snowshed.season.weather import read_record

SPAN = (date(2000, 7, 1), date(2005, 6, 30))
ALL = [(day, elements(day)) for day in days(*SPAN)]


def winters(folder, rows, coverage=0.9):
    return read_record(ghcn(folder / "station.csv", rows)).winters(coverage)


def names(found):
    return [winter.name for winter in found.counted]


def test_winters_that_were_observed_count(tmp_path):
    found = winters(tmp_path, ALL)
    assert names(found) == ["2000/01", "2001/02", "2002/03", "2003/04", "2004/05"]
    assert found.excluded_text == "" and found.counted_text == "5 of 5 winters"


def test_snow_observed_in_two_of_five_winters_is_two_winters(tmp_path):
    rows = [
        (
            day,
            {
                **row,
                "SNOW": row["SNOW"] if day < date(2002, 7, 1) else None,
                "PRCP": row["SNOW"] / 2,
            },
        )
        for day, row in ALL
    ]
    found = winters(tmp_path, rows)
    assert found.counted_text == "2 of 5 winters"
    assert found.excluded_text == "2002/03 to 2004/05 (0 %)"
    by_gauge = read_record(tmp_path / "station.csv", "gauge").winters()
    assert by_gauge.counted_text == "5 of 5 winters"


def test_summers_at_the_ends_are_no_snowless_winters(tmp_path):
    """The same five winters with and without the months before and after."""
    longer = [(day, elements(day)) for day in days(date(2000, 5, 1), date(2005, 10, 31))]
    found, same = winters(tmp_path, longer), winters(tmp_path, ALL)
    assert names(found) == names(same)
    assert [w.snowfall for w in found.counted] == [w.snowfall for w in same.counted]
    assert found.excluded_text == "1999/00 (0 %), 2005/06 (0 %)"


def test_a_winter_without_snow_that_was_observed_counts(tmp_path):
    rows = [
        (day, row | ({"SNOW": 0.0} if date(2002, 7, 1) <= day < date(2003, 7, 1) else {}))
        for day, row in ALL
    ]
    found = winters(tmp_path, rows)
    assert found.counted_text == "5 of 5 winters"
    assert found.winters[2].snowfall == 0.0


@pytest.mark.parametrize(
    ("missing", "left_out"),
    [
        (lambda day: (day.year, day.month) == (2003, 1), "2002/03 (74 %)"),
        (lambda day: day < date(2001, 2, 1), "2000/01 (48 %)"),
        (lambda day: date(2001, 7, 1) <= day < date(2003, 7, 1), "2001/02 to 2002/03 (no rows)"),
        (lambda day: date(2003, 1, 1) <= day <= date(2003, 1, 9), ""),
        (lambda day: day.month in (5, 6, 7, 8, 9, 10), ""),
    ],
)
def test_incomplete_winters_are_left_out_by_name(tmp_path, missing, left_out):
    found = winters(tmp_path, [(day, row) for day, row in ALL if not missing(day)])
    assert found.excluded_text == left_out


def test_a_calendar_year_is_no_two_winters(tmp_path):
    file = ghcn(tmp_path / "x.csv", [(day, row) for day, row in ALL if day.year == 2002])
    with pytest.warns(SnowshedNote):
        rows = read_season(file)
    with pytest.raises(InputError, match=r"no winter .*: 2001/02 \(7. %\), 2002/03 \(2. %"):
        split_winters(rows)
    with pytest.warns(SnowshedNote, match="left out are the winters"):
        assert [winter.name for winter in split_winters(rows, 0.7)] == ["2001/02"]


def test_the_coverage_decides(tmp_path):
    rows = [(day, row) for day, row in ALL if not date(2003, 1, 1) <= day <= date(2003, 1, 14)]
    assert len(winters(tmp_path, rows, 0.9).counted) == 4
    assert len(winters(tmp_path, rows, 0.8).counted) == 5
    with pytest.raises(InputError, match=r"coverage: 1\.5; allowed: a share from 0 to 1"):
        winters(tmp_path, rows, 1.5)
    assert [ShareType().convert(text, None, None) for text in ("0.8", "80", "80%", 1)] == [
        0.8,
        0.8,
        0.8,
        1.0,
    ]


def southern(first, last):
    for day in days(first, last):
        snow = 120.0 if day.month in (6, 7, 8, 9) and day.toordinal() % 6 == 0 else 0.0
        mean = 10.0 * warmth(day, south=True)
        yield day, {"TMAX": mean + 40.0, "TMIN": mean - 40.0, "SNOW": snow}


def test_in_the_south_a_winter_lies_within_a_year(tmp_path):
    found = winters(tmp_path, southern(date(2000, 1, 1), date(2003, 12, 31)))
    assert names(found) == ["2000", "2001", "2002", "2003"]
    cut = winters(tmp_path, southern(date(2000, 8, 1), date(2003, 7, 15)))
    assert names(cut) == ["2001", "2002"]


def table(folder, rows):
    file = folder / "table.csv"
    file.write_text(
        "date,snowfall_m,temperature_c\n" + "".join(f"{a},{b},{c}\n" for a, b, c in rows)
    )
    return file


def daily(first, last, leave_out=lambda day: False):
    return [
        (day, 0.1 if day.toordinal() % 9 == 0 else 0, -4)
        for day in days(first, last)
        if not leave_out(day)
    ]


def test_tables_with_days_left_out_are_cut_as_stations_are(tmp_path):
    two = [
        *daily(date(2010, 11, 1), date(2011, 4, 30)),
        *daily(date(2015, 11, 1), date(2016, 4, 30)),
    ]
    found = read_record(table(tmp_path, two)).winters()
    assert found.counted_text == "2 of 6 winters"
    assert found.excluded_text == "2011/12 to 2014/15 (no rows)"
    holes = daily(date(2010, 11, 1), date(2011, 4, 30), lambda day: day.weekday() > 4)
    assert read_record(table(tmp_path, holes)).winters().counted_text == "1 of 1 winter"
    month = daily(date(2010, 11, 1), date(2011, 4, 30), lambda day: day.month == 1)
    assert read_record(table(tmp_path, month)).winters().counted_text == "0 of 1 winter"


def test_a_list_of_snowfalls_tells_all_of_them(tmp_path):
    falls = [
        (date(y, m, 9), 0.3, -4)
        for y, m in ((2010, 12), (2011, 2), (2011, 12), (2012, 3), (2014, 1))
    ]
    found = read_record(table(tmp_path, falls)).winters()
    assert names(found) == ["2010/11", "2011/12", "2013/14"]
    assert any("lists snowfalls" in note for note in found.notes)


@pytest.mark.parametrize(
    ("dates", "message"),
    [
        (
            ("0224-01-01", "2024-01-02"),
            "line 3, column date: 2024-01-02 is 1800 years",
        ),
        (
            ("2023-12-01", "2024-01-02", "2204-01-05"),
            "line 4, column date: 2204-01-05 is 180 years",
        ),
        (("2024-01-01", "2042-01-02", "2042-01-05"), "line 3, column date: 2042-01-02 is 18 years"),
        (("0224-01-01", "0224-01-02"), "line 2, column date: 0224-01-01; allowed: the years 1000"),
        (("9999-12-30", "9999-12-31"), "line 2, column date: 9999-12-30; allowed: the years 1000"),
    ],
)
def test_a_year_mistyped_is_refused_at_once(tmp_path, dates, message):
    with pytest.raises(InputError, match=message):
        read_record(table(tmp_path, [(day, 0.1, -5) for day in dates]))


def test_a_season_is_one_winter(tmp_path):
    two = [
        *daily(date(2010, 11, 1), date(2011, 4, 30)),
        *daily(date(2015, 11, 1), date(2016, 4, 30)),
    ]
    rows = read_season(table(tmp_path, two))
    with pytest.raises(InputError, match="line 183, column date: 2015-11-01 is 1646 days after"):
        accumulate(rows, SeasonSettings(), 40.0)


def test_more_snow_than_ever_is_in_other_units(tmp_path):
    hours = [f"2024-12-01T{hour:02d}:00" for hour in range(24)]
    with pytest.raises(InputError, match=r"line 2, column snowfall_m: 8.4 m of snow on 2024-12-01"):
        read_record(table(tmp_path, [(hour, 0.35, -5) for hour in hours]))
    read_record(table(tmp_path, [(hour, 0.02, -5) for hour in hours]))
    falls = [(day, 0.6, -4) for day in days(date(2010, 11, 1), date(2011, 4, 30))]
    with pytest.raises(
        InputError, match=r"36.6 m of snow in the year .* no winter had more than 28.96 m"
    ):
        read_record(table(tmp_path, falls))
    single = [("2024-12-01", 0.2, -4), ("2024-12-11", 2.5, -4)]  # ten days in a row
    assert len(read_record(table(tmp_path, single)).rows) == 2


def test_long_records_cost_no_loop_over_their_gaps(tmp_path):
    """Ten thousand days in two blocks half a century apart."""
    rows = [*daily(date(1900, 1, 1), date(1913, 6, 30)), *daily(date(1960, 7, 1), date(1974, 1, 1))]
    found = read_record(table(tmp_path, rows)).winters()
    assert len(found.winters) == 75 and len(found.counted) == 26
    assert "1913/14 to 1959/60 (no rows)" in found.excluded_text


def test_the_season_command_tells_where_the_snow_comes_from(tmp_path, capsys):
    rows = [(day, row) for day, row in ALL if date(2003, 11, 1) <= day < date(2004, 1, 20)]
    file = ghcn(tmp_path / "x.csv", rows)
    panel = ["--height", "1", "--length", "1", "--tilt", "20", "--dim", "2", "--dx", "0.1"]
    assert main(["season", str(file), *panel, "-o", str(tmp_path / "out")]) == 0
    shown = capsys.readouterr().out
    assert "Where the snow comes from" in shown and "2003/04" in shown
    assert "the snow of 2003/04 was observed on 50 of" in shown
    assert "snow_source" in (tmp_path / "out" / "season.csv").read_text().splitlines()[0]
    assert '"observed_days": 50' in (tmp_path / "out" / "season.json").read_text()
