"""Results that only some methods have, of folders and of simulations in memory."""

import numpy as np
import pytest
from conftest import tiny_scene
from helpers.grain_files import VOXEL, write_labels

import snowshed
from snowshed import InputError, LoadingStage, Simulation
from snowshed.base.missing_result import MissingResultError
from snowshed.methods import LoadingCurve, find_phases
from snowshed.scene import example_slide, grains_scene

xarray = pytest.importorskip("xarray")
pytestmark = pytest.mark.usefixtures("undrawn")


@pytest.fixture
def loading(tmp_path):
    stage = LoadingStage(kind="compress", strain=2e-3, speed=0.05)
    return grains_scene(write_labels(tmp_path), VOXEL, [stage])


def test_attributes_that_do_not_exist_are_missing_to_hasattr_and_getattr(tmp_path):
    results = snowshed.run(tiny_scene(), tmp_path / "out", pictures=False)
    assert hasattr(results, "stack") and hasattr(results, "events")
    for name in ("maps", "curve", "forces", "summary", "energy"):
        assert not hasattr(results, name)
        assert getattr(results, name, None) is None
        with pytest.raises(InputError, match=str(tmp_path)):
            getattr(results, name)
    assert issubclass(MissingResultError, AttributeError)


def test_a_damaged_file_is_not_a_missing_attribute(tmp_path):
    results = snowshed.run(tiny_scene(), tmp_path / "out", pictures=False)
    with (tmp_path / "out" / "events.csv").open("a") as table:
        table.write("x")
    with pytest.raises(InputError):
        hasattr(results, "events")


def test_a_simulation_has_no_results_of_other_methods():
    simulation = Simulation(tiny_scene())
    for name in ("maps", "curve"):
        assert not hasattr(simulation, name)
    with pytest.raises(InputError, match='the method "mpm" has no maps'):
        _ = simulation.maps


def test_maps_of_a_simulation_are_those_of_its_run(tmp_path):
    scene = example_slide(tmp_path).set("events.max_time", 0.3)
    results = snowshed.run(scene, tmp_path / "out", pictures=False)
    simulation = Simulation(scene)
    simulation.run()
    maps = simulation.maps
    xarray.testing.assert_allclose(maps, results.maps, atol=1e-3)
    assert maps.attrs == results.maps.attrs
    assert maps["peak_speed"].attrs["units"] == "m/s"
    assert maps["peak_speed"].max() > 0.0


def test_particles_of_a_slide_are_read_with_their_time(tmp_path):
    scene = example_slide(tmp_path).set("events.max_time", 0.05)
    particles = snowshed.run(scene, tmp_path / "out", pictures=False).particles()
    assert float(particles["time"]) == pytest.approx(0.05)
    assert "thickness" in particles


def test_the_curve_and_the_forces_of_a_simulation_are_those_of_its_run(loading, tmp_path):
    results = snowshed.run(loading, tmp_path / "out", pictures=False)
    simulation = Simulation(loading)
    simulation.begin_event()
    assert len(simulation.curve) == 1
    simulation.run()
    for name in ("curve", "forces"):
        live, stored = getattr(simulation, name), getattr(results, name)
        assert list(live.columns) == list(stored.columns)
        assert live.attrs == stored.attrs
        np.testing.assert_allclose(live.to_numpy(float), stored.to_numpy(float), rtol=1e-12)
    curves = [LoadingCurve.from_table(table) for table in (simulation.curve, results.curve)]
    assert find_phases(curves[0]) == find_phases(curves[1])
