"""Studies of loading tests give the figures of single tests."""

import json

import pytest
from helpers.grain_files import VOXEL, write_labels

from snowshed import GrainsSettings, LoadingStage
from snowshed.running.run import run
from snowshed.scene import grains_scene
from snowshed.study import Study, read_table


def test_the_table_agrees_with_a_single_test(tmp_path):
    scene = grains_scene(
        write_labels(tmp_path),
        VOXEL,
        [LoadingStage(kind="compress", strain=1e-3, speed=0.05)],
        settings=GrainsSettings(density_scaling=100.0),
    )
    axes = {"numerics.elastic_modulus": [5e8, 1e9], "loading.0.strain": [1e-3]}
    study = Study.product(scene, axes, name="grains")
    study.compute(tmp_path / "runs", jobs=1, threads=1)
    table = read_table(tmp_path / "runs")
    assert table["ended"].tolist() == ["rest", "rest"]
    run(json.loads(study.runs()[-1].scene), tmp_path / "out", pictures=False)
    single = json.loads((tmp_path / "out/grains.json").read_text())
    row = table.iloc[-1]
    assert row["final_particles"] == single["final_particles"]
    for name in ("spheres", "bonds", "tangent_modulus_pa", "strength_pa", "axial_strain"):
        assert row[name] == pytest.approx(single[name], rel=1e-15)
    soft, stiff = table["tangent_modulus_pa"]
    assert soft < stiff
