"""The page of the thesis's claims: written from results, and complete."""

import json

import pytest
from reproductions.common.claims_tables import claims_csv, read_claims
from reproductions.common.hypothesis_tests import CONFIRMED, CONTRADICTED, Finding, JudgedClaim
from reproductions.frischholz2023 import claims_page
from reproductions.frischholz2023.claims.causes import CAUSES

from snowshed._core import InputError


def judged_claim(verdict, text="It grows."):
    return JudgedClaim("5.1", text, "slope above zero", Finding(verdict, "slope, m: -1 ± 0.1"))


@pytest.fixture
def data(tmp_path):
    def write(*claims):
        (tmp_path / "claims.csv").write_text(claims_csv(claims), encoding="utf-8")
        computed = {"runs": 1, "date": "2026-01-01", "cpu": "a processor"}
        (tmp_path / "claims-computed.json").write_text(json.dumps(computed), encoding="utf-8")
        return tmp_path

    return write


def test_the_page_matches_the_results():
    """Made by python -m reproductions.frischholz2023.claims_page."""
    assert claims_page.PAGE.read_text(encoding="utf-8") == claims_page.page()


def test_exactly_the_contradictions_have_a_cause():
    claims = read_claims(claims_page.DATA / claims_page.CLAIMS_FILE)
    assert {claim.text for claim in claims if claim.finding.verdict == CONTRADICTED} == set(CAUSES)


def test_a_contradiction_without_a_cause_is_refused(data):
    with pytest.raises(InputError, match=r"no cause for 'It grows\.'"):
        claims_page.page(data(judged_claim(CONTRADICTED)))
    assert "| confirmed | 5.1 | It grows. |" in claims_page.page(data(judged_claim(CONFIRMED)))


def test_claims_are_read_back_as_written(data):
    claims = [judged_claim(CONFIRMED), judged_claim(CONTRADICTED, 'It grows, as "they" say; ±')]
    assert read_claims(data(*claims) / "claims.csv") == claims
    with pytest.raises(InputError, match="not a table of claims"):
        read_claims(data(judged_claim("believed")) / "claims.csv")
