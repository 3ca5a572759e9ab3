"""The page of the thesis's claims with both schemes: written from results, and complete."""

import json

import pytest
from reproductions.common.claims_tables import claims_csv
from reproductions.common.hypothesis_tests import CONFIRMED, CONTRADICTED, Finding, JudgedClaim
from reproductions.frischholz2023 import schemes_page
from reproductions.frischholz2023.claims.scheme_reasons import REASONS

from snowshed._core import InputError
from snowshed.cli.main import main
from snowshed.study.store import Store

#: A claim for which the reasons have an entry.
GROWS = next(iter(REASONS["planar"]))
MIDDLE_THESIS, MIDDLE, PLANAR_THESIS, PLANAR = (
    (size, scheme) for size in ("middle", "planar") for scheme in ("thesis", "objective")
)


def judged_claim(verdict, text, source="3.3"):
    return JudgedClaim(source, text, "slope above zero", Finding(verdict, f"slope, m: {verdict}"))


FALLS, PANEL = judged_claim(CONFIRMED, "It falls."), judged_claim(CONFIRMED, "It is long.", "5.1.2")


@pytest.fixture
def keep(tmp_path):
    """Return a function that keeps claims, as those of a reproduction with a size and a scheme."""

    def keep_claims(kind, *claims):
        folder = tmp_path / "-".join(kind)
        folder.mkdir(exist_ok=True)
        identity = {"size": kind[0], "scheme": kind[1]}
        (folder / "reproduction.json").write_text(json.dumps(identity), "utf-8")
        (folder / "claims.csv").write_text(claims_csv(claims), "utf-8")
        if not (folder / "runs").exists():
            with Store.create(folder / "runs"):
                pass
        schemes_page.keep(folder, tmp_path)

    # The claims of --middle with the scheme thesis are those of another page.
    (tmp_path / "claims.csv").write_text(claims_csv([FALLS, PANEL]), "utf-8")
    (tmp_path / "claims-computed.json").write_text('{"runs": 1, "date": "", "cpu": ""}', "utf-8")
    keep_claims(MIDDLE, FALLS, PANEL)
    return keep_claims


def test_the_page_matches_the_results():
    """Made by python -m reproductions.frischholz2023.schemes_page."""
    assert schemes_page.PAGE.read_text(encoding="utf-8") == schemes_page.page()


@pytest.mark.parametrize("group", schemes_page.GROUPS)
def test_exactly_the_changed_verdicts_have_a_reason(group):
    pairs = schemes_page._pairs(schemes_page.DATA, group)
    changed = {a.text for a, b in pairs if a.finding.verdict != b.finding.verdict}
    assert changed == set(REASONS[group])


def test_changed_and_unchanged_claims_are_listed_separately(keep, tmp_path):
    keep(PLANAR_THESIS, judged_claim(CONFIRMED, GROWS), FALLS, PANEL)
    keep(PLANAR, judged_claim(CONTRADICTED, GROWS), FALLS, PANEL)
    introduction, _, _, changed, unchanged, _, rows = schemes_page.page(tmp_path).split("\n## ")
    assert "in 3D 0 of 1, in 2D 1 of 2, in chapter 5 0 of 1." in introduction
    assert "| `objective`, 2D | 1 | 1 | 0 |" in introduction
    row = f"| 3.3 | {GROWS} | confirmed: slope, m: confirmed | contradicted: slope, m: contradicted"
    assert row in changed and "It falls." not in changed
    assert "It falls." in unchanged and "It is long." not in unchanged
    assert "It is long." in rows and "It falls." not in rows


def test_claims_on_rows_are_kept_beside_those_of_a_reproduction_without_them(keep, tmp_path):
    keep(PLANAR_THESIS, FALLS)
    keep(PLANAR, FALLS, PANEL)
    keep(PLANAR, judged_claim(CONTRADICTED, PANEL.text, PANEL.source))
    with pytest.raises(InputError, match=r"no reason for 'It is long\.'"):
        schemes_page.page(tmp_path)
    assert "It falls." in (tmp_path / "claims-planar-objective.csv").read_text(encoding="utf-8")


def test_claims_of_one_scheme_only_are_named(keep, tmp_path):
    keep(PLANAR_THESIS, judged_claim(CONFIRMED, GROWS), FALLS)
    keep(PLANAR, FALLS)
    assert f"Not computed in 2D with `objective`: {GROWS} (3.3)\n" in schemes_page.page(tmp_path)


def test_a_changed_verdict_without_a_reason_is_refused(keep, tmp_path):
    keep(PLANAR_THESIS, FALLS)
    keep(PLANAR, judged_claim(CONTRADICTED, "It falls."))
    with pytest.raises(InputError, match=r"no reason for 'It falls\.'"):
        schemes_page.page(tmp_path)


def test_tables_of_other_claims_are_refused(keep, tmp_path):
    keep(PLANAR_THESIS, judged_claim(CONFIRMED, GROWS))
    keep(PLANAR, FALLS)
    with pytest.raises(InputError, match="list different claims"):
        schemes_page.page(tmp_path)


def test_the_folder_of_another_reproduction_is_refused(keep, tmp_path):
    with pytest.raises(InputError, match="holds --middle with the scheme thesis; allowed"):
        keep(MIDDLE_THESIS, FALLS)
    before = schemes_page.PAGE.read_bytes()
    command = [str(tmp_path / "middle-thesis")]
    assert main(command, command=schemes_page.main, name="schemes_page") == 2
    assert schemes_page.PAGE.read_bytes() == before
