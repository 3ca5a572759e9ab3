"""The table of stacks is the same from a store, its exports and results folders."""

import copy
import shutil

import numpy as np
import pandas as pd
import pytest

from snowshed import InputError, Scene, run_events
from snowshed.analysis.sensitivity.stored import read_study_runs
from snowshed.study import Study, export
from snowshed.study.stack_table import StackTable

SCENE = Scene.preset("lab-50").update(
    {"dimension": 2, "numerics.dx": 0.02, "events.count": 2, "events.max_time": 0.4}
)


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stacks") / "store"
    axes = {"panel.tilt": [40.0, 50.0], "snow.cohesion": [0.2]}
    Study.product(SCENE, axes, name="tilts", seeds=[1, 2]).compute(folder, jobs=1, threads=1)
    return folder


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_an_exported_file_has_the_stacks_of_its_store(store, tmp_path, ending):
    export(store, tmp_path / f"table.{ending}")
    from_store = StackTable.read(store)
    from_file = StackTable.read(tmp_path / f"table.{ending}")
    for measure in ("stack", "body"):
        stored_stacks, exported_stacks = (
            table.measured(measure, ["height", "length"]) for table in (from_store, from_file)
        )
        for name in ("panel.tilt", "seed", "event", "height", "length"):
            np.testing.assert_array_equal(
                stored_stacks[name].to_numpy(float), exported_stacks[name].to_numpy(float)
            )
    assert (
        from_store.varying(from_store.axes, "this")
        == from_file.varying(from_file.axes, "this")
        == ["panel.tilt"]
    )
    stored, exported = read_study_runs(store), read_study_runs(tmp_path / f"table.{ending}")
    assert stored.parameters == exported.parameters == ["panel.tilt"]
    assert stored.rows["height"].tolist() == exported.rows["height"].tolist()


def test_a_results_folder_has_the_stacks_of_its_run(store, tmp_path):
    run_events(copy.deepcopy(SCENE).set("panel.tilt", 40.0), tmp_path / "out", pictures=False)
    single = StackTable.read(tmp_path / "out")
    frame = StackTable.read(store).frame
    same = frame[frame["hash"] == single.frame["hash"].iloc[0]]
    assert len(same) == 2 and set(same["panel.tilt"]) == {40.0} and set(same["seed"]) == {1}
    heights = single.measured("stack", ["height"])["height"]
    assert heights.tolist() == pytest.approx(same["height_m"].tolist(), rel=1e-8)
    assert single.numbers("panel.tilt").tolist() == [40.0, 40.0]


def test_a_store_in_the_subfolder_runs_is_read(store, tmp_path):
    """The folder of ``sensitivity -o results`` may be given as ``--stored results``."""
    shutil.copytree(store, tmp_path / "results" / "runs")
    table = StackTable.read(tmp_path / "results")
    pd.testing.assert_frame_equal(table.frame, StackTable.read(store).frame)
    with pytest.raises(InputError, match="holds no study"):
        StackTable.read(tmp_path)


def test_other_tables_are_refused(store, tmp_path):
    (tmp_path / "a.csv").write_text("event,height_m\n1,much\n2,0.1\n")
    table = StackTable.read(tmp_path / "a.csv")
    with pytest.raises(InputError, match="line 2, height_m: 'much' is not a positive number"):
        table.numbers("height_m", positive=True)
    with pytest.raises(InputError, match="no column length_m; it has event, height_m"):
        table.measured("stack", ["height", "length"])
    with pytest.raises(InputError, match="measure: 'heap' is unknown; allowed: stack, body"):
        table.measured("heap", ["height"])
    with pytest.raises(InputError, match="holds no study 'x'"):
        StackTable.read(store, "x")
    with pytest.raises(InputError, match=r"none\.csv: No such file"):
        StackTable.read(tmp_path / "none.csv")


def test_a_table_of_an_early_version_has_the_trimming_rule_of_its_time(store, tmp_path):
    """Its measures have the name of that rule; those of the other rule are missing."""
    export(store, tmp_path / "new.csv")
    new = pd.read_csv(tmp_path / "new.csv")
    former = [name for name in new if "trimm" in name or "_pace_" in name or "most_first" in name]
    assert len(former) == 1 + 2 * 4
    new.drop(columns=former).to_csv(tmp_path / "old.csv", index=False)
    old = StackTable.read(tmp_path / "old.csv")
    assert set(old.frame["trimming"]) == {"equal_pace"}
    for name in ("height", "length", "head", "tail"):
        plain, named = (
            old.measured(measure, [name])[name].tolist() for measure in ("stack", "equal_pace")
        )
        assert (
            plain == named == new[f"{name}_m"].dropna().tolist()
        )  # NaN while all snow is in the air
    with pytest.raises(
        InputError, match=r"no column outermost_first_height_m.*without that trimming rule"
    ):
        old.measured("outermost_first", ["height"])


def test_every_stack_has_both_readings(store):
    table = StackTable.read(store)
    lengths = {
        name: table.measured(name, ["length"])["length"].to_numpy()
        for name in ("stack", "outermost_first", "equal_pace")
    }
    assert (lengths["stack"] == lengths["outermost_first"]).all()
    assert (lengths["equal_pace"] != lengths["outermost_first"]).any()


def merged(store, tmp_path, change):
    """Return the table of a store after a change, written and read again."""
    frame = StackTable.read(store).frame
    change(frame).to_csv(tmp_path / "merged.csv", index=False)
    return tmp_path / "merged.csv"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda t: pd.concat([t, t]),
            "line 10: the stack of .*seed = 1, event = 1 is there twice",
        ),
        (
            lambda t: pd.concat([t, t.assign(dx=0.05, seed=t["seed"] + 7, hash=t["hash"] + "b")]),
            r"dx: the rows have different values \(0\.02, 0\.05\), and their stacks are not",
        ),
        (lambda t: t.assign(hash="one"), "hash one: the rows of this run differ .*panel.tilt"),
        (lambda t: t.assign(hash=""), "line 2, hash: '' is not a run's hash"),
        (lambda t: t.drop(columns="hash"), "no column hash"),
        (lambda t: t.assign(length_m="0,5"), "line 2, length_m: '0,5' is not a number"),
    ],
)
def test_tables_put_together_by_hand_are_refused_if_they_mislead(store, tmp_path, change, message):
    """Copies would pass for seeds, and other settings for the scatter of the seeds."""
    with pytest.raises(InputError, match=message):
        read_study_runs(merged(store, tmp_path, change))


def test_a_number_has_the_same_meaning_in_every_spelling(store, tmp_path):
    def respelled(table):
        texts = table["panel.tilt"].map(str)
        return table.assign(**{"panel.tilt": texts.where(table.index % 2 > 0, texts + "0")})

    file = merged(store, tmp_path, respelled)
    assert set(pd.read_csv(file, dtype=str)["panel.tilt"]) == {"40.0", "40.00", "50.0", "50.00"}
    assert len(read_study_runs(file).points) == len(read_study_runs(store).points) == 4
    assert len(StackTable.read(file).chosen({"panel.tilt": "40"}).frame) == 4
