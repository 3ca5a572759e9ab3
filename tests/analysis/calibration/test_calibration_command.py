"""The command, from measurements to figures; and recovery of snow from coarse simulations."""

import itertools
import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from stand_in import COHESION, PARAMETERS, fill, measured, write_measurements

from snowshed import Scene, SnowshedNote
from snowshed.analysis.calibration import (
    Measurement,
    calibrate,
    calibration_study,
    read_measurements,
    read_simulated_stacks,
)
from snowshed.base.notes import record_notes
from snowshed.cli.main import main
from snowshed.study import Factor, Span, Study, axis, latin_hypercube

TRUTH = (0.5, 6.5e3, 0.15)


def run(*arguments):
    return main([str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def evaluated(tmp_path_factory):
    """The folder of a calibration on the corners of the grid, with stacks from a formula."""
    folder = tmp_path_factory.mktemp("calibration")
    write_measurements(measured(TRUTH), folder / "stacks.csv")
    study = calibration_study(read_measurements(folder / "stacks.csv"), quick=True)
    fill(folder / "store", study)
    options = ("--stored", folder / "store", "-o", folder / "out")
    assert run("calibrate", folder / "stacks.csv", *options, "-q") == 0
    return folder


def test_tables_and_figures_are_written(evaluated):
    out = evaluated / "out"
    ranking = pd.read_csv(out / "ranking.csv")
    assert len(ranking) == 12 and ranking["rank"].tolist() == list(range(1, 13))
    ranges = pd.read_csv(out / "ranges.csv").set_index("parameter")
    assert list(ranges.index) == list(PARAMETERS)
    for path, true in zip(PARAMETERS, TRUTH):
        assert ranges.loc[path, "lower_95"] < true < ranges.loc[path, "upper_95"]
        assert ranges.loc[path, "best_set"] == ranking.loc[0, path]
    assert len(pd.read_csv(out / "comparison.csv")) == 12 * 12
    assert len(pd.read_csv(out / "surrogate.csv")) == 12
    assert set(pd.read_csv(out / "posterior.csv")) >= {COHESION, "discrepancy_height"}
    assert set(pd.read_csv(out / "rmse-statistics.csv")["score"]) == {
        "height_rmse_m",
        "length_rmse_m",
    }
    draws = xr.open_dataset(out / "posterior.nc")
    assert draws.sizes["draw"] > 1000 and set(draws) >= {COHESION, "discrepancy_height"}
    assert (ranges["r_hat"] < 1.1).all() and (ranges["ess_tail"] > 400).all()
    for name in ("relative-error", "rmse", "fit", "posterior"):
        assert (out / f"{name}.png").stat().st_size > 10_000


@pytest.mark.parametrize("library", ["emcee", "sklearn", "arviz", "corner"])
def test_without_a_library_the_error_says_what_to_install(
    evaluated, tmp_path, capsys, hide, library
):
    hide(library)
    options = ("--stored", evaluated / "store", "-o", tmp_path / "out", "-q")
    assert run("calibrate", evaluated / "stacks.csv", *options) == 2
    message = capsys.readouterr().err
    assert f"needs {library}" in message and 'pip install "snowshed[calibration]"' in message
    assert message.count("\n") == 1 and not (tmp_path / "out").exists()


@pytest.mark.parametrize("library", ["emcee", "sklearn", "arviz", "corner", "xarray"])
def test_without_a_library_nothing_is_computed(
    evaluated, tmp_path, capsys, hide, monkeypatch, library
):
    def computes(*_, **__):
        raise AssertionError("runs were computed that cannot be evaluated")

    monkeypatch.setattr("snowshed.cli.commands.designed_study.compute_study", computes)
    hide(library)
    options = ("--quick", "-o", tmp_path / "out", "-q")
    assert run("calibrate", evaluated / "stacks.csv", *options) == 2
    assert f"needs {library}" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    if library != "xarray":  # the dry run does without it
        assert run("calibrate", evaluated / "stacks.csv", *options, "--dry-run") == 0


def test_tables_and_warnings_are_printed(evaluated, capsys):
    from snowshed.cli.commands.calibrate import print_calibration

    stacks = read_simulated_stacks(evaluated / "store")
    measurements = read_measurements(evaluated / "stacks.csv")
    with record_notes() as notes:  # 100 steps are too few
        print_calibration(calibrate(measurements, stacks, steps=100))
    shown = capsys.readouterr().out
    assert "Parameter sets by mean rescaled RMSE" in shown and "p₀, kPa" in shown
    assert "ESS" in shown and "r_hat" in shown
    assert any("the Markov chains have not converged" in note for note in notes)
    assert any("error of the model in height" in note for note in notes)


def test_missing_runs_are_reported(evaluated, tmp_path, capsys):
    from snowshed.cli.commands.calibrate import print_calibration

    grid = calibration_study(read_measurements(evaluated / "stacks.csv"))
    fill(tmp_path / "store", grid, pending=40)
    stacks = read_simulated_stacks(tmp_path / "store")
    assert stacks.pending == 40
    with pytest.warns(SnowshedNote, match="40 runs of the study are not computed yet"):
        calibration = calibrate(read_measurements(evaluated / "stacks.csv"), stacks, steps=100)
    print_calibration(calibration)
    assert "Parameters that the measurements allow" in capsys.readouterr().out


def test_the_template_is_written(tmp_path, capsys):
    assert run("calibrate", "--template", tmp_path / "stacks.csv") == 0
    assert run("calibrate", tmp_path / "stacks.csv", "-o", tmp_path / "out") == 2
    assert "stacks.csv: no measurement in it" in capsys.readouterr().err


def test_a_dry_run_counts_runs_and_bad_options_are_named(tmp_path, capsys):
    write_measurements(measured(TRUTH), tmp_path / "stacks.csv")
    options = (tmp_path / "stacks.csv", "-o", tmp_path / "out")
    assert run("calibrate", *options, "--quick", "--dry-run") == 0
    assert "calibration-quick: 48 runs" in capsys.readouterr().out
    bad = tmp_path / "bad.csv"
    bad.write_text("tilt_deg,event,height_m,height_std_m\n40,one,0.1,0.01\n")
    for arguments, message in (
        ((), "give a MEASUREMENTS file"),
        ((tmp_path / "stacks.csv",), "give -o DIR"),
        ((tmp_path / "none.csv", "-o", tmp_path), "none.csv: No such file"),
        ((bad, "-o", tmp_path), "bad.csv, line 2: event: 'one' is not a number"),
        ((*options, "--stored", tmp_path / "nowhere"), "nowhere"),
        ((*options, "--stored", tmp_path, "--dry-run"), "--dry-run has no effect with --stored"),
        ((*options, "--study", tmp_path / "x", "--seeds", 3), "--seeds has no effect with --study"),
        ((*options, "--name", "grid"), "--name needs --stored"),
        ((*options, "--quantity", "width", "--study", tmp_path / "no.toml"), "no.toml"),
    ):
        assert run("calibrate", *arguments) == 2
        assert message in capsys.readouterr().err


@pytest.mark.slow
def test_snow_parameters_are_recovered_from_coarse_simulations(tmp_path):
    """Measurements of simulated stacks have an error of 3 %; the fit uses other runs and seeds."""
    scene = Scene.preset("lab-40").update({"dimension": 2, "numerics.dx": 0.03})
    scene.update({"events.count": 3, "snow.hardening_factor": 0.1, "snow.youngs_modulus": 1e6})
    spans = {
        PARAMETERS[0]: Span(0.3, 0.8),
        PARAMETERS[1]: Span(2e3, 8e3),
        COHESION: Span(0.05, 0.4),
    }
    tilts = axis("panel.tilt", [40, 50])
    truth = {PARAMETERS[0]: 0.5, PARAMETERS[1]: 5e3, COHESION: 0.25}
    truth_study = Study(
        scene, [[tilts, Factor({p: [v] for p, v in truth.items()})]], "known", [901]
    )
    study = Study(scene, [[tilts, latin_hypercube(spans, 40)]], "sample", [1])
    table = truth_study.run(tmp_path, jobs=1, threads=1)
    random = np.random.default_rng(7)
    measurements = []
    for row, quantity in itertools.product(table.to_dict("records"), ("height", "length")):
        value = row[f"{quantity}_m"]
        noisy = value * (1 + 0.03 * random.normal())
        at = (float(row["panel.tilt"]), int(row["event"]), 1)
        measurements.append(Measurement(*at, quantity, noisy, 0.03 * value))
    study.run(tmp_path, jobs=1, threads=1)
    calibration = calibrate(measurements, read_simulated_stacks(tmp_path, "sample"))
    ranges = calibration.ranges.set_index("parameter")
    print(json.dumps(ranges.reset_index().to_dict("records"), indent=1))
    for path, true in truth.items():
        assert ranges.loc[path, "lower_95"] < true < ranges.loc[path, "upper_95"]
    width = (ranges["upper_95"] - ranges["lower_95"]) / (ranges["high"] - ranges["low"])
    assert width.min() < 0.75  # the data narrow a range
