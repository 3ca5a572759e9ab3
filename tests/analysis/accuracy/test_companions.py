import json

import numpy as np
import pandas as pd
import pytest

from snowshed import InputError, Scene
from snowshed.analysis.accuracy.companions import companions, errors_of
from snowshed.cli.main import main
from snowshed.scene import example_slide


def runs(value, seeds=3, sizes=(0.01, 0.014, 0.02)):
    rows = [(dx, value(dx)) for dx in sizes for _ in range(seeds)]
    return pd.DataFrame(rows, columns=["numerics.dx", "height_m"])


def test_the_limit_of_fine_grids_is_extrapolated_linearly():
    error = errors_of("height", runs(lambda dx: 0.1 + 4 * dx), "height_m")
    assert error.limit == pytest.approx(0.1) and error.bias == pytest.approx(0.4)
    assert error.scatter == pytest.approx(0, abs=1e-12)
    assert "40 % above the limit of fine grids, 0.100" in error.sentence


def test_the_standard_error_agrees_with_the_scatter_of_repeated_checks():
    limits, variances = [], []
    for seed in range(400):
        random = np.random.default_rng(seed)
        table = runs(lambda dx: 0.1 + dx)
        table["height_m"] += 0.01 * random.standard_normal(len(table))
        error = errors_of("height", table, "height_m")
        limits.append(error.limit)
        variances.append(error.limit_error**2)
    assert np.std(limits) == pytest.approx(np.sqrt(np.mean(variances)), rel=0.12)


def test_a_negative_limit_is_explained_by_a_coarse_grid():
    error = errors_of("height", runs(lambda dx: 9 * dx - 0.01), "height_m")
    assert "the grid is too coarse" in error.sentence


def test_scenes_without_a_slab_are_refused(tmp_path):
    with pytest.raises(InputError, match="slabs of the material point method only"):
        companions(example_slide(tmp_path))


def test_the_command_refuses_scenes_without_a_slab_before_it_runs_them(tmp_path, capsys):
    scene = tmp_path / "slide.json"
    example_slide(tmp_path).resolve().save(scene)
    assert main(["run", str(scene), "--check", "-o", str(tmp_path / "out")]) == 2
    assert "--check: the error is measured for slabs" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_the_command_measures_prints_and_stores_the_error(tmp_path, capsys):
    coarse = ["--dim", "2", "--dx", "0.02", "--events", "1", "--friction", "0.3"]
    out = tmp_path / "out"
    assert main(["panel", "--preset", "lab-50", *coarse, "--check", "-o", str(out)]) == 0
    shown = capsys.readouterr().out
    stored = {entry["name"]: entry for entry in json.loads((out / "check.json").read_text())}
    assert set(stored) == {"height", "length", "centre of mass", "spread"}
    assert f"height {stored['height']['means'][0]:.3f} m (scatter of a run" in shown
    assert len(stored["height"]["means"]) == 3
    assert Scene.load(out / "scene.json").numerics.dx == 0.02
