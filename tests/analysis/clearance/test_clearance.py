"""The clearance answer: burials, probabilities, statistics, texts."""

import json
import os
import signal
from dataclasses import replace
from datetime import date

import numpy as np
import pytest
from helpers.station_files import days, elements, ghcn
from plot.browser import check_page

from snowshed import InputError
from snowshed.analysis.clearance import (
    PanelDesign,
    SnowRanges,
    answer_text,
    required_clearance,
    split_winters,
)
from snowshed.analysis.clearance.answer import STUDY, expected_duration
from snowshed.analysis.clearance.report import write_report
from snowshed.analysis.clearance.seasons import cases_of
from snowshed.analysis.clearance.statistics import CauseShare
from snowshed.analysis.clearance.trend import Trend
from snowshed.cli.main import main
from snowshed.results.folder import read_events
from snowshed.results.season_folder import SeasonFolder
from snowshed.season import SeasonSettings, run_season
from snowshed.season.weather.generator import EXAMPLE_CLIMATE, Climate, MonthClimate
from snowshed.season.weather.source import SnowSource
from snowshed.study.errors import StudyInterrupted
from snowshed.study.table import read_table

#: A short winter, so that a season takes a second.
SHORT = Climate(
    {
        12: MonthClimate(0.08, 0.3, 1.5, 0.06, -4.0, 3.0),
        1: MonthClimate(0.08, 0.3, 1.5, 0.06, -4.0, 3.0),
        2: MonthClimate(0.0, 0.0, 1.0, 0.1, -4.0, 3.0),
    }
)
DESIGN = PanelDesign(0.6, 60.0)
KNOWN = SnowRanges(
    {"friction": (0.4, 0.4), "adhesion": (10.0, 10.0), "sliding_friction": (0.2, 0.2)}, draws=1
)
HEIGHT = 0.45


def clearance_answer(winters, folder, heights=(HEIGHT,), **options):
    return required_clearance(DESIGN, winters, heights, folder, ranges=KNOWN, **options)


@pytest.fixture(scope="module")
def winters():
    return split_winters(SHORT.winters(3, seed=3))


@pytest.fixture(scope="module")
def answer(winters, tmp_path_factory):
    folder = tmp_path_factory.mktemp("clearance") / "runs"
    return clearance_answer(winters, folder, (0.25, HEIGHT, 0.9)), folder


def test_stacks_age_between_slide_offs_as_in_a_season(answer, tmp_path):
    result, folder = answer
    case = max(result.cases, key=lambda case: sum(day.released for day in case.days))
    run = case.run_key(HEIGHT)
    table = read_table(folder, STUDY)
    rows = table[table["hash"] == run.hash]
    assert len(rows) > 1
    season = run_season(
        case.winter.days, case.panel_scene(HEIGHT), tmp_path, settings=case.settings, pictures=False
    )
    assert read_events(SeasonFolder(tmp_path).run.folder)["height_m"].tolist() == pytest.approx(
        rows["height_m"].tolist(), rel=1e-12
    )
    assert season.simulated >= len(rows)
    still = replace(case, base_settings=SeasonSettings(settling=None))
    assert still.run_key(HEIGHT).hash != run.hash


def test_burials_agree_with_those_of_seasons(answer, winters, tmp_path):
    """The study's seasons are buried as those of `run_season`, which reads other files."""
    result, _ = answer
    table = result.table().set_index(["winter", "height_m"])
    for case in result.cases:
        for height in {edge for name, edge in table.index if name == case.winter.name}:
            out = tmp_path / f"{case.winter.name[:4]}-{height:g}"
            season = run_season(
                case.winter.days,
                case.panel_scene(height),
                out,
                settings=case.settings,
                pictures=False,
            )
            touched = table.loc[(case.winter.name, height), "touched"]
            assert touched == (season.contact is not None), (case.winter.name, height)
    assert 0 < table["touched"].mean() < 1  # some seasons have a burial, some none


def test_the_required_height_lies_between_buried_and_free_heights(answer):
    result, _ = answer
    table = result.table()
    for _, own in table.groupby("case"):
        required = own["required_m"].iloc[0]
        assert (own["height_m"][own["touched"] == 1] <= required).all()
        assert (own["height_m"][own["touched"] == 0] >= required).all()


def test_a_resumed_answer_equals_an_uninterrupted_one(answer, winters, tmp_path):
    result, _ = answer

    def interrupt(progress):
        if progress.done >= 1:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(StudyInterrupted):
        clearance_answer(
            winters, tmp_path / "runs", (0.25, HEIGHT, 0.9), jobs=1, progress=interrupt
        )
    resumed = clearance_answer(winters, tmp_path / "runs", (0.25, HEIGHT, 0.9))
    assert resumed.table().to_csv() == result.table().to_csv()


@pytest.fixture(scope="module")
def report(answer, tmp_path_factory):
    """The folder of the answer's pages and files."""
    result, _ = answer
    folder = tmp_path_factory.mktemp("report")
    write_report([result], KNOWN, folder, ["a note"])
    return folder


def test_page_and_summary_contain_the_answer(report):
    page = (report / "clearance.html").read_text()
    assert "a scenario, not a statistic" in page and "Assumptions" in page
    assert "http" not in page.replace("http://www.w3.org", "")
    summary = json.loads((report / "clearance.json").read_text())
    assert [level["probability"] for level in summary["panels"][0]["levels"]] == [0.5, 0.9, 0.98]
    view = (report / "worst-winter-0.6-60.html").read_text()
    assert 'href="worst-winter-0.6-60.html"' in page and "slide-offs" in view


def test_pages_are_readable_on_telephone_and_screen(report):
    check_page(report / "clearance.html")
    check_page(report / "worst-winter-0.6-60.html")


def test_a_climate_that_changes_is_told(answer, monkeypatch):
    result, _ = answer
    monkeypatch.setattr(answer_text, "trend_of", lambda *_: Trend(-0.91, 0.01))
    assert any(
        "the heights fall by 0.91 m in ten years" in w for w in answer_text.warnings([result])
    )


def test_the_expected_duration_counts_the_seasons(winters):
    seconds, seasons = expected_duration(DESIGN, winters, [HEIGHT], ranges=KNOWN)
    assert seconds > 0.0 and seasons == 3


@pytest.mark.slow
def test_burial_probability_is_the_share_of_winters(tmp_path):
    """The probability from 200 synthetic winters agrees with burials counted in 200 others."""
    first_winters = split_winters(SHORT.winters(200, seed=11))
    other_winters = split_winters(SHORT.winters(200, seed=12))
    probability = clearance_answer(first_winters, tmp_path / "runs").burial_probability(HEIGHT)
    buried = []
    for number, case in enumerate(answer_cases(other_winters)):
        season = run_season(
            case.winter.days,
            case.panel_scene(HEIGHT),
            tmp_path / f"season-{number}",
            settings=case.settings,
            pictures=False,
        )
        buried.append(season.contact is not None)
    share = float(np.mean(buried))
    print(f"probability {probability}, share {share}")
    error = np.sqrt(2.0 * share * (1.0 - share) / 200.0)
    assert 0.05 < share < 0.95
    assert abs(probability - share) < 2.6 * error  # 99 %


def answer_cases(winters):
    return cases_of(DESIGN, winters, KNOWN.draw(len(winters)), SeasonSettings(), {})


def test_the_error_of_the_grid_follows_from_the_scheme(answer, winters):
    """A scheme without recorded runs is named, too."""
    result, _ = answer
    for base, text in (
        ({}, "(1 panel in 2D, scheme thesis, 2 to 4 cells in the slab) were"),
        ({"numerics.scheme": "objective"}, "panels in 2D, scheme objective, 2 to "),
        (
            {"numerics.transfer": "affine_flip"},
            "no stacks are recorded for scheme thesis with affine",
        ),
    ):
        cases = [replace(case, base=base) for case in result.cases]
        warning = answer_text.warnings([replace(result, cases=cases)])[0]
        assert ": the intervals contain the error of the grid, a factor of up to " in warning
        assert text in warning.split("on the height of shed snow: ")[1]
        assert warning.endswith(f"have {result.slide_offs} slide-offs (median)")


def test_disabled_relations_are_stated(answer):
    result, _ = answer
    off = SeasonSettings(settling=None, strength=None)
    cases = [replace(case, base_settings=off) for case in result.cases]
    texts = answer_text.assumptions(replace(result, cases=cases))
    assert "Snow does not settle." in texts
    assert "Strength and stiffness of a slab do not depend on its density." in texts


# --- statistics ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "cover, ground",
    [
        ("weather", "the natural snow cover of the weather file"),
        ("none", "bare ground"),
        (0.0, "bare ground"),
        (0.3, "natural snow, 0.3 m deep"),
    ],
)
def test_the_report_says_on_which_ground_the_stack_lies(answer, cover, ground):
    result, _ = answer
    cases = [replace(case, base_settings=SeasonSettings(cover=cover)) for case in result.cases]
    texts = answer_text.assumptions(replace(result, cases=cases))
    assert f"The ground is level. The stack lies on {ground}, and nobody clears it." in texts


def test_the_report_says_how_the_ground_falls(answer):
    result, _ = answer
    cases = [replace(case, base={"ground.tilt": 12.0}) for case in result.cases]
    texts = " ".join(answer_text.assumptions(replace(result, cases=cases)))
    assert "The ground falls by 12° in the slide direction." in texts


def test_the_advice_names_the_parameter_without_its_unit(answer, monkeypatch):
    result, _ = answer
    low, high = result.highest[1:]
    share = CauseShare("adhesion", 0.5, low, 0.5 * (low + high))
    monkeypatch.setattr(type(result), "shares", [share])
    text = answer_text.interval_reasons(result)
    assert "comes from the adhesion of snow to the panel (50 %). Measuring the adhesion of " in text
    rows = answer_text.range_rows(SnowRanges({"adhesion": (0.0, 150.0)}))
    assert rows == [("adhesion of snow to the panel, Pa", "0", "150")]


def test_the_sentence_rounds_the_height_up(answer, monkeypatch):
    result, _ = answer
    monkeypatch.setattr(type(result), "highest", (2.04, 1.66, 2.71))
    assert "at least 2.1 m above the ground (90 % interval 1.7 to 2.8 m)" in answer_text.sentence(
        [result]
    )


def test_warnings_that_concern_all_panels_are_given_once(answer):
    result, _ = answer
    alone = answer_text.warnings([result])
    both = answer_text.warnings([result, replace(result, design=PanelDesign(0.8, 50.0))])
    extrapolated = "98 % is extrapolated: a return period of 50 years from 3 winters"
    assert f"0.6 m at 60°: {extrapolated}" in alone and extrapolated in both
    assert len(both) == len(alone)


def test_many_panels_are_not_listed_in_the_sentence(answer):
    result, _ = answer
    panels = [replace(result, design=PanelDesign(length, 50.0)) for length in (0.6, 0.7, 0.8)]
    assert "m above the ground, depending on the panel" in answer_text.sentence(panels)
    assert "for the panel of 0.6 m at 50° and " in answer_text.sentence(panels[:2])


def test_the_typical_winter_is_not_the_worst(answer):
    result, _ = answer
    cases = result.cases
    assert cases[result.typical_case_index].winter != cases[result.worst_case_index].winter


def test_no_measurement_is_advised_that_hardly_narrows_the_interval(answer, monkeypatch):
    result, _ = answer
    low, high = result.highest[1:]
    share = CauseShare("adhesion", 0.02, low, high - 0.05 * (high - low))
    monkeypatch.setattr(type(result), "shares", [share])
    text = answer_text.interval_reasons(result)
    assert text.endswith("No measurement of the panel or the snow would narrow it by a tenth.")


def test_slabs_and_pooling_follow_the_cells(winters):
    values = KNOWN.draw(len(winters))
    for dx in (0.04, 0.02):
        case = cases_of(DESIGN, winters, values, SeasonSettings(), {"numerics.dx": dx})[0]
        assert case.settings.pool_below == pytest.approx(2.0 * dx)
        assert case.panel_scene(HEIGHT).data["numerics"]["dx"] == dx


def test_the_height_is_split_into_cover_shed_snow_and_margin(answer):
    result, _ = answer
    for index, required in enumerate(result.required):
        parts = result.height_parts(index)
        assert parts.cover + parts.pile + parts.margin == pytest.approx(required)
        assert parts.cover >= 0.0 and parts.margin == 0.1
    assert 0.0 < result.shed_part < 1.0


# --- synthetic winters --------------------------------------------------------------------------


def test_synthetic_winters_reproduce_the_climate():
    fitted = Climate.fit(EXAMPLE_CLIMATE.winters(60, seed=4))
    for month, original in EXAMPLE_CLIMATE.months.items():
        refitted = fitted.months[month]
        assert refitted.after_snow == pytest.approx(original.after_snow, abs=0.06)
        assert refitted.after_dry == pytest.approx(original.after_dry, abs=0.04)
        assert refitted.shape * refitted.scale == pytest.approx(
            original.shape * original.scale, rel=0.15
        )
        assert refitted.deviation == pytest.approx(original.deviation, rel=0.1)
    assert fitted.persistence == pytest.approx(EXAMPLE_CLIMATE.persistence, abs=0.1)


def test_a_climate_is_not_fitted_to_missing_days():
    rows = EXAMPLE_CLIMATE.winters(3, seed=4)
    unknown = [
        replace(row, snowfall=0.0, source=SnowSource.MISSING, date=row.date.replace(year=1990))
        for row in rows[:90]
    ]
    assert Climate.fit([*unknown, *rows]) == Climate.fit(rows)


def test_the_same_seed_makes_the_same_winters():
    assert SHORT.winters(2, seed=1) == SHORT.winters(2, seed=1) != SHORT.winters(2, seed=2)


# --- bad input -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--tilt", "95"], "tilt: 95 degrees; allowed: 5 to 90"),
        (["--heights", "3:1:1"], "--heights: '3:1:1' is not a number"),
        (["--range", "friction=lots"], "--range: 'friction=lots' is not of the form NAME=LOW:HIGH"),
        (["--range", "adhesoin=1:2"], "range of 'adhesoin'; allowed: friction, adhesion, sliding,"),
        (["--range", "melt=0:5"], "melt: 0 to 5 is not allowed"),
        (["--rows", "2"], "pitch: missing"),
        (["--draws", "0"], "draws: 0; allowed: 1 to 1000"),
        (["--slope-length", "-4"], "slope length: -4 m"),
    ],
)
def test_invalid_options_are_refused(options, message, tmp_path, capsys):
    file = tmp_path / "winters.csv"
    rows = "".join(
        f"{r.date.date()},{r.snowfall},{r.temperature}\n" for r in SHORT.winters(1, seed=1)
    )
    file.write_text(f"date,snowfall_m,temperature_c\n{rows}")
    command = ["clearance", str(file), "--slope-length", "1", "--tilt", "60", *options]
    assert main([*command, "-o", str(tmp_path / "out")]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_too_short_weather_is_refused():
    with pytest.raises(InputError, match=r"no winter has snow .*: 2001/02 \(22 %\)"):
        split_winters(SHORT.winters(1, seed=1)[:20])


def test_the_answer_states_how_many_winters_count(tmp_path, capsys):
    """Snow was observed in only one of three winters; the others are left out."""
    rows = [
        (day, elements(day, snow=150.0 if day.year == 2000 or day < date(2001, 7, 1) else None))
        for day in days(date(2000, 10, 1), date(2003, 5, 31))
    ]
    file, out = ghcn(tmp_path / "station.csv", rows), tmp_path / "out"
    command = ["clearance", str(file), "--slope-length", "0.6", "--tilt", "60", "--draws", "1"]
    ranges = ["--range", "friction=0.4", "--range", "adhesion=500", "--range", "sliding=0.2"]
    assert main([*command, *ranges, "--heights", "0.5,2", "-o", str(out)]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "a scenario, not a statistic, because only 1 of 3 winters counts. In it, the" in shown
    assert "the intervals contain the error of the grid, a factor of up to 1.62 on the" in shown
    assert "left out are the winters" in shown and "2001/02 to 2002/03 (0 %)" in shown
    assert "Where the snow comes from" in shown and "new snow" in shown
    summary = json.loads((out / "clearance.json").read_text())
    counts = {winter["winter"]: winter["counts"] for winter in summary["winters_of_the_file"]}
    assert counts == {"2000/01": True, "2001/02": False, "2002/03": False}
    assert summary["coverage"] == 0.9 and "1 of 3" in summary["warnings"][0]
    page = (out / "clearance.html").read_text()
    assert "1 of 3 winters" in page and "2001/02 to 2002/03 (0 %)" in page
    assert "Where the snow comes from" in page
    assert main([*command, "--coverage", "2x", "-o", str(tmp_path / "no")]) == 2
    assert "--coverage: '2x'; allowed: 0 to 1" in capsys.readouterr().err
