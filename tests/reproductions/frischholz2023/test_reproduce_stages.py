"""Stages, their order and names, resuming, and the options that a folder accepts."""

import json
import re
from dataclasses import replace

import pandas as pd
import pytest
from reproduce_helpers import TINY, TINY_WITH_PANELS, few_fits, fill, geometry_table
from reproductions.common.stage import State, StudyStage, choose, compute
from reproductions.frischholz2023 import studies
from reproductions.frischholz2023.publication import REPRODUCTION
from reproductions.frischholz2023.sections.regression import read_results
from reproductions.frischholz2023.settings import FULL, MIDDLE, PLANAR, QUICK
from reproductions.frischholz2023.stages import ThesisComputation

from snowshed import Scene
from snowshed._core import InputError
from snowshed.study import Study

NAMES = ["lab", "s-index", "fixation", "calibration", "deviations", "variations"]
NAMES += ["geometry", "regression"]


def test_full_has_the_runs_of_the_thesis():
    """Tables 2.3.1, 3.2.1, 3.3.1, 4.1.1, 5.1.1, 5.2.1, with several seedings."""
    counts = {study.name: len(study.runs()) for study in studies.fixation(FULL)}
    counts.update({study.name: len(study.runs()) for study in studies.index(FULL)})
    counts.update({study.name: len(study.runs()) for study in studies.calibration(FULL)})
    assert counts["sensitivity-fixation"] == (27 + 9 - 1) * FULL.fixation_seeds
    assert counts["sensitivity-s"] == 9 * FULL.index_seeds
    assert counts["calibration"] == 48 * 2 * FULL.grid_seeds
    assert (FULL.folds.rounds, FULL.folds.folds, FULL.folds.inner_folds) == (10, 10, 5)
    for make in (studies.index, studies.fixation, studies.calibration):
        for study in make(FULL):
            scene = json.loads(study.runs()[0].scene)
            assert (scene["dimension"], scene["numerics"]["dx"]) == (3, 0.01)


def test_middle_is_the_thesis_at_the_measured_frictions():
    assert MIDDLE.frictions == (0.6, 0.8) and not MIDDLE.simulates_panels
    for make in (studies.lab, studies.index, studies.fixation, studies.calibration):
        few, many = (sum(len(study.runs()) for study in make(size)) for size in (MIDDLE, FULL))
        assert few < many
        scene = json.loads(make(MIDDLE)[-1].runs()[0].scene)
        assert (scene["dimension"], scene["numerics"]["dx"]) == (3, 0.01)


def test_the_laboratory_has_both_dimensions_and_30_degrees():
    scenes = {study.name: [json.loads(run.scene) for run in study.runs()]
              for study in studies.lab(FULL)}  # fmt: skip
    assert {scene["dimension"] for scene in scenes[studies.LABORATORIES[2]]} == {2}
    assert {scene["dimension"] for scene in scenes[studies.LABORATORIES[3]]} == {3}
    for name in (studies.LABORATORIES[2], studies.LABORATORIES[3]):
        assert {scene["panel"]["tilt"] for scene in scenes[name]} == {40, 50}
        assert {scene["events"]["count"] for scene in scenes[name]} == {5}
    assert {scene["panel"]["tilt"] for scene in scenes[studies.RELEASE]} == {30}
    assert len(scenes[studies.RELEASE]) == len(FULL.release_frictions) > 1


def test_panels_differ_only_in_height_length_and_tilt():
    scenes = [json.loads(run.scene) for study in studies.geometry(FULL) for run in study.runs()]
    for scene in scenes:
        for name in ("height", "length", "tilt"):
            del scene["panel"][name]
        del scene["slab"]["length"]
    assert all(scene == scenes[0] for scene in scenes)


def test_the_synthetic_truth_is_not_on_the_grid():
    grid, truth = studies.calibration(QUICK)
    assert not {run.hash for run in grid.runs()} & {run.hash for run in truth.runs()}
    snow = json.loads(truth.runs()[0].scene)["snow"]
    assert (snow["critical_state_slope"], snow["cohesion"]) == (0.5, 0.2)
    assert snow["preconsolidation_pressure"] == 7e3


def test_stages_are_chosen_by_name(tmp_path):
    computation = ThesisComputation(tmp_path / "out", TINY_WITH_PANELS, None)
    assert [stage.name for stage in choose(computation.stages, [])] == NAMES
    assert [stage.name for stage in choose(computation.stages, ["regression", "lab"])] == [
        "lab",
        "regression",
    ]
    with pytest.raises(InputError, match="stage: 'x' is unknown; allowed: lab, s-index"):
        choose(computation.stages, ["x"])


def test_a_table_replaces_the_stage_of_panels(tmp_path):
    table = geometry_table(tmp_path / "rows.csv")
    computation = ThesisComputation(tmp_path / "out", FULL, table)
    assert [stage.name for stage in computation.stages] == [
        name for name in NAMES if name != "geometry"
    ]
    assert len(computation.rows.read()) == computation.rows.count() == 72


def prepare(folder, size="quick", **options):
    defaults = {"condition": "separate", "scheme": "thesis"}
    REPRODUCTION.prepare(folder, size, {**defaults, **options})


def test_a_folder_is_for_one_size_one_condition_and_one_scheme(tmp_path):
    prepare(tmp_path / "out")
    prepare(tmp_path / "out")
    with pytest.raises(InputError, match="with --quick; take a new folder for --full"):
        prepare(tmp_path / "out", "full")
    with pytest.raises(InputError, match="with --condition separate; take a new folder for"):
        prepare(tmp_path / "out", condition="slip")
    with pytest.raises(InputError, match="with --scheme thesis; take a new folder for"):
        prepare(tmp_path / "out", scheme="objective")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "file").touch()
    with pytest.raises(InputError, match="not empty, and holds no reproduction"):
        prepare(tmp_path / "other")
    for content in (b"", b"\xff", b"[]", b"[" * 100_000):
        (tmp_path / "out" / "reproduction.json").write_bytes(content)
        with pytest.raises(InputError, match=r"reproduction\.json: damaged: "):
            prepare(tmp_path / "out")


def test_a_folder_of_an_early_version_is_resumed(tmp_path):
    """Folders of early versions name neither the publication, nor the condition, nor the scheme."""
    (tmp_path / "reproduction.json").write_text('{"size": "quick"}')
    prepare(tmp_path)
    with pytest.raises(InputError, match="take a new folder for --condition slip"):
        prepare(tmp_path, condition="slip")


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("scores.csv", b"", "not a table: "),
        (
            "scores.csv",
            b"model\nrbf\nlinear\n",
            "damaged: no numbers in a column development_score",
        ),
        ("ratio/errors.csv", b"\xff\x00", "not a table: not UTF-8 text"),
        (
            "ratio/errors.csv",
            b"model,held_out_error\nrbf,x\n",
            "damaged: no numbers in a column mean",
        ),
        ("ratio/quartiles.csv", b"model,Q1,Q2,Q3,Q4\nrbf,1,2,3,4\n", "damaged: not a row of each"),
    ],
)
def test_damaged_tables_of_the_regression_are_named(tmp_path, name, content, message):
    numbers = {"development_score": 1.0, "validation_score": 1.0, "C": 1.0}
    numbers.update({"mean_absolute_error": 1.0, "standard_deviation": 1.0})
    numbers.update({"held_out_error": 1.0, "Q1": 1.0, "Q2": 2.0, "Q3": 3.0, "Q4": 4.0})
    table = pd.DataFrame([{"model": model, **numbers} for model in ("data", "rbf", "linear")])
    (tmp_path / "ratio").mkdir()
    for file in ("scores.csv", "ratio/errors.csv", "ratio/quartiles.csv"):
        table.to_csv(tmp_path / file, index=False)
    assert read_results(tmp_path, 96, 32).errors.loc["rbf", "held_out_error"] == 1.0
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=rf"{re.escape(name)}(, line 1)?: {message}"):
        read_results(tmp_path, 96, 32)


def tiny_studies():
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.03})
    scene.update({"events": {"count": 1, "max_time": 0.05}})
    return [Study.product(scene, {"snow.cohesion": [0.1, 0.2]}, name="tiny")]


def test_a_finished_stage_is_not_repeated(tmp_path):
    stage = StudyStage("tiny", tmp_path / "runs", tiny_studies)
    assert stage.state() == State(0, 0, 2) and stage.expected_s(1) > 0
    reports = []
    compute([stage], jobs=1, progress=reports.append)
    assert stage.state().finished and stage.expected_s(1) == 0
    fractions = [report.fraction for report in reports]
    assert fractions == sorted(fractions) and fractions[-1] == 1
    assert reports[-1].doing == "tiny: 2/2 simulations"
    repeated_reports = []
    compute(
        [StudyStage("tiny", tmp_path / "runs", tiny_studies)],
        jobs=1,
        progress=repeated_reports.append,
    )
    assert repeated_reports == []


def test_regression_is_resumed_and_not_repeated(tmp_path):
    table = geometry_table(tmp_path / "rows.csv")
    computation = ThesisComputation(tmp_path / "out", TINY, table)
    stage = computation.regression
    assert stage.state() == State(0, 0, 4, "folds") and stage.expected_s(1) > 0
    with few_fits():
        compute([stage], jobs=1)
    assert stage.state().finished and stage.expected_s(1) == 0
    fold = next(stage.parts()[0].folder.glob("folds/*/*/*.npz"))
    before = fold.stat().st_mtime_ns
    compute([stage], jobs=1)
    assert fold.stat().st_mtime_ns == before


def test_regression_waits_for_the_panels(tmp_path):
    computation = ThesisComputation(tmp_path / "out", TINY_WITH_PANELS, None)
    with pytest.raises(InputError, match="stage geometry: 0 of 125 simulations done"):
        computation.regression.compute(1, lambda fraction, words: None)
    fill(computation, ["geometry"])
    assert len(computation.rows.read()) == 610


def test_a_quick_reproduction_uses_the_rows_of_the_package(tmp_path):
    computation = ThesisComputation(tmp_path / "out", TINY, None)
    assert "geometry" not in computation.study_stages and len(computation.rows.read()) == 610


def test_a_scheme_applies_to_all_simulations_with_its_damping():
    makers = (studies.lab, studies.index, studies.fixation, studies.calibration, studies.geometry)
    for make in makers:
        for study in make(replace(QUICK, scheme="objective")):
            numerics = json.loads(study.runs()[0].scene)["numerics"]
            assert (numerics["scheme"], numerics["damping_rate"]) == ("objective", 380)


def test_another_scheme_uses_no_deviations_and_its_own_rows_of_the_package(tmp_path):
    computation = ThesisComputation(tmp_path / "out", replace(TINY, scheme="objective"), None)
    assert list(computation.study_stages) == [
        "lab",
        "s-index",
        "fixation",
        "calibration",
    ]
    assert set(computation.rows.read().settings["scheme"].split()) == {"objective"}


def test_planar_is_middle_in_two_dimensions():
    assert replace(PLANAR, dimension=3, lab_dimensions=(2, 3)) == MIDDLE
    assert {json.loads(run.scene)["dimension"] for make in (studies.lab, studies.fixation)
            for study in make(PLANAR) for run in study.runs()} == {2}  # fmt: skip
