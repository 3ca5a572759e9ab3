import base64
import json
import re
from dataclasses import replace

import pandas as pd
import pytest
from helpers.pages import Page
from made_up import DRIFT, HEIGHT, made_up_case
from plot.browser import check_page
from validation.framework import sections
from validation.framework.case import Quantity
from validation.framework.figures import LineStyles, worth_naming
from validation.framework.measure import measure_cases
from validation.framework.measurement_file import MeasurementFile
from validation.framework.report import Stress, Validation, write_report
from validation.stress import SummaryTable

from snowshed.base import formatting
from snowshed.snow.accuracy.measurements import to_table

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """Return a folder with the report on a full made-up suite in which one entry fails."""
    folder = tmp_path_factory.mktemp("report")
    entries = [*made_up_case().matrix(True), {"dx": 0.1, "transfer": "flip"}]
    case = made_up_case(entries=entries)
    measurements = measure_cases([case], MeasurementFile(folder / "m.jsonl"), full=True)
    runs = pd.DataFrame({"outcome": ["rest", "rest", "failed"]})
    outcomes = pd.DataFrame({"outcome": ["rest"], "runs": [2], "largest_error": [0.123456789]})
    tables = [SummaryTable("outcomes", "How runs ended", "None may fail.", outcomes)]
    stress = Stress(runs, tables)
    write_report(Validation([case], measurements, full=True, stress=stress), folder)
    return folder


@pytest.fixture(scope="module")
def page(report):
    return Page((report / "validation.html").read_text(encoding="utf-8"))


def row_with(page, *texts):
    (row,) = [row for row in page.rows if row[: len(texts)] == list(texts)]
    return row


def test_the_page_needs_no_other_file(page, report):
    assert len(page.images) == 2
    for image in page.images:
        kind, _, data = image.partition(",")
        assert kind == "data:image/png;base64"
        assert base64.b64decode(data).startswith(PNG)
    assert all(link.startswith("#") for link in page.links)
    assert {link[1:] for link in page.links} == set(page.ids)
    assert {path.name for path in (report / "figures").iterdir()} == {
        "made_up-convergence.png",
        "made_up-error-against-run-time.png",
    }
    html = (report / "validation.html").read_text(encoding="utf-8")
    assert not re.search(r"https?://|<script|@import|url\(", html)


def test_the_page_is_accessible(report):
    check_page(report / "validation.html")


def test_the_page_lists_criteria_that_hold_and_that_fail(page):
    text = " ".join(" ".join(page.text).split())
    assert "0 of 2 criteria" not in text
    assert "1 of 2 criteria does not hold" in text
    assert "Of 3 runs of the stress suite 1 failed" in text
    holding = row_with(page, "holds", "A made-up case", "height, m")
    assert holding[3:6] == ["apic, dx 0.1", "≤ 6 %", "4.4 %"]
    failed = row_with(page, "does not hold", "A made-up case", "drift, kg m2/s")
    assert failed[3:6] == ["all settings", "order ≥ 1.9 in dx", "failed"]
    assert "KeyError: 'flip'" in text  # the reason


def test_the_page_describes_the_suite_and_its_cases(page):
    text = " ".join(" ".join(page.text).split())
    for phrase in (
        "full",
        "7, 1 failed",
        "The error is <known>.",
        "Nowhere",
        "PIC damps.",
        "None may fail.",
    ):
        assert phrase in text
    for title in ("What holds", "Cheapest settings", "Where the method is poor", "How runs ended"):
        assert title in text


def test_the_page_names_the_cheapest_settings(page):
    # Errors 4.4 dx^2 (apic, 0.02/dx s) and 24 dx^2 (pic, 0.015/dx s).
    rows = [row for row in page.rows if row[:2] == ["A made-up case", "height, m"]]
    assert rows == [
        [
            *("A made-up case", "height, m", ""),
            *("0.2 s: dx 0.1, apic", "←", "0.4 s: dx 0.05, apic", "not reached; best 1.1 %"),
        ]
    ]


def test_the_page_shows_orders_and_extremes(page):
    orders = [row for row in page.rows if row[0] == "height, m" and row[2] == "dx"]
    assert [row[1] for row in orders] == ["apic", "pic"]
    assert all(row[3:] == ["0.2 … 0.05", "2.00, 2.00", "2.00"] for row in orders)
    extremes = row_with(page, "height, m", "1.1 %")
    assert extremes[2] == "dx 0.05, apic"
    assert extremes[4:] == ["96 %", "dx 0.2, pic"]


def test_numbers_are_rounded(page):
    cells = [text for row in page.rows for text in row]
    assert not [text for text in cells if re.search(r"\d\.\d{6}|\d{8}", text)]
    assert row_with(page, "rest") == ["rest", "2", "0.123"]


def test_results_are_written_as_files_too(report):
    table = pd.read_csv(report / "results.csv")
    assert len(table) == 14
    assert table["error"].isna().sum() == 2
    columns = "case quantity dx transfer value exact error wall_s updates updates_per_s steps "
    columns += "particles peak_memory_mb elapsed_s version machine date failure"
    assert list(table) == columns.split()
    data = json.loads((report / "results.json").read_text(encoding="utf-8"))
    assert data["about"]["suite"] == "full"
    assert [criterion["holds"] for criterion in data["criteria"]] == [True, False]
    assert len(data["measurements"]) == 7
    assert [entry["order"] for entry in data["orders"]] == pytest.approx([2.0] * 4)
    reached = [entry["reached"] for entry in data["cheapest"]]
    assert reached == [True, True, True, False]


def test_a_suite_in_which_everything_failed_has_a_report(tmp_path):
    case = made_up_case(entries=[{"mode": "raises", "dx": 0.1}])
    measurements = measure_cases([case], MeasurementFile(tmp_path / "m.jsonl"))
    criteria = write_report(Validation([case], measurements, full=False), tmp_path)
    assert [criterion.holds for criterion in criteria] == [None, False]
    page = Page((tmp_path / "validation.html").read_text(encoding="utf-8"))
    assert not page.images
    assert "stress" not in page.ids


def test_points_of_the_front_are_named_if_they_differ():
    assert worth_naming([], [], []) == []
    assert worth_naming([2], [0, 0, 1.0], [0, 0, 0.1]) == [2]
    times, errors = [1.0, 2.0, 2.1, 9.0], [0.5, 0.4, 0.2, 0.199]
    assert worth_naming([0, 1, 2, 3], times, errors) == [0, 2]


def test_varying_settings_have_different_styles():
    settings = [{"dx": dx, "basis": b, "transfer": t} for dx in (1, 2) for b in "qc" for t in "fa"]
    styles = LineStyles.of(settings, settings, along=["dx"])
    lines = [styles.for_line(entry) for entry in settings[:4]]
    assert len({(line["color"], line["marker"]) for line in lines}) == 4
    assert len({line["color"] for line in lines}) == 2  # the transfer
    assert lines == [styles.for_line(entry) for entry in settings[4:]]
    assert sorted(line.get_label() for line in styles.key(settings)) == ["a", "c", "f", "q"]


def test_a_value_has_the_same_style_in_every_figure():
    settings = [{"dx": dx, "basis": b, "transfer": t} for dx in (1, 2) for b in "qc" for t in "fa"]
    drawn = [entry for entry in settings if entry["transfer"] == "a"]
    styles = LineStyles.of(settings, drawn, along=["dx"])
    assert sorted(line.get_label() for line in styles.key(drawn)) == ["c", "q"]
    both = [LineStyles.of(settings, shown, along=["dx"]) for shown in (settings, settings[:2])]
    colours = [[styles.for_line(entry)["color"] for entry in settings[:2]] for styles in both]
    assert colours[0] == colours[1]


def test_dashes_are_used_only_for_lines():
    settings = [{"a": a, "b": b, "c": c} for a in (1, 2) for b in (1, 2) for c in (1, 2)]
    assert len(LineStyles.of(settings, settings).key(settings)) == 4
    assert len(LineStyles.of(settings, settings, along=["dx"]).key(settings)) == 6


def test_errors_are_drawn_against_time_if_settings_can_be_compared(tmp_path):
    several, single = [{"transfer": "apic"}, {"transfer": "pic"}], [{"transfer": "apic"}]
    diagnostic = Quantity("height", "height, cells", relative=False)
    no_drift = replace(DRIFT, order_in=None)
    for number, (quantity, entries, drawn) in enumerate(
        [
            (HEIGHT, several, True),
            (HEIGHT, single, False),
            (diagnostic, several, False),
            (replace(diagnostic, limit=1.0), several, True),
        ]
    ):
        folder = tmp_path / str(number)
        folder.mkdir()
        case = made_up_case(entries=entries, quantities=[quantity, no_drift])
        measured = measure_cases([case], MeasurementFile(folder / "m.jsonl"))
        pictures = sections.section(case, measured, to_table(measured)).pictures
        assert [picture.name for picture in pictures] == ["made_up-error-against-run-time"] * drawn


def test_unmeasured_quantities_have_no_column(tmp_path):
    case = made_up_case(
        entries=[{"transfer": "apic"}], quantities=[HEIGHT, DRIFT, Quantity("tilt", "tilt")]
    )
    measured = measure_cases([case], MeasurementFile(tmp_path / "m.jsonl"))
    grid = sections.results_grid(case, measured)
    titles = [title for title, _ in grid.groups if title]
    assert [title.split(",")[0] for title in titles] == ["height", "drift"]


def test_missing_settings_are_named():
    assert sections._cell({"dx": 0.1}, "flip_ratio") == "default"
    assert sections._cell({"dx": 0.1}, "aspect") == formatting.MISSING
    assert sections._cell({"dimension": 3}, "dimension") == "3D"


def test_frames_become_tables_of_rounded_numbers():
    frame = pd.DataFrame({"a_b": [1.23456, float("nan")], "c": ["x", "y"], "d": [1_234_567, 12345]})
    grid = sections.frame_grid(frame)
    assert grid.head == ["a b", "c", "d"]
    assert grid.align == "rlr"
    million = f"1.23{formatting.TIMES}10⁶"
    assert grid.rows == [["1.23", "x", million], [formatting.MISSING, "y", "12,345"]]


@pytest.mark.parametrize(
    ("value", "text"),
    [(1e-6, "10⁻⁶"), (-0.5, "-0.5"), (1e5, "100,000"), (999.9, "1,000"), (1e-4, "0.0001")],
)
def test_numbers_are_written_briefly(value, text):
    assert formatting.number(value) == text
