"""Studies of snow slides: the figures of single slides, and the stored maps."""

import json

import numpy as np
import pytest

from snowshed import InputError, UnusualValueNote
from snowshed.analysis.hazard.maps import hazard_maps, wilson_interval
from snowshed.io.raster.raster import read_raster
from snowshed.methods.slide.maps import PeakMaps
from snowshed.running.run import run
from snowshed.scene import example_slide
from snowshed.study import Study, read_table
from snowshed.study.store import Store

AXES = {"numerics.friction": [0.3, 0.5], "terrain.release.0.thickness": [0.4, 0.6]}


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    scene = example_slide(tmp_path_factory.mktemp("terrain")).set("events.max_time", 1.5)
    return Study.product(scene, AXES, name="slides")


@pytest.fixture(scope="module")
def computed_folder(study, tmp_path_factory):
    folder = tmp_path_factory.mktemp("store") / "runs"
    study.compute(folder, jobs=1, threads=1, keep_particles=True)
    return folder


def test_unusual_factors_are_told_before_a_slide_runs(tmp_path):
    axes = {"numerics.friction": [0.3, 30], "terrain.release.0.thickness": [5, 6]}
    with pytest.warns(UnusualValueNote) as notes:
        Study.product(example_slide(tmp_path), axes)
    texts = " ".join(str(note.message) for note in notes)
    assert "numerics.friction = 30: /numerics/friction: 30 is unusual" in texts
    assert "terrain.release.0.thickness = 5: /terrain/release/0/thickness: 5 m is" in texts


def test_the_table_agrees_with_a_single_slide(study, computed_folder, tmp_path):
    table = read_table(computed_folder)
    assert table["ended"].tolist() == ["time_limit"] * 4
    assert table["numerics.friction"].tolist() == [0.3, 0.3, 0.5, 0.5]
    assert not {"height_m", "dx", "trimming"} & set(table)  # columns of stacks
    assert (table["time_step"] == 0.01).all() and (table["steps"] == 150).all()
    last = json.loads(study.runs()[-1].scene)
    run(last, tmp_path / "out", pictures=False)
    single = json.loads((tmp_path / "out/slide.json").read_text())
    row = table.iloc[-1]
    for name in ("run_out_m", "peak_speed_m_s", "released_kg", "bonds_broken", "reached_m2"):
        assert row[name] == single[name]


def test_the_cost_of_a_study_of_slides_is_estimated(study):
    seconds, at_once = study.expected_duration(jobs=1)
    assert 0.0 < seconds < 600.0 and at_once == 1


def test_probabilities_and_percentiles_agree_with_single_slides(study, computed_folder, tmp_path):
    single = []
    for stored in study.runs():
        run(json.loads(stored.scene), tmp_path / stored.hash, pictures=False)
        names = ("pft", "pfv", "ppr")
        single.append(
            [read_raster(tmp_path / stored.hash / f"peaks/{n}.asc").heights for n in names]
        )
    thickness, speed, pressure = np.moveaxis(np.array(single), 1, 0)
    maps = hazard_maps(computed_folder, reached=0.1, pressures=[1.0])
    reached, hit = maps.exceedances
    assert reached.probability == pytest.approx((thickness > 0.1).mean(axis=0))
    assert hit.probability == pytest.approx((pressure > 1.0).mean(axis=0))
    assert hit.probability.max() > 0.0 and (hit.probability < 1.0).any()
    assert maps.percentiles["speed", 95] == pytest.approx(
        np.percentile(speed, 95, axis=0), abs=1e-6
    )
    assert maps.terrain.heights.shape == thickness.shape[1:]


def test_maps_do_not_depend_on_the_bands_of_the_terrain(computed_folder, monkeypatch):
    undivided = hazard_maps(computed_folder)
    monkeypatch.setattr("snowshed.analysis.hazard.maps.BAND_BYTES", 40_000)
    in_bands = hazard_maps(computed_folder)
    for expected, exceedance in zip(undivided.exceedances, in_bands.exceedances):
        assert (exceedance.probability == expected.probability).all()
    assert all(
        (undivided.percentiles[k] == in_bands.percentiles[k]).all() for k in undivided.percentiles
    )


def test_a_study_without_maps_is_refused(study, tmp_path):
    small = Study.product(study.scene.set("events.max_time", 0.1), {"numerics.friction": [0.3]})
    small.compute(tmp_path / "runs", jobs=1, threads=1)
    with pytest.raises(InputError, match=r"kept no maps.*`keep_particles=True`"):
        hazard_maps(tmp_path / "runs")


def test_damaged_maps_are_refused(computed_folder):
    with Store.open(computed_folder) as store:
        (data,) = store.particles(store.runs("slides")[0].hash).values()
    with pytest.raises(InputError, match="not maps that snowshed stored"):
        PeakMaps.unpacked(data[:-40])


def test_the_interval_agrees_with_scipy():
    from scipy.stats import binomtest

    for count, runs in ((0, 50), (7, 50), (25, 50), (50, 50), (1, 3)):
        expected = binomtest(count, runs).proportion_ci(0.95, method="wilson")
        low, high = wilson_interval(count, runs)
        assert (float(low), float(high)) == pytest.approx(tuple(expected), abs=1e-12)
