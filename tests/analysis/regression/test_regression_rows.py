"""Tables of rows: their contents, and errors with line and column."""

import numpy as np
import pandas as pd
import pytest
from synthetic_rows import few_inputs, synthetic_rows, thesis_inputs, write_table

from snowshed import InputError
from snowshed.analysis.regression import read_rows, stack_rows
from snowshed.analysis.regression import rows as rows_module
from snowshed.io.toml import parse_toml


def test_a_table_gives_inputs_and_targets(tmp_path):
    rows = synthetic_rows(few_inputs())
    write_table(rows, tmp_path / "rows.csv")
    read = read_rows(tmp_path / "rows.csv")
    np.testing.assert_array_equal(read.inputs, rows.inputs)
    for name, values in rows.targets.items():
        np.testing.assert_allclose(read.targets[name], values, rtol=1e-12)
    assert len(set(read.panels)) == 32 and read.left_out == 0


def test_the_body_can_be_the_measure(tmp_path):
    rows = synthetic_rows(few_inputs())
    write_table(rows, tmp_path / "rows.csv")
    body = read_rows(tmp_path / "rows.csv", measure="body")
    np.testing.assert_allclose(body.targets["ratio"], rows.targets["ratio"] * 0.9 / 0.8)


def test_parquet_is_read_too(tmp_path):
    rows = synthetic_rows(few_inputs())
    table = write_table(rows, tmp_path / "rows.csv")
    table.to_parquet(tmp_path / "rows.parquet")
    read = read_rows(tmp_path / "rows.parquet")
    np.testing.assert_array_equal(read.inputs, rows.inputs)


def test_failed_runs_are_left_out(tmp_path):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    table.loc[[3, 7], ["height_m", "length_m"]] = np.nan
    table.to_csv(tmp_path / "rows.csv", index=False)
    read = read_rows(tmp_path / "rows.csv")
    assert (len(read), read.left_out) == (94, 2)


def test_stacks_that_differ_only_in_their_seeds_make_one_row():
    single = synthetic_rows(few_inputs(), noise=0)
    noisy = synthetic_rows(np.tile(few_inputs(), (16, 1)), noise=0.003)
    np.testing.assert_array_equal(noisy.inputs, single.inputs)
    assert noisy.stacks["ratio"].shape == (96, 16)
    error = np.abs(noisy.targets["ratio"] - single.targets["ratio"]).mean()
    assert error == pytest.approx(0.0024 / 4, rel=0.2)  # E|x| = 0.8 deviations
    assert noisy.scatter("ratio") == pytest.approx(0.0024, rel=0.1)
    assert np.isnan(single.scatter("ratio"))


def test_rows_may_have_different_numbers_of_stacks():
    inputs = np.array([[1, 2, 4, 40], [2, 2, 4, 40], [1, 2, 4, 40]])
    rows = stack_rows(inputs, np.array([1, 2, 3]), np.array([4, 5, 4]))
    assert rows.targets["height"].tolist() == [2, 2]
    np.testing.assert_array_equal(rows.stacks["height"], [[1, 3], [2, np.nan]])
    assert rows.scatter("height") == pytest.approx(np.sqrt(2))


def test_the_ratio_of_a_row_is_that_of_its_mean_stack():
    inputs = np.tile([1.0, 2.0, 4.0, 40.0], (2, 1))
    rows = stack_rows(inputs, np.array([1.0, 2.0]), np.array([1.0, 5.0]))
    assert rows.targets["ratio"].tolist() == [0.5]  # the mean of the ratios would be 0.7


def test_events_without_a_stack_are_left_out(tmp_path):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    table.loc[[3, 7, 8], ["height_m", "length_m"]] = 0.0
    table.to_csv(tmp_path / "rows.csv", index=False)
    read = read_rows(tmp_path / "rows.csv")
    assert (len(read), read.left_out) == (93, 3)


def test_stacks_that_still_move_are_counted(tmp_path):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    ended = ["time_limit" if row in (3, 7) else "rest" for row in range(len(table))]
    table.assign(ended=ended).to_csv(tmp_path / "rows.csv", index=False)
    read = read_rows(tmp_path / "rows.csv")
    assert (len(read), read.moving) == (96, 2)


def test_too_many_rows_are_refused(tmp_path, monkeypatch):
    write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    monkeypatch.setattr(rows_module, "MAX_ROWS", 95)
    with pytest.raises(InputError, match="96 rows; at most 95 are allowed"):
        read_rows(tmp_path / "rows.csv")


def test_settings_shared_by_all_rows_are_read(tmp_path):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    table.assign(**{"panel.friction": 0.8, "seeding.seed": 3}).to_csv(tmp_path / "rows.csv")
    settings = read_rows(tmp_path / "rows.csv").settings
    assert settings["panel.friction"] == "0.8"
    assert not {"panel.height", "seeding.seed", "height_m"} & set(settings)


def test_a_repeated_stack_is_refused(tmp_path):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    pd.concat([table, table]).to_csv(tmp_path / "twice.csv", index=False)
    with pytest.raises(InputError, match="lines 2 and 98: the same panel, event and seed twice"):
        read_rows(tmp_path / "twice.csv")
    pd.concat([table, table.assign(seed=2)]).to_csv(tmp_path / "seeds.csv", index=False)
    assert read_rows(tmp_path / "seeds.csv").stacks["ratio"].shape == (96, 2)


def test_conditions_choose_rows(tmp_path):
    modes = ["carry", "reseed"] * 48
    write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv", **{"events.between": modes})
    assert len(read_rows(tmp_path / "rows.csv", where={"events.between": "carry"})) == 48
    with pytest.raises(InputError, match=r"events.between: the rows have different values"):
        read_rows(tmp_path / "rows.csv")
    with pytest.raises(InputError, match=r"no row has the value x; there are: carry, reseed"):
        read_rows(tmp_path / "rows.csv", where={"events.between": "x"})


@pytest.mark.parametrize(
    ("column", "cell", "message"),
    [
        ("height_m", "tall", r"line 7, height_m: 'tall' is not a positive number"),
        ("length_m", "-1", r"line 7, length_m: '-1' is not a positive number"),
        ("length_m", "inf", r"line 7, length_m: 'inf' is not a positive number"),
        ("panel.tilt", "", r"line 7, panel.tilt: '' is not a number"),
        ("event", "1.5", r"line 7, event: '1.5' is not a whole number"),
        ("dx", "0.02", r"dx: the rows have different values"),
        ("particles_per_voxel", "9", r"particles_per_voxel: the rows have different values"),
    ],
)
def test_wrong_cells_are_named(tmp_path, column, cell, message):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv").astype(str)
    table.loc[5, column] = cell
    table.to_csv(tmp_path / "rows.csv", index=False)
    with pytest.raises(InputError, match=r"rows.csv: .*" + message):
        read_rows(tmp_path / "rows.csv")


def test_missing_columns_and_few_rows_are_refused(tmp_path):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    table.drop(columns="panel.tilt").to_csv(tmp_path / "no-tilt.csv", index=False)
    with pytest.raises(InputError, match=r"no column panel.tilt.*axes.panel.tilt = 40"):
        read_rows(tmp_path / "no-tilt.csv")
    table[:10].to_csv(tmp_path / "few.csv", index=False)
    with pytest.raises(InputError, match="10 rows; at least 20"):
        read_rows(tmp_path / "few.csv")
    (tmp_path / "binary.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not a table"):
        read_rows(tmp_path / "binary.csv")
    with pytest.raises(InputError, match="No such file"):
        read_rows(tmp_path / "none.csv")
    text = (tmp_path / "rows.csv").read_text()
    (tmp_path / "cut.csv").write_text(text[: text.rindex(",2,")])
    with pytest.raises(InputError, match=r"cut\.csv, line 97: not a table: 13 cells in 15 columns"):
        read_rows(tmp_path / "cut.csv")


def test_synthetic_rows_resemble_the_thesis_data():
    rows = synthetic_rows()
    quartiles = np.quantile(rows.targets["ratio"], (0.25, 0.5, 0.75, 1))
    np.testing.assert_allclose(quartiles, (0.057, 0.092, 0.142, 0.240), rtol=0.35)
    assert len(thesis_inputs()) == 610


def test_former_column_names_are_read(tmp_path):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    table.assign(step_factor=0.5).to_csv(tmp_path / "rows.csv", index=False)
    for name in ("step_factor", "courant_factor"):
        read = read_rows(tmp_path / "rows.csv", where={name: "0.5"})
        assert read.settings["courant_factor"] == "0.5"


def test_stacks_by_two_trimming_rules_are_not_mixed(tmp_path):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    trimming = ["outermost_first" if row % 2 else "equal_pace" for row in range(len(table))]
    columns = {f"equal_pace_{name}": 2 * table[name] for name in ("height_m", "length_m")}
    table.assign(trimming=trimming, **columns).to_csv(tmp_path / "rows.csv", index=False)
    with pytest.raises(InputError, match="trimming: the rows have different values"):
        read_rows(tmp_path / "rows.csv")
    chosen = read_rows(tmp_path / "rows.csv", measure="equal_pace")
    assert len(chosen) == 96 and chosen.settings["trimming"] == "equal_pace"
    assert chosen.targets["height"][0] == 2 * table["height_m"][0]


@pytest.mark.parametrize(
    ("change", "note"),
    [
        (
            {"panel.height": 1000.0, "panel.length": 1000.0},
            "panel.height = 1000.0: .*check its unit",
        ),
        ({"panel.tilt": np.pi / 180}, "panel.tilt = 0.698.* degrees is unusual.*check its unit"),
        ({"height_m": 100.0, "length_m": 100.0}, "96 stacks reach above the top of their panel"),
        ({"length_m": 0.01}, "96 of 96 stacks are higher than long"),
    ],
)
def test_values_in_other_units_are_noted(tmp_path, change, note):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    scaled = {name: table[name] * factor for name, factor in change.items()}
    table.assign(**scaled).to_csv(tmp_path / "rows.csv", index=False)
    with pytest.warns(UserWarning, match=note):
        read_rows(tmp_path / "rows.csv")


def test_an_input_that_no_scene_can_have_is_refused(tmp_path):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    table.assign(**{"panel.tilt": table["panel.tilt"] + 70}).to_csv(
        tmp_path / "rows.csv", index=False
    )
    with pytest.raises(InputError, match=r"line 2: /panel/tilt: 110 is outside the allowed range"):
        read_rows(tmp_path / "rows.csv")


def test_a_column_that_varies_and_is_ignored_is_noted(tmp_path):
    rows = synthetic_rows(few_inputs())
    write_table(rows, tmp_path / "rows.csv", friction=np.arange(len(rows)) % 2)
    with pytest.warns(UserWarning, match="^friction: the rows differ here"):
        read_rows(tmp_path / "rows.csv")


def test_copies_of_stacks_are_noted_and_refused_without_seeds(tmp_path):
    """Copies would make the scatter of the seeds too small."""
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    pd.concat([table, table.assign(seed=2)]).to_csv(tmp_path / "rows.csv", index=False)
    with pytest.warns(UserWarning, match="96 stacks equal another stack .* are they copies?"):
        read_rows(tmp_path / "rows.csv")
    pd.concat([table, table.assign(seed=np.nan)]).to_csv(tmp_path / "rows.csv", index=False)
    with pytest.raises(InputError, match=r"seed twice \(some rows have no seed\)"):
        read_rows(tmp_path / "rows.csv")


def test_rows_left_out_and_stacks_in_motion_are_noted(tmp_path):
    table = write_table(synthetic_rows(few_inputs()), tmp_path / "rows.csv")
    table.loc[[3, 7], ["height_m", "length_m"]] = np.nan
    table.loc[5, "ended"] = "time_limit"
    table.to_csv(tmp_path / "rows.csv", index=False)
    with pytest.warns(UserWarning) as notes:
        read_rows(tmp_path / "rows.csv")
    assert [str(note.message) for note in notes] == [
        "2 rows have no stack and are left out",
        "1 stack was still moving at the time limit",
    ]


@pytest.mark.parametrize(
    ("height", "length", "message"),
    [
        ([1.0], [4.0, 4.0], r"height: shape \(1,\); needed: \(2,\), as inputs"),
        ([1.0, 2.0], [4.0, 0.0], r"length\[1\]: 0 m; needed: a positive number"),
        ([np.nan, 2.0], [4.0, 4.0], r"height\[0\]: nan m; needed: a positive number"),
    ],
)
def test_arrays_that_are_no_stacks_are_refused(height, length, message):
    """A single height would pass for that of every stack."""
    with pytest.raises(InputError, match=message):
        stack_rows([[1, 2, 4, 40], [2, 2, 4, 40]], np.array(height), np.array(length))


def test_a_table_in_utf_16_is_named_as_such(tmp_path):
    (tmp_path / "rows.csv").write_text("event,height_m\n", encoding="utf-16")
    with pytest.raises(InputError, match=r"rows\.csv: not a table: text in UTF-16; save it"):
        read_rows(tmp_path / "rows.csv")


def test_a_study_file_may_begin_with_a_byte_order_mark():
    assert parse_toml(b"\xef\xbb\xbfpanel.tilt = 40") == {"panel": {"tilt": 40}}
