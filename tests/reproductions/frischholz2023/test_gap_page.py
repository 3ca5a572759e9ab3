"""The page on the gap to the thesis: it follows from results, and marks possible chance."""

import shutil

import pandas as pd
import pytest
from reproductions.common.hypothesis_tests import Estimate
from reproductions.frischholz2023 import gap_page
from reproductions.frischholz2023.scatter import read_scatter, scatter
from reproductions.frischholz2023.variants import by_size, change, read_variants_file

from snowshed._core import InputError
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, TRIMMINGS


@pytest.fixture
def data(tmp_path):
    shutil.copytree(gap_page.DATA, tmp_path / "data")
    return tmp_path / "data"


def test_the_page_matches_the_results():
    """Made by python -m reproductions.frischholz2023.gap_page."""
    assert gap_page.PAGE.read_text(encoding="utf-8") == gap_page.page()


def test_the_default_trimming_scatters_less():
    stacks = read_scatter(gap_page.DATA / gap_page.SCATTER_FILE)
    lengths = {name: scatter(stacks, name, "length") for name in TRIMMINGS}
    assert min(lengths, key=lengths.get) == DEFAULT_TRIMMING
    assert scatter(stacks, "equal_pace", "height") == pytest.approx(
        scatter(stacks, "outermost_first", "height"), rel=0.05
    )


def test_scatter_is_between_seeds_of_the_same_panel():
    rows = [
        {"panel.tilt": 40, "panel.height": h, "panel.length": 1, "event": 1, "seed": seed, "dx": 1}
        for h in (1, 2)
        for seed in (1, 2)
    ]
    columns = {f"{name}_{measure}_m": 1.0 for name in TRIMMINGS for measure in ("height", "length")}
    stacks = pd.DataFrame(rows).assign(**columns)
    stacks["equal_pace_length_m"] = [0.9, 1.1, 9.0, 11.0]  # ±10 % of each mean
    assert scatter(stacks, "equal_pace", "length") == pytest.approx(0.1 * 2**0.5)
    assert scatter(stacks, "outermost_first", "length") == 0


def test_causes_are_sorted_by_size():
    stacks = read_variants_file(gap_page.DATA / gap_page.DEVIATIONS_FILE)
    text = gap_page.page()
    positions = [text.index(f"**`{name}`**") for name in by_size(stacks)]
    assert positions == sorted(positions)
    sizes = [abs(change(stacks, name, "ratio").value) for name in by_size(stacks)]
    assert sizes == sorted(sizes, reverse=True)


@pytest.mark.parametrize(
    ("estimate", "words"),
    [
        (Estimate(0.3, 0.1), "H/L changes by +30 ± 10 %. "),
        (Estimate(-0.3, 0.2), "H/L changes by -30 ± 20 %, which may be chance. "),
        (Estimate(0.3, float("nan")), "which may be chance. "),
        (Estimate(0.0, 0.0), "it changes no stack of the sample. "),
        (Estimate(0.004, 0.003), "it changes no stack of the sample noticeably. "),
    ],
)
def test_changes_within_the_noise_are_marked_as_chance(monkeypatch, estimate, words):
    stacks = pd.DataFrame({"variant": ["reseed"], "same_runs": [False]})
    monkeypatch.setattr(gap_page, "change", lambda *arguments: estimate)
    assert words in gap_page._cause(stacks, "reseed")


def test_a_deviation_that_was_not_switched_is_not_called_small(monkeypatch):
    stacks = pd.DataFrame({"variant": ["slip"], "same_runs": [True]})
    monkeypatch.setattr(gap_page, "change", lambda *arguments: Estimate(0.0, 0.0))
    assert "its effect is unknown" in gap_page._cause(stacks, "slip")


def test_new_results_are_stored_and_other_tables_refused(data, tmp_path):
    stacks = pd.read_csv(data / gap_page.DEVIATIONS_FILE)
    stacks.loc[stacks["variant"] == "reseed", "outermost_first_height_m"] *= 3
    stacks.to_csv(tmp_path / "stacks.csv", index=False)
    before = gap_page.page(data)
    gap_page.keep(data, tmp_path / "stacks.csv", None, None)
    after = gap_page.page(data)
    assert after != before and "1. **`reseed`**" in after
    with pytest.raises(InputError, match="no column"):
        gap_page.keep(data, data / "regression-equal_pace" / "scores.csv", None, None)
    with pytest.raises(InputError, match="a single seed; scatter needs several"):
        gap_page.keep(data, None, tmp_path / "stacks.csv", None)
    assert gap_page.page(data) == after
