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
def whole(tmp_path_factory):
    """The folder of a reproduction with made-up stacks in all stages."""
    folder = tmp_path_factory.mktemp("reproduce")
    table = geometry_table(folder / "rows.csv")
    found = ThesisComputation(folder / "out", TINY, table)
    fill(found)
    with few_fits(figures=True):
        found.regression.compute(1, lambda fraction, words: None)
    return found, report(found)


def report_file(found):
    return found.folder.path / "thesis.html"


def page_of(found):
    return Page(report_file(found).read_text(encoding="utf-8"))


def test_it_needs_no_other_file(whole):
    found, _ = whole
    page = page_of(found)
    assert all(link.startswith("#") and link[1:] in page.ids for link in page.links)
    assert len(page.sources) == 1 + 1 + 2 + 4 + 1 + 4
    for source in page.sources:
        head, _, data = source.partition(",")
        assert head == "data:image/png;base64"
        assert base64.b64decode(data).startswith(b"\x89PNG\r\n\x1a\n")


def test_it_can_be_read(whole):
    check_page(report_file(whole[0]))


def test_every_table_of_the_thesis_is_there(whole):
    text = " ".join(page_of(whole[0]).text)
    for number in ("2.3.1", "3.2.1", "3.3.1", "4.1.1", "4.2.1", "4.3.1"):
        assert re.search(rf"Tables? [^:]*{re.escape(number)}", text), number
    for number in ("5.1.1", "5.2.1", "5.3.1", "5.3.2"):
        assert re.search(rf"Tables? [^:]*{re.escape(number)}", text), number
    for printed in ("0.067", "0.118", "0.237", "0.240", "0.255", "0.015"):
        assert printed in text
    assert "synthetic truth" in text and "Missing" not in text
    shown = "panel friction not printed 0.8 stack between events reseed reseed"
    assert shown in " ".join(text.split())


def test_every_claim_has_a_verdict_and_a_rule(whole):
    found, claims = whole
    table = pd.read_csv(found.folder.claims)
    assert len(table) == len(claims) > 40
    assert set(table["verdict"]) <= set(STATES)
    assert table.notna().all().all()
    text = " ".join(page_of(found).text)
    assert "exceeds 2 standard deviations" in text
    for one in claims:
        assert one.rule in text and one.finding.sentence in text


def test_made_up_stacks_give_the_verdicts_they_must(whole):
    _, claims = whole
    found = {one.text: one.finding.verdict for one in claims}
    assert found["The head walks back toward the panel."] == "confirmed"
    assert found["The effect of β on the height is positive."] == "confirmed"
    assert found["M shortens the stack."] == "confirmed"
    assert found["p₀ lengthens the stack."] == "confirmed"
    assert found["H/L grows with the panel's length."] == "confirmed"
    assert found["At 30 degrees slabs sometimes stop on the panel."] == "undecided"
    two_thirds = "In 3D a stack is about 2/3 as high as in 2D when height and width are comparable."
    assert found[two_thirds] == "confirmed"
    lowers = "p₀ lowers the height (the thesis says the opposite in 3.4.1)."
    assert found[lowers] == "contradicted"


def test_it_says_what_is_missing(tmp_path):
    found = ThesisComputation(tmp_path / "out", TINY_WITH_PANELS, None)
    assert report(found) == []
    assert "Nothing is computed yet" in " ".join(page_of(found).text)
    fill(found, ["s-index"])
    claims = report(found)
    text = " ".join(page_of(found).text)
    decided = {one.source for one in claims if one.finding.verdict != "undecided"}
    assert decided == {"3.3"}
    unfinished = [one for one in claims if one.source.startswith("3.4")]
    assert all("the stage is not complete" in one.finding.sentence for one in unfinished)
    assert "stage lab: 0 of 18 simulations done" in text
    assert "stage geometry: 0 of 125 simulations done" in text
    assert "stage s-index" not in text


def test_means_over_a_design_need_all_of_its_runs(tmp_path):
    found = ThesisComputation(tmp_path / "out", TINY_WITH_PANELS, None)
    fill(found, ["lab", "s-index"], fail_one=True)
    verdicts = {"2": set(), "3": set()}
    for one in report(found):
        if one.source[0] in verdicts:
            verdicts[one.source[0]].add(one.finding.verdict)
    assert "confirmed" in verdicts["2"] and verdicts["3"] == {"undecided"}
    text = " ".join(page_of(found).text)
    assert "stage s-index: 17 of 18 simulations done, 1 failed" in text


def test_without_3d_the_laboratory_is_judged_in_2d(tmp_path):
    found = ThesisComputation(tmp_path / "out", replace(TINY, lab_dimensions=(2,)), None)
    fill(found, ["lab"])
    content = lab.build(found)
    assert {row[0] for row in content.tables[1][1].rows} == {"2D"}
    verdicts = {claim.text: claim.finding for claim in content.claims}
    assert "the data lack" in verdicts[DIMENSIONS[0].text].sentence
    assert all(verdicts[claim.text].verdict != UNDECIDED for claim in GROWTH[:2])
