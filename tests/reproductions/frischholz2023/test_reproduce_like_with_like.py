"""Numbers of the thesis beside numbers of the same kind: single stacks, predictions, parts."""

import numpy as np
import pandas as pd
import pytest
from reproduce_helpers import TINY, few_fits, geometry_table
from reproductions.common.stage import compute
from reproductions.frischholz2023.printed import THESIS_QUARTILES
from reproductions.frischholz2023.sections import regression as section
from reproductions.frischholz2023.stages import ThesisComputation


def several_seeds(file):
    """The made-up table with three stacks for each row; the first stack differs from the others."""
    table = pd.read_csv(geometry_table(file))
    seeds = [
        table.assign(seed=seed, height_m=table["height_m"] * (1 + off))
        for seed, off in ((1, 0.1), (2, -0.05), (3, -0.05))
    ]
    pd.concat(seeds).to_csv(file, index=False)
    return file


@pytest.fixture(scope="module")
def finished_computation(tmp_path_factory):
    folder = tmp_path_factory.mktemp("like")
    table = several_seeds(folder / "rows.csv")
    computation = ThesisComputation(folder / "out", TINY, table)
    with few_fits():
        compute([computation.regression], jobs=1)
    return computation


def grid_of(content, beginning):
    return next(grid for title, grid in content.tables if title.startswith(beginning))


def test_regressions_use_one_seed_and_the_means(finished_computation):
    single, means = finished_computation.regression.parts()
    assert (single.rows.most_seeds, means.rows.most_seeds) == (1, 3)
    assert single.folder != means.folder and single.rows.digest != means.rows.digest
    np.testing.assert_allclose(single.rows.targets["ratio"], 1.1 * means.rows.targets["ratio"])
    assert finished_computation.regression.state().finished


def test_rows_of_one_seed_are_regressed_once(tmp_path):
    table = geometry_table(tmp_path / "rows.csv")
    computation = ThesisComputation(tmp_path / "out", TINY, table)
    assert len(computation.regression.parts()) == 1


def test_quartiles_of_predictions_and_of_rows_are_separate(finished_computation):
    rows = grid_of(section.build(finished_computation), "Table 5.3.1").rows
    assert [row[:2] for row in rows] == [
        [f"{model}, {source}", kind]
        for model in ("linear", "RBF")
        for source, kind in (
            ("thesis", "predictions"),
            ("here", "predictions, rows of one seed"),
            ("here", "predictions, means of up to 3 seeds"),
        )
    ] + [["(rows)", "rows of one seed"], ["(rows)", "means of up to 3 seeds"]]
    assert rows[3][2:] == [f"{quartile:.3f}" for quartile in THESIS_QUARTILES["rbf"]]
    single, means = (np.array(rows[index][2:], float) for index in (-2, -1))
    np.testing.assert_allclose(single, 1.1 * means, atol=1e-3)


def test_quartiles_of_rows_cover_every_trimming_of_the_table(finished_computation):
    rows = grid_of(section.build(finished_computation), "Quartiles of the rows").rows
    assert {row[0] for row in rows} == {"97 % of the snow, trimmed equal pace"}
    assert [row[1] for row in rows] == ["rows of one seed", "means of up to 3 seeds"]


def test_errors_are_relative_to_the_median_prediction(finished_computation):
    grid = grid_of(section.build(finished_computation), "Table 5.3.2")
    column = grid.head.index("of the median prediction")
    printed = {row[0]: row[column] for row in grid.rows}
    assert printed["RBF, thesis"] == "4.3 %" and printed["linear, thesis"] == "15 %"
    regression = finished_computation.regression.parts()[0]
    errors = pd.read_csv(regression.folder / "ratio" / "errors.csv").set_index("model")
    quartiles = pd.read_csv(regression.folder / "ratio" / "quartiles.csv").set_index("model")
    expected = errors["mean_absolute_error"] / quartiles["Q2"][["linear", "rbf"]]
    np.testing.assert_allclose(errors["relative_error"], expected, rtol=1e-4)


def test_claims_are_judged_on_single_stacks(finished_computation):
    content = section.build(finished_computation)
    errors = pd.read_csv(finished_computation.regression.parts()[0].folder / "ratio" / "errors.csv")
    rbf = errors.set_index("model").loc["rbf", "mean_absolute_error"]
    judged = next(
        claim for claim in content.claims if "RBF kernel's mean absolute error" in claim.text
    )
    assert f"{rbf:.3g}" in judged.finding.sentence
    assert any("claims are judged on it" in line for line in content.paragraphs)
