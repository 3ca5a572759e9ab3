"""The command, from a study to tables and figures; evaluation works on any stored study."""

import itertools

import pandas as pd
import pytest

from snowshed import Scene
from snowshed.analysis.sensitivity import read_study_runs
from snowshed.cli.main import main
from snowshed.results.folder import WORDS
from snowshed.study import Study
from snowshed.study.database import MEASURED_TYPES
from snowshed.study.outcome import RunOutcome
from snowshed.study.store import Store

SLOPE, COHESION = "snow.critical_state_slope", "snow.cohesion"


def run(*arguments):
    return main([str(argument) for argument in arguments])


def height(scene_snow, event):
    return 0.02 * event * (1 + scene_snow["cohesion"]) * scene_snow["critical_state_slope"]


def fill(folder, study, compute=lambda run: True):
    """Store heights from a formula in place of simulations."""
    import json

    with Store.create(folder) as store:
        store.register(study.name, study.axes, study.runs())
        for planned in filter(compute, study.runs()):
            snow = json.loads(planned.scene)["snow"]
            rows = []
            for event in (1, 2):
                row = {name: "rest" if name in WORDS else 1.0 for name in MEASURED_TYPES}
                row.update(event=event, wall_s=0.1, steps=10, height_m=height(snow, event))
                row.update(body_height_m=2 * height(snow, event), length_m=0.3)
                rows.append(row)
            store.record(RunOutcome(planned.hash, "done", rows, {}))


def grid(name="grid", seeds=None):
    scene = Scene.preset("sensitivity").update({"dimension": 2, "numerics.dx": 0.03})
    axes = {SLOPE: [0.3, 0.6], COHESION: [0.15, 0.3]}
    return Study.product(scene, axes, name=name, seeds=seeds)


@pytest.mark.parametrize("method", ["sobol", "morris"])
def test_without_salib_the_error_says_what_to_install(tmp_path, capsys, hide, method):
    hide("SALib")
    out = tmp_path / "out"
    assert run("sensitivity", "--method", method, "--quick", "--dry-run", "-o", out) == 2
    message = capsys.readouterr().err
    assert "needs SALib" in message and 'pip install "snowshed[sensitivity]"' in message
    assert message.count("\n") == 1 and not out.exists()
    assert run("sensitivity", "--method", "s", "--quick", "--dry-run", "-o", out) == 0


@pytest.mark.parametrize("method", ["s", "fixation"])
def test_any_stored_study_is_evaluated_without_running(tmp_path, capsys, method):
    fill(tmp_path / "store", grid(seeds=[1, 2]))
    out = tmp_path / "out"
    arguments = ("--stored", tmp_path / "store", "-o", out)
    assert run("sensitivity", "--method", method, *arguments) == 0
    shown = capsys.readouterr().out
    assert "event 1" in shown and "event 2" in shown and str(out) in shown
    table = pd.read_csv(out / f"{method}.csv")
    assert set(table["parameter"]) == {SLOPE, COHESION}
    figures = {path.stem for path in out.glob("*.png")}
    assert figures == ({"s"} if method == "s" else {"fixation-yield"})
    if method == "s":
        slope = table[(table["parameter"] == SLOPE) & (table["target"] == "height")]
        assert slope["s"].tolist() == pytest.approx([1, 1])
    assert set(pd.read_csv(out / "noise.csv")["freedom"]) == {4}


def test_missing_runs_are_noted_unless_quiet(tmp_path, capsys):
    """A value that is the same in all runs need not be a number."""
    study = grid(seeds=[1, 2])
    axes = {"events.between": ["carry"], SLOPE: [0.3, 0.6], COHESION: [0.15, 0.3]}
    study = Study.product(study.scene, axes, name="grid", seeds=[1, 2])
    last = study.runs()[-1].hash
    fill(tmp_path / "store", study, lambda planned: planned.hash != last)
    arguments = ("sensitivity", "--stored", tmp_path / "store", "-o", tmp_path / "out")
    assert run(*arguments) == 0
    assert "note: 1 of 8 runs are not computed" in capsys.readouterr().err
    assert run(*arguments, "-q") == 0
    assert capsys.readouterr().err == ""


def test_designs_are_recognised_in_the_store(tmp_path, capsys):
    """A study file is computed and evaluated; one run is missing."""
    from snowshed.analysis.sensitivity import sensitivity_study

    sensitivity_study("morris", quick=True, samples=3).save(tmp_path / "morris.toml")
    study = Study.load(tmp_path / "morris.toml")
    last = study.runs()[-1].hash
    fill(tmp_path / "store", study, lambda planned: planned.hash != last)
    options = ("--method", "morris", "--stored", tmp_path / "store", "-o", tmp_path / "out")
    assert run("sensitivity", *options, "-q") == 0
    assert capsys.readouterr().out == ""
    table = pd.read_csv(tmp_path / "out" / "morris.csv")
    assert set(table["blocks"]) == {2} and "seeding.seed" in set(table["parameter"])
    assert (tmp_path / "out" / "morris.png").stat().st_size > 10_000


def test_a_second_design_in_the_same_folder_is_evaluated_too(tmp_path):
    """All runs are finished; the command must evaluate the study that it was given."""
    from snowshed.analysis.sensitivity import sensitivity_study

    out = tmp_path / "out"
    fill(out / "runs", grid("earlier"))
    file = tmp_path / "morris.toml"
    sensitivity_study("morris", quick=True, samples=2).save(file)
    fill(out / "runs", Study.load(file))
    assert run("sensitivity", "--method", "morris", "--study", file, "-o", out, "-q") == 0
    assert (out / "morris.csv").is_file()


def test_bodies_and_stacks_of_several_studies_are_read(tmp_path):
    for name in ("first", "second"):
        fill(tmp_path / "store", grid(name))
    stack = read_study_runs(tmp_path / "store", "first")
    body = read_study_runs(tmp_path / "store", "second", "body")
    assert (body.rows["height"] == 2 * stack.rows["height"]).all()
    assert stack.parameters == [SLOPE, COHESION] and stack.events == [1, 2]


def test_bad_arguments_and_studies_are_named(tmp_path, capsys):
    fill(tmp_path / "store", grid())
    fill(tmp_path / "empty", grid(), lambda planned: False)
    words = Study.product(grid().scene, {"numerics.transfer": ["flip", "apic"]}, name="words")
    fill(tmp_path / "words", words)
    bad = tmp_path / "bad.toml"
    bad.write_text("[scene]\npreset = 'sensitivity'\n[axes]\nsnow.cohesoin = [0.1]\n")
    out = ("-o", tmp_path / "out")
    for arguments, message in (
        (("--method", "s"), "give -o DIR"),
        (("--method", "x", *out), "method: 'x' is unknown"),
        (("--stored", tmp_path / "nothing", *out), "nothing"),
        (("--stored", tmp_path, "--quick", *out), "--quick has no effect with --stored"),
        (("--study", tmp_path, "--samples", 8, *out), "--samples has no effect with --study"),
        (("--stored", tmp_path / "store", "--name", "x", *out), "x"),
        (
            ("--stored", tmp_path / "store", "--method", "sobol", *out),
            "grid: points 1 to 4 are not",
        ),
        (("--stored", tmp_path / "empty", *out), "none of its runs is computed yet"),
        (("--stored", tmp_path / "words", *out), "numerics.transfer: holds 'flip'"),
        (("--study", bad, *out), "bad.toml: snow.cohesoin"),
        (("--study", tmp_path / "none.toml", *out), "none.toml: No such file"),
    ):
        assert run("sensitivity", *arguments) == 2
        assert message in capsys.readouterr().err


def test_a_damaged_store_is_named(tmp_path, capsys):
    (tmp_path / "store.sqlite").write_bytes(b"no database at all" * 100)
    assert run("sensitivity", "--stored", tmp_path, "-o", tmp_path / "out") == 3
    error = capsys.readouterr().err
    assert error.startswith(f"error: {tmp_path / 'store.sqlite'}: file is not a database")
    assert error.count("\n") == 1


def test_the_dry_run_counts_the_runs(tmp_path, capsys):
    options = ("--quick", "--dry-run", "-o", tmp_path)
    assert run("sensitivity", "--method", "fixation", *options) == 0
    assert "sensitivity-fixation-quick: 70 runs" in capsys.readouterr().out


def test_a_study_of_real_snow_is_computed_and_resumed(tmp_path, capsys):
    """Two tiny runs end in mid-air; the second call has nothing to compute."""
    file = tmp_path / "tiny.toml"
    file.write_text(
        'name = "tiny"\ndimension = 2\nevents = 1\n'
        '[scene]\npreset = "lab-50"\nevents.max_time = 0.05\n'
        "[accuracy]\ndx = 0.03\n[axes]\nsnow.cohesion = [0.1, 0.2]\n"
    )
    options = ("sensitivity", "--study", file, "-o", tmp_path / "out", "--jobs", "1")
    for _ in range(2):
        assert run(*options) == 0
        assert "2 of 2 runs done" in capsys.readouterr().out
    table = pd.read_csv(tmp_path / "out" / "s.csv")
    assert list(itertools.chain(table["nominal"], table["altered"])) == [0.1, 0.1, 0.2, 0.2]
