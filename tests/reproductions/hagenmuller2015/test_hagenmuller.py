"""The reproduction of the paper on grains: rules on made-up tests, and the command."""

import math

import numpy as np
import pandas as pd
from plot.browser import check_page
from reproductions.common.hypothesis_tests import CONFIRMED, CONTRADICTED, UNDECIDED, judge
from reproductions.common.report import write_report
from reproductions.hagenmuller2015 import claims, printed, studies
from reproductions.hagenmuller2015.claims import ENGINE, PAPER, LoadingTests
from reproductions.hagenmuller2015.publication import REPRODUCTION
from reproductions.hagenmuller2015.sections import stress_grid
from reproductions.hagenmuller2015.snows import Samples
from reproductions.hagenmuller2015.stages import GrainsComputation

from snowshed.analysis.grains.ratios import STRESSES, compare_variants
from snowshed.analysis.grains.variants import BASE
from snowshed.cli.main import main

#: Stresses of the base and of the variants in kPa, from the paper and from Yade.
AS_PRINTED = {BASE: (69.0, 26.0, 47.0, 2516.0)}
AS_PRINTED.update({name: line for name, line in printed.YADE.items() if name != BASE})
AS_CLAIMED = {
    studies.THIN_NECKS: (40.0, 20.0, 40.0, 2000.0),
    studies.WIDE_NECKS: (80.0, 30.0, 50.0, 2050.0),
    studies.FEWER_GRAINS: (70.0, 27.0, 45.0, 2500.0),
    studies.EXCESSIVE_INERTIA: (400.0, 100.0, 90.0, 2600.0),
    claims.SCALED_DENSITY: (72.0, 30.0, 50.0, 2500.0),
    claims.HALF_EDGE: (66.0, 20.0, 40.0, 2400.0),
    "spheres 50 um": (72.0, 25.0, 47.0, 2500.0),
    "spheres 150 um": (65.0, 25.0, 47.0, 2500.0),
}


def made_up(noise=0.02, **changed):
    """Tests of three samples that scatter a little; the stresses of a variant may be replaced."""
    random = np.random.default_rng(1)
    lines = {**AS_PRINTED, **AS_CLAIMED, **changed}
    rows = []
    for name, line in lines.items():
        for sample in range(3):
            stresses = [
                math.nan if kpa is None else 1e3 * kpa * math.exp(noise * random.normal())
                for kpa in line
            ]
            facts = {"variant": name, "varied": name, "sample": sample, "hash": name}
            figures = {**dict(zip(STRESSES, stresses)), "hardening_onset_strain": 0.12}
            rows.append({**facts, **figures})
    elastic = {"broken_in_tension": 0, "broken_in_shear": 0, "elastic_limit_strain": 1e-4,
               "axial_strain": 1e-7, "linearity": 0.99}  # fmt: skip
    rows += [{"variant": studies.ELASTIC, "sample": sample, **elastic} for sample in range(3)]
    return LoadingTests([pd.DataFrame(rows)])


def verdicts(tests):
    return [claim.finding.verdict for claim in judge([*PAPER, *ENGINE], tests)]


def test_stresses_as_claimed_confirm_all_claims():
    for claim in judge([*PAPER, *ENGINE], made_up()):
        assert claim.finding.verdict == CONFIRMED, (claim.text, claim.finding.sentence)


def test_noise_leaves_claims_open():
    results = verdicts(made_up(noise=3.0))
    assert results.count(UNDECIDED) > len(results) / 2
    assert set(verdicts(LoadingTests([made_up().tables[0].query("sample == 0")]))[1:]) == {
        UNDECIDED
    }


def test_opposite_stresses_contradict_the_claims():
    """Each of these stresses contradicts a claim of the paper."""
    for changed, text in (
        ({studies.SOFT_ICE: (20.0, 54.0, 57.0, 439.0)}, "insensitive to Young"),
        ({studies.SOFT_ICE: (63.0, 54.0, 57.0, 2500.0)}, "very sensitive to Young"),
        ({studies.THIN_NECKS: (100.0, 20.0, 40.0, 2000.0)}, "Faceted"),
        ({studies.THIN_NECKS: (40.0, 20.0, 40.0, 500.0)}, "do not differ"),
        ({studies.HEAVY_SNOW: (60.0, 20.0, 40.0, 2000.0)}, "Density controls the stress."),
        ({"spheres 50 um": (490.0, 25.0, 47.0, 2500.0)}, "size of the spheres"),
        ({claims.SCALED_DENSITY: (200.0, 25.0, 47.0, 2500.0)}, "Denser ice"),
        ({studies.HIGH_FRICTION: (60.0, 46.0, 38.0, 2000.0)}, "Friction"),
        ({BASE: (30.0, 60.0, 70.0, 80.0)}, "At last the stress"),
    ):
        results = {claim.text: claim.finding.verdict for claim in judge(PAPER, made_up(**changed))}
        (verdict,) = [result for claim, result in results.items() if text in claim]
        assert verdict == CONTRADICTED, text


def test_broken_bonds_are_not_elastic():
    tests = made_up()
    tests.tables[0].loc[tests.tables[0]["variant"] == studies.ELASTIC, "broken_in_shear"] = [
        0,
        3,
        2,
    ]
    (judged,) = [claim for claim in judge(PAPER, tests) if claim.source == "elastic phase"]
    assert judged.finding.verdict == UNDECIDED
    tests.tables[0].loc[tests.tables[0]["variant"] == studies.ELASTIC, "broken_in_shear"] = [
        1,
        3,
        2,
    ]
    (judged,) = [claim for claim in judge(PAPER, tests) if claim.source == "elastic phase"]
    assert judged.finding.verdict == CONTRADICTED


def test_the_table_shows_yades_stress_beside_ours():
    grid = stress_grid(compare_variants(made_up().tables[0].query("variant != 'elastic'")))
    (row,) = [row for row in grid.rows if row[0] == studies.HIGH_FRICTION]
    assert row[1].endswith("[106]")


def test_claims_refer_to_existing_variants(tmp_path):
    comparisons = studies.Comparisons(Samples(40, 1), tmp_path)
    names = {variant.name for stage in studies.MAKERS for variant in comparisons[stage].variants}
    assert names >= {*AS_PRINTED, *AS_CLAIMED, studies.ELASTIC}


def test_the_page_of_all_stages_is_accessible(tmp_path):
    computation = GrainsComputation(tmp_path, Samples(40, 1))
    sizes = {"final_particles": 90, "spheres": 900, "density_kg_m3": 250.0}
    computation.tests = LoadingTests([table.assign(**sizes) for table in made_up().tables])
    write_report(REPRODUCTION, REPRODUCTION.size("quick"), tmp_path, computation)
    text = (tmp_path / "hagenmuller.html").read_text(encoding="utf-8")
    assert "Nothing is computed yet" not in text and "confirmed" in text
    check_page(tmp_path / "hagenmuller.html")


def test_an_empty_report_states_that_nothing_is_computed(tmp_path, capsys):
    folder = tmp_path / "out"
    assert main(["reproduce", "hagenmuller", "-o", str(folder), "--report-only"]) == 0
    assert "Nothing is computed yet" in (folder / "hagenmuller.html").read_text(encoding="utf-8")
    check_page(folder / "hagenmuller.html")
    assert main(["reproduce", "hagenmuller", "-o", str(folder), "--full", "--report-only"]) == 2
    assert "take a new folder for --full" in capsys.readouterr().err
    assert main(["reproduce", "hagenmuller", "-o", str(folder), "--stage", "x"]) == 2
    assert "stage: 'x' is unknown" in capsys.readouterr().err
