"""The quality of winters: coverage, names, both hemispheres, gaps of years."""

from datetime import date

import pytest
from helpers.station_files import days, elements, ghcn, warmth

from snowshed import InputError, SnowshedNote
from snowshed.analysis.clearance import split_winters
from snowshed.cli.main import main
from snowshed.cli.options.weather import ShareType
from snowshed.season import SeasonSettings, accumulate, read_season
from snowshed.season.weather.reading import read_record

SPAN = (date(2000, 7, 1), date(2005, 6, 30))
ALL = [(day, elements(day)) for day in days(*SPAN)]


def winters(folder, rows, coverage=0.9):
    return read_record(ghcn(folder / "station.csv", rows)).winters(coverage)


def names(quality):
    return [winter.name for winter in quality.counted]


def test_observed_winters_count(tmp_path):
    quality = winters(tmp_path, ALL)
    assert names(quality) == ["2000/01", "2001/02", "2002/03", "2003/04", "2004/05"]
    assert quality.excluded_text == "" and quality.counted_text == "5 of 5 winters"


def test_only_winters_with_observed_snow_count(tmp_path):
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
    quality = winters(tmp_path, rows)
    assert quality.counted_text == "2 of 5 winters"
    assert quality.excluded_text == "2002/03 to 2004/05 (0 %)"
    by_gauge = read_record(tmp_path / "station.csv", "gauge").winters()
    assert by_gauge.counted_text == "5 of 5 winters"


def test_summers_at_the_ends_are_not_counted_as_winters(tmp_path):
    """The same five winters with and without the months before and after."""
    longer = [(day, elements(day)) for day in days(date(2000, 5, 1), date(2005, 10, 31))]
    quality, expected = winters(tmp_path, longer), winters(tmp_path, ALL)
    assert names(quality) == names(expected)
    assert [w.snowfall for w in quality.counted] == [w.snowfall for w in expected.counted]
    assert quality.excluded_text == "1999/00 (0 %), 2005/06 (0 %)"


def test_an_observed_winter_without_snow_counts(tmp_path):
    rows = [
        (day, row | ({"SNOW": 0.0} if date(2002, 7, 1) <= day < date(2003, 7, 1) else {}))
        for day, row in ALL
    ]
    quality = winters(tmp_path, rows)
    assert quality.counted_text == "5 of 5 winters"
    assert quality.winters[2].snowfall == 0.0


@pytest.mark.parametrize(
    ("missing", "excluded"),
    [
        (lambda day: (day.year, day.month) == (2003, 1), "2002/03 (74 %)"),
        (lambda day: day < date(2001, 2, 1), "2000/01 (48 %)"),
        (lambda day: date(2001, 7, 1) <= day < date(2003, 7, 1), "2001/02 to 2002/03 (no rows)"),
        (lambda day: date(2003, 1, 1) <= day <= date(2003, 1, 9), ""),
        (lambda day: day.month in (5, 6, 7, 8, 9, 10), ""),
    ],
)
def test_incomplete_winters_are_excluded_by_name(tmp_path, missing, excluded):
    quality = winters(tmp_path, [(day, row) for day, row in ALL if not missing(day)])
    assert quality.excluded_text == excluded


def test_a_calendar_year_contains_no_complete_winter(tmp_path):
    file = ghcn(tmp_path / "x.csv", [(day, row) for day, row in ALL if day.year == 2002])
    with pytest.warns(SnowshedNote):
        rows = read_season(file)
    with pytest.raises(InputError, match=r"no winter .*: 2001/02 \(7. %\), 2002/03 \(2. %"):
        split_winters(rows)
    with pytest.warns(SnowshedNote, match="left out are the winters"):
        assert [winter.name for winter in split_winters(rows, 0.7)] == ["2001/02"]


def test_the_required_coverage_can_be_set(tmp_path):
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
    quality = winters(tmp_path, southern(date(2000, 1, 1), date(2003, 12, 31)))
    assert names(quality) == ["2000", "2001", "2002", "2003"]
    cut = winters(tmp_path, southern(date(2000, 8, 1), date(2003, 7, 15)))
    assert names(cut) == ["2001", "2002"]


def table(folder, rows):
    file = folder / "table.csv"
    file.write_text(
        "date,snowfall_m,temperature_c\n" + "".join(f"{a},{b},{c}\n" for a, b, c in rows)
    )
    return file


def daily(first, last, is_missing=lambda day: False):
    return [
        (day, 0.1 if day.toordinal() % 9 == 0 else 0, -4)
        for day in days(first, last)
        if not is_missing(day)
    ]


def test_tables_with_missing_days_are_split_like_stations(tmp_path):
    two_winters = [
        *daily(date(2010, 11, 1), date(2011, 4, 30)),
        *daily(date(2015, 11, 1), date(2016, 4, 30)),
    ]
    quality = read_record(table(tmp_path, two_winters)).winters()
    assert quality.counted_text == "2 of 6 winters"
    assert quality.excluded_text == "2011/12 to 2014/15 (no rows)"
    weekdays = daily(date(2010, 11, 1), date(2011, 4, 30), lambda day: day.weekday() > 4)
    assert read_record(table(tmp_path, weekdays)).winters().counted_text == "1 of 1 winter"
    without_january = daily(date(2010, 11, 1), date(2011, 4, 30), lambda day: day.month == 1)
    assert read_record(table(tmp_path, without_january)).winters().counted_text == "0 of 1 winter"


def test_a_list_of_snowfalls_is_complete(tmp_path):
    falls = [
        (date(y, m, 9), 0.3, -4)
        for y, m in ((2010, 12), (2011, 2), (2011, 12), (2012, 3), (2014, 1))
    ]
    quality = read_record(table(tmp_path, falls)).winters()
    assert names(quality) == ["2010/11", "2011/12", "2013/14"]
    assert any("lists snowfalls" in note for note in quality.notes)


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
def test_a_mistyped_year_is_refused(tmp_path, dates, message):
    with pytest.raises(InputError, match=message):
        read_record(table(tmp_path, [(day, 0.1, -5) for day in dates]))


def test_a_season_of_two_winters_is_refused(tmp_path):
    two_winters = [
        *daily(date(2010, 11, 1), date(2011, 4, 30)),
        *daily(date(2015, 11, 1), date(2016, 4, 30)),
    ]
    rows = read_season(table(tmp_path, two_winters))
    with pytest.raises(InputError, match="line 183, column date: 2015-11-01 is 1646 days after"):
        accumulate(rows, SeasonSettings(), 40.0)


def test_impossible_amounts_of_snow_are_refused(tmp_path):
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


def test_records_with_long_gaps_are_read(tmp_path):
    """Ten thousand days in two blocks half a century apart."""
    rows = [*daily(date(1900, 1, 1), date(1913, 6, 30)), *daily(date(1960, 7, 1), date(1974, 1, 1))]
    quality = read_record(table(tmp_path, rows)).winters()
    assert len(quality.winters) == 75 and len(quality.counted) == 26
    assert "1913/14 to 1959/60 (no rows)" in quality.excluded_text


def test_the_season_command_reports_the_sources_of_snow(tmp_path, capsys):
    rows = [(day, row) for day, row in ALL if date(2003, 11, 1) <= day < date(2004, 1, 20)]
    file = ghcn(tmp_path / "x.csv", rows)
    panel = ["--height", "1", "--length", "1", "--tilt", "20", "--dim", "2", "--dx", "0.1"]
    assert main(["season", str(file), *panel, "-o", str(tmp_path / "out")]) == 0
    output = capsys.readouterr().out
    assert "Where the snow comes from" in output and "2003/04" in output
    assert "the snow of 2003/04 was observed on 50 of" in output
    assert "snow_source" in (tmp_path / "out" / "season.csv").read_text().splitlines()[0]
    assert '"observed_days": 50' in (tmp_path / "out" / "season.json").read_text()
