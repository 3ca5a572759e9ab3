"""The page of the thesis's claims with both schemes: written from results, and complete."""

import pytest
from reproductions.common.claims_tables import claims_csv
from reproductions.common.hypothesis_tests import CONFIRMED, CONTRADICTED, Finding, JudgedClaim
from reproductions.frischholz2023 import schemes_page
from reproductions.frischholz2023.claims.scheme_reasons import REASONS

from snowshed._core import InputError
from snowshed.cli.main import main
from snowshed.study.store import Store

#: A claim for which the reasons have an entry.
GROWS = next(iter(REASONS))


def judged_claim(verdict, text, source="3.3"):
    return JudgedClaim(source, text, "slope above zero", Finding(verdict, f"slope, m: {verdict}"))


@pytest.fixture
def folders(tmp_path):
    def write(*tables):
        for number, claims in enumerate(tables):
            (tmp_path / str(number)).mkdir()
            (tmp_path / str(number) / "claims.csv").write_text(claims_csv(claims), "utf-8")
            with Store.create(tmp_path / str(number) / "runs"):
                pass
        return [tmp_path / str(number) for number in range(len(tables))]

    return write


def test_the_page_matches_the_results():
    """Made by python -m reproductions.frischholz2023.schemes_page."""
    assert schemes_page.PAGE.read_text(encoding="utf-8") == schemes_page.page()


def test_exactly_the_changed_verdicts_have_a_reason():
    pairs = schemes_page._pairs(schemes_page.DATA)
    changed = {a.text for a, b in pairs if a.finding.verdict != b.finding.verdict}
    assert changed == set(REASONS)


def test_changed_and_unchanged_claims_are_listed_separately(folders, tmp_path):
    thesis = [judged_claim(CONFIRMED, GROWS), judged_claim(CONFIRMED, "It falls.")]
    objective = [judged_claim(CONTRADICTED, GROWS), judged_claim(CONFIRMED, "It falls.")]
    panel_claim = judged_claim(CONFIRMED, "It is long.", "5.1.2")
    schemes_page.keep(folders([*thesis, panel_claim], [*objective, panel_claim]), tmp_path)
    introduction, changed, unchanged = schemes_page.page(tmp_path).split("\n## ")
    assert "Of 2 claims, 1 have another verdict" in introduction
    assert "| `objective` | 1 | 1 | 0 |" in introduction
    row = f"| 3.3 | {GROWS} | confirmed: slope, m: confirmed | contradicted: slope, m: contradicted"
    assert row in changed and "It falls." not in changed
    assert "It falls." in unchanged and "It is long." not in unchanged


def test_a_changed_verdict_without_a_reason_is_refused(folders, tmp_path):
    results = folders(
        [judged_claim(CONFIRMED, "It falls.")], [judged_claim(CONTRADICTED, "It falls.")]
    )
    schemes_page.keep(results, tmp_path)
    with pytest.raises(InputError, match=r"no reason for 'It falls\.'"):
        schemes_page.page(tmp_path)


def test_tables_of_other_claims_are_refused(folders, tmp_path):
    results = folders([judged_claim(CONFIRMED, GROWS)], [judged_claim(CONFIRMED, "It falls.")])
    schemes_page.keep(results, tmp_path)
    with pytest.raises(InputError, match="list different claims"):
        schemes_page.page(tmp_path)


def test_a_single_folder_is_refused(tmp_path, capsys):
    before = schemes_page.PAGE.read_bytes()
    assert main([str(tmp_path)], command=schemes_page.main, name="schemes_page") == 2
    assert "'folders' takes 2 values" in capsys.readouterr().err
    assert schemes_page.PAGE.read_bytes() == before
