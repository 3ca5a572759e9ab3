"""The report: its full content, and its list of missing parts."""

import base64
import re
from dataclasses import replace

import pandas as pd
import pytest
from helpers.pages import Page
from plot.browser import check_page
from reproduce_helpers import TINY, TINY_WITH_PANELS, few_fits, fill, geometry_table, report
from reproductions.common.hypothesis_tests import UNDECIDED
from reproductions.frischholz2023.claims.lab import DIMENSIONS, GROWTH
from reproductions.frischholz2023.sections import lab
from reproductions.frischholz2023.stages import ThesisComputation

from snowshed.plot.html_page import STATES


@pytest.fixture(scope="module")
def finished_report(tmp_path_factory):
    """The folder of a reproduction with made-up stacks in all stages."""
    folder = tmp_path_factory.mktemp("reproduce")
    table = geometry_table(folder / "rows.csv")
    computation = ThesisComputation(folder / "out", TINY, table)
    fill(computation)
    with few_fits(figures=True):
        computation.regression.compute(1, lambda fraction, words: None)
    return computation, report(computation)


def report_file(computation):
    return computation.folder.path / "thesis.html"


def page_of(computation):
    return Page(report_file(computation).read_text(encoding="utf-8"))


def test_the_report_needs_no_other_file(finished_report):
    computation, _ = finished_report
    page = page_of(computation)
    assert all(link.startswith("#") and link[1:] in page.ids for link in page.links)
    assert len(page.sources) == 1 + 1 + 2 + 4 + 1 + 4
    for source in page.sources:
        head, _, data = source.partition(",")
        assert head == "data:image/png;base64"
        assert base64.b64decode(data).startswith(b"\x89PNG\r\n\x1a\n")


def test_the_report_is_accessible(finished_report):
    check_page(report_file(finished_report[0]))


def test_the_report_contains_every_table_of_the_thesis(finished_report):
    text = " ".join(page_of(finished_report[0]).text)
    for number in ("2.3.1", "3.2.1", "3.3.1", "4.1.1", "4.2.1", "4.3.1"):
        assert re.search(rf"Tables? [^:]*{re.escape(number)}", text), number
    for number in ("5.1.1", "5.2.1", "5.3.1", "5.3.2"):
        assert re.search(rf"Tables? [^:]*{re.escape(number)}", text), number
    for printed in ("0.067", "0.118", "0.237", "0.240", "0.255", "0.015"):
        assert printed in text
    assert "synthetic truth" in text and "Missing" not in text
    shown = "panel friction not printed 0.8 stack between events reseed reseed"
    assert shown in " ".join(text.split())


def test_every_claim_has_a_verdict_and_a_rule(finished_report):
    computation, claims = finished_report
    table = pd.read_csv(computation.folder.claims)
    assert len(table) == len(claims) > 40
    assert set(table["verdict"]) <= set(STATES)
    assert table.notna().all().all()
    text = " ".join(page_of(computation).text)
    assert "exceeds 2 standard deviations" in text
    for claim in claims:
        assert claim.rule in text and claim.finding.sentence in text


def test_made_up_stacks_give_the_expected_verdicts(finished_report):
    _, claims = finished_report
    verdicts = {claim.text: claim.finding.verdict for claim in claims}
    assert verdicts["The head walks back toward the panel."] == "confirmed"
    assert verdicts["The effect of β on the height is positive."] == "confirmed"
    assert verdicts["M shortens the stack."] == "confirmed"
    assert verdicts["p₀ lengthens the stack."] == "confirmed"
    assert verdicts["H/L grows with the panel's length."] == "confirmed"
    assert verdicts["At 30 degrees slabs sometimes stop on the panel."] == "undecided"
    ratio_claim = (
        "In 3D a stack is about 2/3 as high as in 2D when height and width are comparable."
    )
    assert verdicts[ratio_claim] == "confirmed"
    pressure_claim = "p₀ lowers the height (the thesis says the opposite in 3.4.1)."
    assert verdicts[pressure_claim] == "contradicted"


def test_the_report_lists_missing_parts(tmp_path):
    computation = ThesisComputation(tmp_path / "out", TINY_WITH_PANELS, None)
    assert report(computation) == []
    assert "Nothing is computed yet" in " ".join(page_of(computation).text)
    fill(computation, ["s-index"])
    claims = report(computation)
    text = " ".join(page_of(computation).text)
    decided = {claim.source for claim in claims if claim.finding.verdict != "undecided"}
    assert decided == {"3.3"}
    unfinished = [claim for claim in claims if claim.source.startswith("3.4")]
    assert all("the stage is not complete" in claim.finding.sentence for claim in unfinished)
    assert "stage lab: 0 of 18 simulations done" in text
    assert "stage geometry: 0 of 125 simulations done" in text
    assert "stage s-index" not in text


def test_means_over_a_design_need_all_of_its_runs(tmp_path):
    computation = ThesisComputation(tmp_path / "out", TINY_WITH_PANELS, None)
    fill(computation, ["lab", "s-index"], fail_one=True)
    verdicts = {"2": set(), "3": set()}
    for claim in report(computation):
        if claim.source[0] in verdicts:
            verdicts[claim.source[0]].add(claim.finding.verdict)
    assert "confirmed" in verdicts["2"] and verdicts["3"] == {"undecided"}
    text = " ".join(page_of(computation).text)
    assert "stage s-index: 17 of 18 simulations done, 1 failed" in text


def test_without_3d_the_laboratory_is_judged_in_2d(tmp_path):
    computation = ThesisComputation(tmp_path / "out", replace(TINY, lab_dimensions=(2,)), None)
    fill(computation, ["lab"])
    content = lab.build(computation)
    assert {row[0] for row in content.tables[1][1].rows} == {"2D"}
    verdicts = {claim.text: claim.finding for claim in content.claims}
    assert "the data lack" in verdicts[DIMENSIONS[0].text].sentence
    assert all(verdicts[claim.text].verdict != UNDECIDED for claim in GROWTH[:2])
