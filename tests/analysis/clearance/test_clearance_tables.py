"""Tables of the clearance answer, snow on the panel, and the choice of grids."""

import json
import re
import time
from dataclasses import replace
from datetime import datetime, timedelta

import numpy as np
import pandas as pd
import pytest
from plot.browser import open_page

from snowshed import Scene
from snowshed.analysis.clearance import (
    PanelDesign,
    SnowRanges,
    required_clearance,
    split_winters,
)
from snowshed.analysis.clearance.answer_text import panel_name, warnings
from snowshed.analysis.clearance.grid_error import choose_grid, recorded_grid_error
from snowshed.analysis.clearance.panel_snow import mean_months
from snowshed.analysis.clearance.report import write_report
from snowshed.analysis.clearance.seasons import SeasonOutcome, cases_of, required_height
from snowshed.analysis.clearance.tables import write_tables
from snowshed.analysis.clearance.trend import trend_of
from snowshed.base.notes import SnowshedNote
from snowshed.cli.main import main
from snowshed.plot.clearance_figure import design_figure
from snowshed.season import SeasonSettings, Weather, accumulate
from snowshed.season.rows import PanelRows
from snowshed.season.weather.generator import Climate, MonthClimate

MONTHS = {month: MonthClimate(0.08, 0.3, 1.5, 0.06, -4.0, 3.0) for month in (12, 1, 2)}
WINTERS = split_winters(Climate(MONTHS).winters(2, seed=3))
DEFAULT_CELL = 4.0 / 60.0  # of a panel of 4 m
KNOWN = SnowRanges(
    {"friction": (0.4, 0.4), "adhesion": (10.0, 10.0), "sliding_friction": (0.2, 0.2)}, draws=1
)


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    folder = tmp_path_factory.mktemp("clearance") / "runs"
    return required_clearance(PanelDesign(0.6, 60.0), WINTERS, [0.45], folder, ranges=KNOWN)


def test_tables_hold_the_heights_the_burials_and_the_snow_on_the_panel(result, tmp_path):
    assert write_tables([result], tmp_path, price=100.0) == ["heights.csv", "clearance.xlsx"]
    heights = pd.read_csv(tmp_path / "heights.csv")
    levels = heights[heights["probability"].notna()]
    assert levels["height_m"].tolist() == pytest.approx(
        [level.height for level in result.levels], rel=1e-5
    )
    rounded = np.ceil(10.0 * heights["height_m"] - 1e-9) / 10.0
    assert heights["cost"].tolist() == pytest.approx((100.0 * rounded).tolist())
    sheets = pd.read_excel(tmp_path / "clearance.xlsx", sheet_name=None)
    assert list(sheets) == ["heights", "burial", "snow on the panel"]
    assert sheets["burial"]["probability"].iloc[0] == pytest.approx(
        result.burial_probability(result.heights[0])
    )
    lying = [sum(day.load > 0.0 and not day.released for day in case.days) for case in result.cases]
    covered = sheets["snow on the panel"]["covered_days"].sum()
    assert covered == pytest.approx(np.mean(lying), abs=0.01)


def test_the_blocked_irradiation_is_that_of_covered_hours():
    """Snow lies on two of three days, until it has melted; the third has half of the sun."""
    start = datetime(2024, 1, 1)
    fall = Weather(2, start, 0.1, 100.0, -20.0, irradiance=100.0)
    clear = replace(fall, date=start + timedelta(days=1), snowfall=0.0, temperature=20.0)
    settings = SeasonSettings(adhesion=1e4, thaw=None, melt_factor=100.0)
    later = replace(clear, date=start + timedelta(days=2), irradiance=200.0)
    months = mean_months([accumulate([fall, clear, later], settings, tilt=30.0)])
    assert months[1].covered_days == 2.0
    assert months[1].blocked == pytest.approx(200.0 / 400.0)


def test_the_same_tables_give_the_same_bytes(result, tmp_path):
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
        write_tables([result], tmp_path / name)
        time.sleep(1.1)  # a workbook holds seconds
    first, second = (
        (tmp_path / name / "clearance.xlsx").read_bytes() for name in ("first", "second")
    )
    assert first == second


def test_the_report_prints_on_four_pages(result, tmp_path):
    write_report([result], KNOWN, tmp_path)
    margin = dict.fromkeys(("top", "bottom", "left", "right"), "15mm")
    with open_page(tmp_path / "clearance.html") as (page, _):
        printed = page.pdf(format="A4", margin=margin)
    assert 1 <= len(re.findall(rb"/Type /Page\b", printed)) <= 4


def test_notes_on_unusual_ranges_are_in_the_report(result, tmp_path):
    with pytest.warns(SnowshedNote, match="adhesion: 0 to 0.1 is unusual"):
        ranges = SnowRanges({**KNOWN.spans, "adhesion": (0.0, 0.1)}, KNOWN.draws)
    write_report([result], ranges, tmp_path, ["of the weather"])
    notes = json.loads((tmp_path / "clearance.json").read_text())["notes"]
    assert notes == [*ranges.notes, "of the weather"]
    assert notes[0] in (tmp_path / "clearance.html").read_text()


def test_a_trend_counts_years_and_not_winters():
    """0.3 m in ten years, with a gap of fifteen years in the record."""
    years = [*range(1990, 1998), *range(2013, 2021)]
    trend = trend_of(np.array([1.0 + 0.03 * (year - 1990) for year in years]), years)
    assert trend is not None
    assert trend.per_decade == pytest.approx(0.3)


def test_a_season_of_rows_that_cannot_go_on_counts_as_a_burial():
    design = PanelDesign(0.6, 60.0, PanelRows(2, 0.6))
    case = cases_of(design, WINTERS, KNOWN.draw(2), SeasonSettings(), {})[0]
    outcome = case.outcome_of_lying_snow(0.4)
    assert outcome.contact is not None
    assert required_height([outcome, SeasonOutcome(0.8, 0.2, None)]) == pytest.approx(0.6)


def test_the_heights_of_one_slope_length_are_drawn_against_the_tilt():
    designs = [(2.0, 45.0, 1.5, (1.2, 1.9)), (2.0, 90.0, 1.0, (0.9, 1.3))]
    axes = design_figure(designs, 0.9).axes[0]
    assert axes.get_xlabel() == "tilt, degrees"
    lengths = [(length, *design[1:]) for length, design in zip((2.0, 3.0), designs)]
    assert design_figure(lengths, 0.9).axes[0].get_xlabel() == "slope length, m"


def test_more_cells_in_the_slabs_have_a_smaller_recorded_error():
    scene = Scene.preset("lab-50").with_({"numerics.scheme": "objective"}).resolve().data
    errors = [recorded_grid_error(scene, cells).size for cells in (2.0, 4.0, 100.0)]
    assert errors[0] > errors[1] == errors[2] > 0.0


@pytest.mark.parametrize("scheme", ["thesis", "objective"])
def test_stacks_of_few_slide_offs_have_a_larger_recorded_error(scheme):
    data = Scene.preset("lab-50").with_({"numerics.scheme": scheme}).resolve().data
    errors = [recorded_grid_error(data, 2.0, slide_offs) for slide_offs in (1, 5, 30)]
    assert errors[0].size > 1.5 * errors[1].size
    assert errors[1] == errors[2]
    assert "stacks of 5 or more slide-offs" in errors[1].source


def test_the_error_of_the_grid_is_that_of_as_many_slide_offs_as_the_winters_have(result):
    slides = [sum(day.event is not None for day in case.days) for case in result.cases]
    assert min(slides) <= result.slide_offs <= max(slides)
    data = result.cases[0].panel_scene(0.45).data
    few = recorded_grid_error(data, result.cases[0].cells_across, result.slide_offs)
    assert result.grid_error == few
    assert few.size > recorded_grid_error(data, result.cases[0].cells_across, 5).size


def test_the_error_of_the_grid_is_told_although_the_first_panel_sheds_no_snow(result, tmp_path):
    fence = PanelDesign(0.6, 90.0)
    first = required_clearance(fence, WINTERS, [0.45], tmp_path / "runs", ranges=KNOWN)
    assert not first.is_simulated
    notes = [note for note in warnings([first, result]) if "error of the grid" in note]
    assert len(notes) == 1
    assert notes[0].startswith(f"{panel_name(result)}: ")


def test_an_accuracy_chooses_scheme_and_cells_of_the_same_slabs(tmp_path, capsys):
    command = ["clearance", "example", "--slope-length", "4", "--tilt", "60", "--dry-run"]
    assert main([*command, "--accuracy", "10%", "-o", str(tmp_path / "out")]) == 0
    choice = choose_grid(0.1)
    text = capsys.readouterr().out
    assert f"scheme {choice.scheme} with {choice.cells:g} cells" in text
    assert f"dx {2.0 * DEFAULT_CELL / choice.cells:.3g} m" in text
    assert main([*command, "--accuracy", "10%", "--dx", "0.1", "-o", str(tmp_path / "out")]) == 2
    assert "--accuracy chooses cells and scheme" in capsys.readouterr().err
