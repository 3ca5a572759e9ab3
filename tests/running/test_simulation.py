"""A simulation in memory: its fields, changes and misuse."""

import gc
import json
import threading

import numpy as np
import pytest

from snowshed import InputError, Scene, Simulation, SimulationError, Snow, _core, measure_stack

ARRAYS = (
    "positions",
    "velocities",
    "masses",
    "densities",
    "pressures",
    "plastic_strains",
    "ids",
    "events",
    "material_ids",
    "on_panel",
)


@pytest.fixture
def falling(tiny):
    """The snow of the first event, half of it off the panel, sorted several times."""
    simulation = Simulation(tiny)
    simulation.begin_event()
    simulation.run(until=0.2)
    return simulation


def random_scene(dimension, precision, model="cam_clay"):
    scene = Scene.preset("lab-50").update({"dimension": dimension, "numerics.dx": 0.02})
    scene.update({"numerics.precision": precision, "snow.model": model})
    return scene.update({"numerics.transfer": "apic", "numerics.threads": 2})


# --- fields --------------------------------------------------------------------------------


def test_views_show_the_changes_of_a_step(falling):
    view = falling.fields["velocity_z"].values
    before = view.copy()
    at_start = falling._core.sorts
    falling.step()
    if falling._core.sorts == at_start:
        assert not np.array_equal(view, before)
    assert not np.array_equal(falling.fields["velocity_z"].values, before)


def test_stored_fields_are_views(falling):
    first, second = (falling.fields["mass"].values for _ in range(2))
    assert np.shares_memory(first, second)
    assert falling.fields["mass"].stored and not falling.fields["density"].stored


def test_views_outlive_their_simulation(falling):
    """A view keeps its memory when particles are sorted or added, or the simulation is deleted."""
    views = {name: field.values for name, field in falling.fields.items()}
    falling.run(until=falling.time + 0.1)
    falling.add_snow(np.random.default_rng(1).uniform(0, 0.3, (5000, 2)) + [0, 0.5])
    copies = {name: view.copy() for name, view in views.items()}
    del falling
    gc.collect()
    clutter = [np.full(len(views["mass"]), 7.0, dtype=np.float32) for _ in range(200)]
    for name, view in views.items():
        assert np.array_equal(view, copies[name]), name
    del clutter


def test_views_cannot_be_written_to(falling):
    for field in falling.fields.values():
        with pytest.raises(ValueError, match="read-only"):
            field.values[0] = 1
        with pytest.raises(ValueError, match="WRITEABLE"):
            field.values.flags.writeable = True


@pytest.mark.parametrize("precision", ["float", "double"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_fields_have_type_shape_and_unit(dimension, precision):
    simulation = Simulation(random_scene(dimension, precision))
    simulation.begin_event()
    n = simulation.particle_count
    own = np.float32 if precision == "float" else np.float64
    for name, field in simulation.fields.items():
        size = {"position": (3,), "velocity": (3,), "affine": (3, 3)}.get(name, ())
        assert field.values.shape == (n, *size), name
        assert field.values.dtype == field.dtype, name
        integers = {"id": np.uint32, "event": np.uint16, "material_id": np.uint8}
        assert field.dtype == integers.get(name, own if field.stored else np.float64), name
        assert field.unit and field.description
    with pytest.raises(KeyError, match="no field 'masss'; allowed: position, "):
        simulation.fields["masss"]


@pytest.mark.parametrize("model", ["cam_clay", "elastic"])
@pytest.mark.parametrize("precision", ["float", "double"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_order_by_id_has_the_stored_bits(dimension, precision, model):
    simulation = Simulation(random_scene(dimension, precision, model))
    simulation.begin_event()
    simulation.step(150)
    ids = simulation.fields["id"].values
    assert not np.array_equal(ids, np.sort(ids))  # sorted by blocks, not by id
    order = np.argsort(ids)
    for name, field in simulation.fields.items():
        by_id = field.by_id()
        assert by_id.dtype in (np.float64, np.int64)
        assert np.array_equal(by_id, field.values[order]), name


def test_components_are_columns_of_the_vector(falling):
    fields = falling.fields
    assert np.array_equal(fields["velocity"].values[:, 0], fields["velocity_x"].values)
    assert np.array_equal(fields["velocity"].values[:, 2], fields["velocity_z"].values)
    assert not fields["velocity"].values[:, 1].any()


@pytest.mark.parametrize("dimension", [2, 3])
def test_components_have_the_same_names_in_fields_tables_and_grids(dimension):
    simulation = Simulation(random_scene(dimension, "double").set("numerics.dx", 0.04))
    simulation.begin_event()
    table = simulation.to_dataframe()
    for vector in ("position", "velocity"):
        names = [f"{vector}_{axis}" for axis in "xyz"]
        assert [name for name in table if name.startswith(vector)] == names
        for name in names:
            assert np.array_equal(simulation.fields[name].by_id(), table[name])
            assert simulation.fields[name].unit == table.attrs["units"][name]
            assert not simulation.fields[name].values.flags.writeable
    pytest.importorskip("xarray")
    for dataset in (simulation.to_xarray(), simulation.grid()):
        assert dataset.component.values.tolist() == ["x", "y", "z"]


def test_density_and_pressure_follow_from_stored_fields(falling):
    """p = -K ln J_e and rho = rho_0 / (J_e J_p) relative to the initial plastic strain."""
    fields, snow = falling.fields, falling.snows[0]
    b = {axes: fields[f"be_minus_identity_{axes}"].by_id() for axes in ("xx", "zz", "xz")}
    elastic = 0.5 * np.log((1 + b["xx"]) * (1 + b["zz"]) - b["xz"] ** 2)
    law = _core.CamClay(
        snow.youngs_modulus,
        snow.poissons_ratio,
        snow.critical_state_slope,
        snow.cohesion,
        snow.hardening_factor,
        2,
    )
    plastic = falling.plastic_strains() - law.initial_plastic_strain(snow.preconsolidation_pressure)
    assert falling.pressures() == pytest.approx(-law.bulk * elastic, rel=1e-3, abs=1)
    assert falling.densities() == pytest.approx(snow.density * np.exp(-elastic - plastic), rel=1e-5)


@pytest.mark.parametrize("name", ARRAYS)
def test_methods_return_either_order(falling, name):
    assert 0 < falling.on_panel().mean() < 1
    by_id, stored = getattr(falling, name)(), getattr(falling, name)(order="storage")
    assert np.array_equal(by_id[falling.ids("storage")], stored)
    with pytest.raises(InputError, match='"id", "storage"'):
        getattr(falling, name)(order="size")


# --- running -------------------------------------------------------------------------------


def test_run_to_rest_ends_the_event(tiny):
    simulation = Simulation(tiny)
    simulation.begin_event()
    assert simulation.run() in ("rest", "time_limit")
    assert not simulation.event_running
    with pytest.raises(SimulationError, match="begin_event first"):
        simulation.step()


def test_run_until_a_time_stops_at_the_step_that_reaches_it(falling):
    end = falling.time + 0.0505
    assert falling.run(until=end) == "reached"
    assert end <= falling.time < end + falling.time_step
    steps = falling.steps
    assert falling.run(until=end) == "reached" and falling.steps == steps


def test_run_until_a_condition_holds(falling):
    steps = []

    def sinks(simulation):
        steps.append(simulation.steps)
        return len(steps) == 4

    assert falling.run(until=sinks, every=5) == "reached"
    assert np.diff(steps).tolist() == [5, 5, 5]
    assert falling.run(until=lambda simulation: False) == "time_limit"
    assert falling.time == pytest.approx(1.0, abs=0.01)


def test_the_core_and_the_class_step_to_the_same_bits(tiny):
    resolved = tiny.resolve()
    core = _core.Simulation(resolved.json, resolved.base_dir)
    core.begin_event()
    core.step(200)
    for scene in (tiny, resolved, json.loads(resolved.json)):
        simulation = Simulation(scene)
        simulation.begin_event()
        simulation.step(200)
        assert np.array_equal(simulation.positions(), core.positions())


def test_a_saved_simulation_continues_to_the_same_bits(tiny, tmp_path):
    simulation = Simulation(tiny)
    simulation.begin_event()
    simulation.run()
    simulation.save(tmp_path / "checkpoint.bin")
    loaded = Simulation.load(tmp_path / "checkpoint.bin")
    for each in (simulation, loaded):
        each.begin_event()
        each.run(until=0.2)
    assert np.array_equal(simulation.positions(), loaded.positions())
    assert loaded.event == 2


# --- changing ------------------------------------------------------------------------------


def test_added_snow_has_the_mass_and_velocity_given(falling):
    n, mass = falling.particle_count, falling.masses().sum()
    falling.add_snow([[0.4, 0.6], [0.41, 0.6]], mass=0.25, velocity=(1, -2))
    assert falling.masses().sum() == pytest.approx(mass + 0.5)
    assert falling.positions()[n:] == pytest.approx(np.array([[0.4, 0, 0.6], [0.41, 0, 0.6]]))
    assert (falling.velocities()[n:] == [1, 0, -2]).all()
    assert (falling.events()[n:] == 1).all()
    assert falling.densities()[n:] == pytest.approx(falling.snows[0].density)


def test_added_snow_has_the_mass_of_seeded_snow(tiny):
    simulation = Simulation(tiny)
    simulation.begin_event()
    seeded = simulation.masses().mean()
    simulation.add_snow([[0.4, 0.6]])
    assert simulation.masses()[-1] == pytest.approx(seeded, rel=0.1)


def test_added_snow_falls(tiny):
    """In free fall from rest; the time counts by the steps, velocities lag half a step."""
    simulation = Simulation(tiny.set("numerics.precision", "double"))
    simulation.begin_event()
    x, z = np.meshgrid(np.arange(0, 0.1, 0.01), np.arange(0, 0.1, 0.01))
    block = np.column_stack([x.ravel() + 1, z.ravel() + 3])
    n = simulation.particle_count
    simulation.add_snow(block)
    simulation.run(until=0.1)
    assert simulation.velocities()[n:, 2].mean() == pytest.approx(-9.81 * simulation.time)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"positions": [0.4, 0.6]}, r"positions: an array of shape \(2,\); needed: \(n, 3\)"),
        ({"positions": [[0.4, np.nan]]}, r"positions: nan at index \(0, 1\)"),
        ({"positions": [["a", "b"]]}, "positions: not an array of numbers"),
        ({"mass": 0}, "mass: 0; it must be above 0"),
        ({"mass": np.inf}, "mass: inf; a finite number"),
        ({"velocity": (1, 2, 3, 4)}, r"velocity: an array of shape \(1, 4\)"),
        ({"material_id": 1}, "material_id: 1; the scene's snows are 0 to 0"),
        ({"material_id": "snow"}, "material_id: 'snow'; needed: a whole number"),
    ],
)
def test_snow_that_cannot_be_added_changes_nothing(falling, given, message):
    before = falling.positions()
    with pytest.raises(InputError, match=message):
        falling.add_snow(**{"positions": [[0.4, 0.6]], **given})
    assert np.array_equal(falling.positions(), before)


def test_velocities_are_added_to_each_or_to_all(falling):
    before = falling.velocities()
    changes = np.random.default_rng(2).normal(size=(len(before), 2)).astype(np.float32)
    falling.add_velocity(changes)
    assert falling.velocities()[:, [0, 2]] == pytest.approx(before[:, [0, 2]] + changes, abs=1e-5)
    falling.add_velocity((1, 0, 0))
    assert falling.velocities()[:, 0] == pytest.approx(before[:, 0] + changes[:, 0] + 1, abs=1e-5)
    with pytest.raises(InputError, match=rf"changes: .* needed: \({len(before)}, 3\)"):
        falling.add_velocity(changes[:-1])


# --- results -------------------------------------------------------------------------------


def test_the_dataset_has_units_and_ids(falling):
    xarray = pytest.importorskip("xarray")
    dataset = falling.to_xarray()
    assert isinstance(dataset, xarray.Dataset)
    assert dataset["position"].dims == ("particle", "component")
    assert dataset["position"].attrs["units"] == "m"
    assert np.array_equal(dataset["particle"], falling.ids())
    assert np.array_equal(dataset["velocity"].sel(component="z"), falling.velocities()[:, 2])
    assert float(dataset["time"]) == falling.time


def test_the_measure_uses_the_particles(falling):
    falling.run()
    expected = measure_stack(
        falling.positions(),
        falling.masses(),
        falling.densities(),
        dimension=2,
        dx=0.02,
        exclude=falling.on_panel(),
    )
    assert falling.measure().height == expected.height > 0
    assert falling.measure().on_panel_mass == expected.on_panel_mass


def test_energy_without_a_balance_is_refused(tiny, falling):
    with pytest.raises(InputError, match="/output/energy: false"):
        falling.energy()
    simulation = Simulation(tiny.set("output.energy", True))
    simulation.begin_event()
    simulation.step(20)
    mass, z = simulation.masses(), simulation.positions()[:, 2]
    assert simulation.energy()["gravitational"] == pytest.approx(9.81 * (mass * z).sum())


def test_snows_come_from_the_scene(falling):
    assert isinstance(falling.snows[0], Snow)
    assert falling.snows[0].density == falling.scene.data["snow"]["density"]


# --- misuse --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("misuse", "message"),
    [
        (lambda s: s.step(-1), "count: -1; an integer from 0"),
        (lambda s: s.step(1.5), "count: 1.5; needed: a whole number"),
        (lambda s: s.run(until="sleep"), "until: 'sleep'; allowed: \"rest\""),
        (lambda s: s.run(until=np.nan), "until: nan; a finite number"),
        (lambda s: s.run(until=lambda s: True, every=0), "every: 0; an integer from 1"),
        (
            lambda s: Simulation(3),
            "scene: 3; needed: Scene or ResolvedScene or a dict or a text or a path",
        ),
        (lambda s: Simulation({"panle": {}}), "/panle: unknown key"),
    ],
)
def test_misuse_is_an_error(falling, misuse, message):
    before = falling.positions()
    with pytest.raises(InputError, match=message):
        misuse(falling)
    assert np.array_equal(falling.positions(), before)


def test_a_second_thread_is_refused_while_the_first_computes(tiny):
    simulation = Simulation(tiny)
    simulation.begin_event()
    inside, done = threading.Event(), threading.Event()

    def wait(report):
        inside.set()
        done.wait()
        return True

    first = threading.Thread(target=lambda: simulation._core.run(wait, 0.0))
    first.start()
    inside.wait()
    calls = (simulation.positions, simulation.step, lambda: simulation.time, simulation.begin_event)
    try:
        for call in calls:
            with pytest.raises(RuntimeError, match=r"another thread is using .* \(run\)"):
                call()
    finally:
        done.set()
        first.join()
    assert not simulation.event_running
    simulation.begin_event()


def test_threads_that_race_for_a_simulation_all_end(tiny):
    """Each of many simultaneous calls succeeds or is refused, and positions stay finite."""
    simulation = Simulation(tiny)
    simulation.begin_event()
    refused, errors = [], []

    def use(call):
        for _ in range(100):
            try:
                call()
            except RuntimeError as error:
                refused.append(str(error))
            except Exception as error:
                errors.append(error)

    calls = (lambda: simulation.step(20), simulation.positions, lambda: simulation.step(7))
    threads = [threading.Thread(target=use, args=[call]) for call in calls]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors
    assert np.isfinite(simulation.positions()).all()


def test_within_run_the_simulation_can_be_read_but_not_changed(tiny):
    resolved = tiny.resolve()
    core = _core.Simulation(resolved.json, resolved.base_dir)
    core.begin_event()

    def observe(report):
        assert core.time_s == report["time_s"]
        core.step()

    with pytest.raises(RuntimeError, match="step: called from within run, whose callback may read"):
        core.run(observe, 0.0)
    core.step()  # the refused call left no lock
