"""Numbers of the thesis beside numbers of the same kind: single stacks, predictions, parts."""

import numpy as np
import pandas as pd
import pytest
from reproduce_helpers import TINY, few_fits, geometry_table
from reproductions.common.stage import compute
from reproductions.frischholz2023.printed import THESIS_QUARTILES
from reproductions.frischholz2023.sections import regression as section
from reproductions.frischholz2023.stages import ThesisComputation

from snowshed.analysis.regression.published import published


def several_seeds(file):
    """The made-up table with three stacks for each row; the first one differs from the others."""
    table = pd.read_csv(geometry_table(file))
    seeds = [
        table.assign(seed=seed, height_m=table["height_m"] * (1 + off))
        for seed, off in ((1, 0.1), (2, -0.05), (3, -0.05))
    ]
    pd.concat(seeds).to_csv(file, index=False)
    return file


@pytest.fixture(scope="module")
def finished_work(tmp_path_factory):
    folder = tmp_path_factory.mktemp("like")
    table = several_seeds(folder / "rows.csv")
    found = ThesisComputation(folder / "out", TINY, table)
    with few_fits():
        compute([found.regression], jobs=1)
    return found


def grid_of(made, beginning):
    return next(grid for title, grid in made.tables if title.startswith(beginning))


def test_one_seed_is_regressed_beside_the_means(finished_work):
    one, means = finished_work.regression.parts()
    assert (one.rows.most_seeds, means.rows.most_seeds) == (1, 3)
    assert one.folder != means.folder and one.rows.digest != means.rows.digest
    np.testing.assert_allclose(one.rows.targets["ratio"], 1.1 * means.rows.targets["ratio"])
    assert finished_work.regression.state().finished


def test_rows_of_one_seed_are_regressed_once(tmp_path):
    table = geometry_table(tmp_path / "rows.csv")
    found = ThesisComputation(tmp_path / "out", TINY, table)
    assert len(found.regression.parts()) == 1


def test_the_quartiles_of_the_thesis_stand_beside_predictions_and_rows_by_themselves(finished_work):
    rows = grid_of(section.build(finished_work), "Table 5.3.1").rows
    assert [row[:2] for row in rows] == [
        [f"{model}, {who}", of]
        for model in ("linear", "RBF")
        for who, of in (
            ("thesis", "predictions"),
            ("here", "predictions, rows of one seed"),
            ("here", "predictions, means of up to 3 seeds"),
        )
    ] + [["none", "rows of one seed"], ["none", "means of up to 3 seeds"]]
    assert rows[3][2:] == [f"{one:.3f}" for one in THESIS_QUARTILES["rbf"]]
    of_one, of_means = (np.array(rows[place][2:], float) for place in (-2, -1))
    np.testing.assert_allclose(of_one, 1.1 * of_means, atol=1e-3)


def test_quartiles_of_rows_are_given_by_every_measure_that_the_table_has(finished_work):
    rows = grid_of(section.build(finished_work), "Quartiles of the rows").rows
    assert {row[0] for row in rows} == {"97 % of the snow, trimmed equal pace"}
    assert [row[1] for row in rows] == ["rows of one seed", "means of up to 3 seeds"]


def test_errors_are_given_as_parts_of_the_median_prediction(finished_work):
    grid = grid_of(section.build(finished_work), "Table 5.3.2")
    place = grid.head.index("of the median prediction")
    printed = {row[0]: row[place] for row in grid.rows}
    assert printed["RBF, thesis"] == "4.3 %" and printed["linear, thesis"] == "15 %"
    part = finished_work.regression.parts()[0]
    errors = pd.read_csv(part.folder / "ratio" / "errors.csv").set_index("model")
    quartiles = pd.read_csv(part.folder / "ratio" / "quartiles.csv").set_index("model")
    expected = errors["mean_absolute_error"] / quartiles["Q2"][["linear", "rbf"]]
    np.testing.assert_allclose(errors["relative_error"], expected, rtol=1e-4)
    assert errors["thesis_relative_error"]["rbf"] == pytest.approx(
        published().relative_error("rbf")
    )


def test_claims_are_judged_on_single_stacks(finished_work):
    made = section.build(finished_work)
    errors = pd.read_csv(finished_work.regression.parts()[0].folder / "ratio" / "errors.csv")
    rbf = errors.set_index("model").loc["rbf", "mean_absolute_error"]
    found = next(one for one in made.claims if "RBF kernel's mean absolute error" in one.text)
    assert f"{rbf:.3g}" in found.finding.sentence
    assert any("claims are judged on it" in line for line in made.paragraphs)
