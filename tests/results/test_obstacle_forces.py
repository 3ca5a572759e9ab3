"""Forces of a run: datasets with units, the same files by both programs, damage."""

import numpy as np
import pytest
from conftest import tiny_scene
from helpers.interrupted_runs import interrupt_at
from helpers.processes import snowshed_run

from snowshed import InputError, Interrupted, Results, Simulation, run_events
from snowshed.results.obstacle_forces import read_pressures
from snowshed.running import sequence

FILES = ("forces.csv", "loads.csv", "pressures/event_002.vtp")


def scene_with_forces(**values):
    return tiny_scene(**{"output.forces": True, **values})


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("forces") / "run"
    run_events(scene_with_forces(), folder, pictures=False)
    return folder


def test_the_dataset_sums_up_to_the_impulses(run_folder):
    results = Results(run_folder)
    forces, loads = results.forces, results.loads
    assert forces.force.dims == ("time", "obstacle", "component")
    assert forces.force.attrs["units"] == "N" and loads.attrs["units"]["impulse_z_ns"] == "N s"
    assert forces.obstacle.values.tolist() == ["ground", "panel", "unbalanced"]
    impulse = (forces.force * forces.duration).where(forces.event == 2, 0).sum("time")
    of_event = loads[loads.event == 2].set_index("obstacle")
    for name in ("ground", "panel"):
        expected = of_event.impulse_z_ns[name]
        assert float(impulse.sel(obstacle=name, component="z")) == pytest.approx(expected, rel=1e-6)


def test_the_stack_at_rest_weighs_on_the_ground(run_folder):
    results = Results(run_folder)
    last = results.loads[results.loads.event == 2]
    weight = 9.81 * float(results.particles().mass.sum())
    assert last.at_rest.all() and -last.rest_fz_n.sum() == pytest.approx(weight, rel=1e-3)


def test_pressures_at_rest_carry_the_normal_force(run_folder):
    results = Results(run_folder)
    faces = results.pressures
    assert faces["corners"].shape == (len(faces["area"]), 2, 3)  # lines, in 2D
    for name in ("ground", "panel"):
        of_name = faces["obstacle"] == name
        normal = float((faces["rest_pressure"] * faces["area"])[of_name].sum())
        last = results.loads[(results.loads.event == 2) & (results.loads.obstacle == name)]
        assert normal == pytest.approx(float(last.rest_normal_n.iloc[0]), rel=1e-3, abs=1e-3)
    heights = faces["corners"][..., 2]
    assert np.allclose(heights[faces["obstacle"] == "ground"], 0.0, atol=1e-3)
    assert (heights[faces["obstacle"] == "panel"] > 0.1).all()
    assert (faces["peak_pressure"] >= 0).all() and faces["peak_pressure"].max() > 0
    assert len(read_pressures(run_folder, 1)["area"]) <= len(faces["area"])


def test_snowshed_run_writes_the_same_files(run_folder, tmp_path):
    scene = tmp_path / "scene.json"
    scene_with_forces().resolve().save(scene)
    done = snowshed_run(scene, "-o", tmp_path / "run", "-q")
    assert done.returncode == 0, done.stderr
    for name in FILES:
        assert (tmp_path / "run" / name).read_bytes() == (run_folder / name).read_bytes(), name


@pytest.mark.parametrize(("event", "moment"), [(1, 0.1), (2, 0.2)])
def test_a_resumed_run_has_the_same_files(run_folder, tmp_path, monkeypatch, event, moment):
    monkeypatch.setattr(sequence, "REPORT_INTERVAL", 0.0)
    with pytest.raises(Interrupted):
        run_events(
            scene_with_forces(), tmp_path, progress=interrupt_at(event, moment), pictures=False
        )
    run_events(scene_with_forces(), tmp_path, resume=True, pictures=False)
    for name in FILES:
        assert (tmp_path / name).read_bytes() == (run_folder / name).read_bytes(), name


def test_forces_now_are_those_on_the_snow(tmp_path):
    simulation = Simulation(scene_with_forces(**{"panel.tilt": 20.0, "numerics.sleep_speed": 0.0}))
    simulation.begin_event()
    while simulation.time < 0.4:
        simulation.step(50)
    now = simulation.forces
    weight = 9.81 * float(simulation.masses().sum())
    assert now.force.attrs["units"] == "N"
    assert -float(now.force.sel(component="z").sum()) == pytest.approx(weight, rel=0.05)
    impulse = -float(now.impulse.sel(component="z").sum())
    momentum = float(simulation.masses() @ simulation.velocities()[:, 2])
    assert impulse == pytest.approx(weight * simulation.time + momentum, rel=0.01)


def test_runs_without_forces_have_none(tmp_path):
    simulation = Simulation(tiny_scene())
    with pytest.raises(InputError, match="/output/forces: false"):
        _ = simulation.forces
    run_events(tiny_scene(**{"events.count": 1}), tmp_path, pictures=False)
    assert not hasattr(Results(tmp_path), "forces")
    with pytest.raises(InputError, match=r"output\.forces = true writes"):
        _ = Results(tmp_path).loads


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("forces.csv", lambda text: text.replace("panel", "pane1", 1), "damaged"),
        ("loads.csv", lambda text: text + "3,ground,1\n", "damaged|cells|columns"),
    ],
)
def test_changed_tables_are_refused(run_folder, tmp_path, name, change, message):
    import shutil

    copy = tmp_path / "copy"
    shutil.copytree(run_folder, copy)
    (copy / name).write_text(change((copy / name).read_text()))
    with pytest.raises(InputError, match=message):
        _ = Results(copy).forces if name == "forces.csv" else Results(copy).loads


def test_methods_without_obstacles_refuse_forces():
    from snowshed import Scene

    with pytest.raises(InputError, match="records no forces on obstacles"):
        Scene.from_data({"method": "grains", "sample": {"file": "a.npy", "voxel_size": 1e-5},
                         "output": {"forces": True}}).resolve()  # fmt: skip


def test_names_that_spreadsheets_compute_are_quoted(tmp_path):
    from snowshed.scene import Obstacle, Shape

    scene = scene_with_forces(**{"events.count": 1, "events.max_time": 0.1})
    box = Shape.box((0.5, 0.1), (0.1, 0.2))
    scene.append("obstacles", Obstacle(name='=SUM("a",b)', shape=box))
    run_events(scene, tmp_path, pictures=False)
    assert set(Results(tmp_path).loads.obstacle) == {"ground", "panel", '\'=SUM("a",b)'}
    assert np.isfinite(Results(tmp_path).loads.peak_1ms_n).all()
