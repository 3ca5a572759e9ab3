"""A simulation in memory, event by event and step by step."""

import numpy as np
import pytest

from snowshed import InputError, Simulation, SnowshedNote


@pytest.fixture
def falling(tiny):
    """The snow of the first event, half of it off the panel."""
    simulation = Simulation(tiny)
    simulation.begin_event()
    simulation.run(until=0.2)
    return simulation


def test_iteration_runs_the_remaining_events(tiny):
    simulation = Simulation(tiny.with_({"events.count": 2}))
    ends = list(simulation)
    assert [end.event for end in ends] == [1, 2] and simulation.events_left == 0
    assert all(end.ended in ("rest", "time_limit") and end.time > 0 for end in ends)
    with pytest.warns(SnowshedNote, match="all 2 events have ended, and none ran"):
        assert list(simulation) == []


def test_times_that_have_passed_or_lie_beyond_the_limit_are_told(tiny):
    simulation = Simulation(tiny)
    assert simulation.run(until=0.05) == "reached"
    steps = simulation.steps
    with pytest.warns(SnowshedNote, match=r"until: 0\.05 s has passed, because event 1 is at"):
        assert simulation.run(until=0.05) == "reached"
    assert simulation.steps == steps
    with pytest.warns(SnowshedNote, match=r"until: 1\.2 s is beyond .* events\.max_time = 1 s"):
        simulation.run(until=1.2)
    assert simulation.time >= 1.2


def test_a_function_is_called_after_each_step_and_changes_nothing_by_itself(tiny):
    plain, watched = Simulation(tiny), Simulation(tiny)
    steps = []
    assert plain.run() == watched.run(on_step=lambda s: steps.append(s.steps))
    assert steps == list(range(1, plain.steps + 1))
    assert np.array_equal(plain.positions(), watched.positions())
    assert not watched.event_running


@pytest.mark.parametrize("name", ["run", "step", "begin_event"])
@pytest.mark.parametrize("argument", ["until", "on_step"])
def test_functions_that_a_run_calls_take_no_steps(tiny, name, argument):
    simulation, plain = Simulation(tiny), Simulation(tiny)
    with pytest.raises(InputError, match=rf"^{name}: called from a function that `run` calls"):
        simulation.run(**{argument: lambda s: getattr(s, name)()})
    plain.begin_event()
    plain.step(simulation.steps)
    assert np.array_equal(simulation.positions(), plain.positions())
    simulation.run(until=0.05)  # the refused call left no lock


def test_attributes_cannot_be_set(tiny):
    simulation = Simulation(tiny)
    with pytest.raises(AttributeError, match=r"Simulation\.tiem: .*; did you mean time\?"):
        simulation.tiem = 3
    for name in ("time", "measure"):
        with pytest.raises(InputError, match=rf"Simulation\.{name}: it is read"):
            setattr(simulation, name, 3)

    class Own(Simulation):
        pass

    own = Own(tiny)
    own.label = "mine"
    assert own.label == "mine"


@pytest.mark.parametrize("until", [0.01, lambda s: s.time >= 0.01])
def test_a_function_is_called_after_each_step_until_a_condition_holds(tiny, until):
    simulation, times = Simulation(tiny), []
    assert simulation.run(until, every=1, on_step=lambda s: times.append(s.time)) == "reached"
    assert times[-1] >= 0.01 and len(times) == simulation.steps


def test_rest_is_seen_while_a_condition_is_awaited(tiny):
    flat = tiny.with_({"panel.tilt": 0, "events": {"rest_time": 0.02, "max_time": 5}})
    simulation = Simulation(flat)
    assert not simulation.at_rest
    assert simulation.run(lambda s: s.at_rest) == "reached"
    assert simulation.at_rest and simulation.event_running
    reference = Simulation(flat)
    assert reference.run() == "rest" and reference.time == pytest.approx(simulation.time, abs=0.02)


def test_particles_are_a_table_with_a_row_each(falling):
    table = falling.to_dataframe()
    assert len(table) == falling.particle_count
    assert np.array_equal(table[["velocity_x", "velocity_y", "velocity_z"]], falling.velocities())
    assert table.attrs["units"]["density"] == "kg/m3" and table.attrs["snowshed_version"]


def test_notes_on_the_scene_are_issued_when_the_simulation_is_made(tiny):
    with pytest.warns(SnowshedNote, match="/panel/tilt: 0.87 degrees is unusual"):
        Simulation(tiny.with_({"panel.tilt": 0.87}))
