"""Values that are probably mistakes are told, and answers of a wrong type are refused."""

import numpy as np
import pytest

import snowshed
from snowshed import (
    Body,
    Events,
    Ground,
    InputError,
    MpsSettings,
    Obstacle,
    Scene,
    Shape,
    Simulation,
    Snow,
    SnowshedNote,
    Study,
    UnusualValueNote,
)
from snowshed.analysis.clearance import SnowRanges
from snowshed.base.notes import record_notes
from snowshed.running.ageing.ageing import Ageing, Interval
from snowshed.scene import single_panel, wall
from snowshed.season import SeasonSettings, snow_balance
from snowshed.snow import follow_path
from snowshed.study import Factor, remeasure

DAY = Interval(86400.0, -5.0)


@pytest.fixture
def falling(tiny):
    simulation = Simulation(tiny)
    simulation.begin_event()
    return simulation


@pytest.mark.parametrize(("answer", "given"), [(None, "None"), (np.ones(2), "type ndarray")])
def test_a_condition_that_answers_neither_yes_nor_no_is_refused(falling, answer, given):
    with pytest.raises(InputError, match=f"until: the function returned .*{given}"):
        falling.run(until=lambda simulation: answer)


def test_a_simulation_in_memory_tells_of_a_coarse_slab(tiny):
    with pytest.warns(SnowshedNote, match="its stack is coarse"):
        Simulation(tiny.set("numerics.dx", 0.1))


def test_unusual_values_of_factors_are_told_when_a_study_is_made(tiny):
    axes = {"panel.tilt": [0.87, 0.7, 40], "snow.density": [200, 300], "snow.cohesion": [0.1]}
    with record_notes() as notes:
        Study.product(tiny, axes)
    assert notes == [
        "panel.tilt = 0.7: /panel/tilt: 0.7 degrees is unusual; most values are 3 to 90 degrees, "
        "so check its unit"
    ]
    together = Factor({"panel.tilt": [30, 40], "snow.youngs_modulus": [1e6, 1.0]})
    with record_notes() as notes:
        Study(tiny, [[together], [together, Factor({"panel.friction": [0.2]})]])
    assert len(notes) == 1 and notes[0].startswith("snow.youngs_modulus = 1.0: ")


def test_a_study_of_an_incomplete_scene_or_of_words_has_no_notes(tiny, recwarn):
    Study.product(Scene(dimension=2), {"panel.tilt": [0.7]})
    Study.product(tiny, {"panel.condition": ["slip", "separate"], "panel.tilt": [30, 40]})
    assert [str(warning.message) for warning in recwarn] == []


def test_a_stack_before_the_first_event_is_told(tiny):
    with pytest.warns(SnowshedNote, match="no event has begun"):
        assert Simulation(tiny).measure().mass == 0


def test_unusual_speeds_and_places_in_memory_are_told(falling):
    with pytest.warns(SnowshedNote, match="300 m/s is unusual"):
        falling.add_velocity((300, 0))
    with pytest.warns(SnowshedNote, match="from the present snow"):
        falling.add_snow([[600, 500]])


def test_intervals_longer_than_the_events_are_told(tiny):
    scene = tiny.with_({"output.snapshot_interval": 10, "events.count": 1})
    with pytest.warns(SnowshedNote, match="snapshot_interval: 10 s is longer than any event"):
        results = snowshed.run(scene, pictures=False)
    assert any("snapshot_interval" in note for note in results.run["notes"])


def test_values_and_obstacles_without_effect_are_told(tiny):
    scene = tiny.with_({"ground.friction": 0.8})
    scene.append("obstacles", Obstacle(shape=Shape.box((2, -3), (0.1, 0.1))))
    with record_notes() as notes:
        Simulation(scene)
    for text in ("/ground/friction: 0.8 is not used", "/obstacles/0: it lies below the ground"):
        assert any(text in note for note in notes)


def flowing(**values):
    values = {"spacing": 0.02, **values}
    block = Body(shape=Shape.box((0, 0.1), (0.2, 0.2)))
    return Scene(method="mps", dimension=2, bodies=[block], ground=Ground(),
                 numerics=MpsSettings(**values), events=Events(max_time=0.1))  # fmt: skip


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"erosion_pressure": 100}, "erosion_pressure: 100 is not used, because erosion is false"),
        ({"rheology": "newtonian", "cohesion": 100}, "cohesion: 100 is not used"),
        ({"regularisation": "bi_viscous"}, 'because stress is "elastoplastic"'),
        ({"spacing": 0.15}, "/bodies/0: the box is 200 mm thick, less than two"),
        ({"cohesion": 0.2}, "/numerics/cohesion: 0.2 Pa is unusual"),
        ({"yield_iterations": 1}, "/numerics/yield_iterations: 1 is unusual; most values are 10"),
    ],
)
def test_settings_of_a_fluid_that_cannot_matter_or_be_are_told(values, message):
    with pytest.warns(SnowshedNote, match=message):
        Simulation(flowing(**values))


def test_usual_settings_of_a_fluid_have_no_notes():
    with record_notes() as notes:
        Simulation(flowing(cohesion=100, erosion=True, erosion_pressure=100))
    assert notes == []


@pytest.mark.parametrize(
    ("pauses", "error"),
    [
        ({2: [Interval(86400.0, 268.0)]}, "is it in kelvin"),
        ({1: [DAY]}, "no pause is before event 1; 2 is the first"),
    ],
)
def test_pauses_that_cannot_be_are_refused(pauses, error):
    with pytest.raises(InputError, match=error):
        Ageing(pauses, settling="vionnet-2012")


def test_pauses_that_change_nothing_are_told(tiny, tmp_path):
    with pytest.warns(SnowshedNote, match="is it in hours or days"):
        Ageing({2: [Interval(24.0, -5.0)]}, settling="vionnet-2012")
    with record_notes() as notes:
        snowshed.run(tiny.with_({"events.count": 1}), ageing=Ageing({9: [DAY]}), pictures=False)
    for text in ("no pause is before event 9", "neither settling nor sintering"):
        assert any(text in note for note in notes)


@pytest.mark.parametrize(
    "values", [{"adhesion": 0.03}, {"pool_below": 5.0}, {"melt_factor": 0.004}, {"friction": 5.0}]
)
def test_unusual_settings_of_a_season_are_told(values):
    with pytest.warns(SnowshedNote, match="is unusual; most values are"):
        SeasonSettings(**values)


def test_unusual_ranges_of_a_clearance_are_told():
    with pytest.warns(SnowshedNote, match=r"adhesion: 0 to 0\.15 is unusual; most values are 0\.2"):
        SnowRanges({"adhesion": (0.0, 0.15)})
    with record_notes() as notes:
        SnowRanges()
    assert notes == []


def test_a_structure_behind_the_edge_is_told():
    panel = single_panel(height=1.5, length=3.0, tilt=50.0, snow=0.2, dx=0.05)
    with pytest.warns(SnowshedNote, match="distance: -1 m is behind the edge, where the wall"):
        wall(panel, distance=-1.0, height=1.2)


def test_a_tilt_in_radians_outside_a_scene_is_told():
    with pytest.warns(SnowshedNote, match=r"tilt: 0\.7 degrees is unusual"):
        snow_balance(10.0, 0.7, 0.7, 0.0)


def test_points_of_a_study_that_repeat_are_told(tiny):
    with pytest.warns(SnowshedNote, match=r"panel\.tilt = 40.*: appears twice"):
        Factor({"panel.tilt": [40, 50, 40.0]})
    with pytest.warns(SnowshedNote, match=r"seeding\.seed = 1: appears twice"):
        assert len(Study.product(tiny, {"panel.tilt": [40]}, seeds=[1, 1]).runs()) == 1


def test_factors_that_cannot_be_combined_are_refused(tiny):
    with pytest.raises(InputError, match=r"panel\.tilt: None is no value"):
        Factor({"panel.tilt": [40, None]})
    panel = {"height": 1, "length": 1, "tilt": 10}
    with pytest.raises(InputError, match=r"panel: contains panel\.tilt, which varies"):
        Study.product(tiny, {"panel.tilt": [40], "panel": [panel]})


def test_a_measure_that_returns_nothing_is_refused(tiny, tmp_path):
    study = Study.product(tiny.with_({"events.count": 1}), {"panel.tilt": [50]})
    study.run(tmp_path / "store", jobs=1, keep_particles=True)
    with pytest.raises(InputError, match="measure: the function returned None"):
        remeasure(tmp_path / "store", measure=lambda event: None)


@pytest.mark.parametrize(
    ("path", "question"),
    [
        ({"strain_1": [-2.0], "stress_2": [0.0], "stress_3": [0.0]}, "is it in percent"),
        ({f"stress_{k}": [-5.0] for k in (1, 2, 3)}, "are they in kPa"),
    ],
)
def test_paths_in_another_unit_are_told(path, question):
    with pytest.warns(SnowshedNote, match=question):
        follow_path(Snow.preset("calibrated"), path, steps=5)


@pytest.mark.parametrize(("dimension", "factor"), [(2, 1000), (3, 1)])
def test_masses_that_do_not_fit_their_particles_are_told(dimension, factor):
    x, z = np.meshgrid(np.linspace(0, 1, 51), np.linspace(0, 0.2, 11))
    heap = np.column_stack([x.ravel(), 0 * x.ravel(), z.ravel()])
    mass = np.full(len(heap), 0.07 * factor)
    with pytest.warns(SnowshedNote, match="are the masses in g"):
        snowshed.measure_stack(heap, mass, 0 * mass + 200, dimension=dimension, dx=0.02)


@pytest.mark.parametrize(
    ("shift", "values", "message"),
    [
        (-5.0, {}, "half of the snow lies .* below the ground"),
        (9.0, {}, "the lowest snow is 9 m above the ground"),
        (0.0, {"dx": 10}, "dx: 10 m is more than the whole snow"),
        (0.0, {"ground_tilt_deg": 0.3}, "0.3 degrees is unusual; is it in radians"),
    ],
)
def test_stacks_that_lie_elsewhere_are_told(shift, values, message):
    x, z = np.meshgrid(np.linspace(0, 1, 51), np.linspace(0, 0.2, 11))
    heap = np.column_stack([x.ravel(), 0 * x.ravel(), z.ravel() + shift])
    mass = np.full(len(heap), 0.07)
    with pytest.warns(SnowshedNote, match=message):
        snowshed.measure_stack(heap, mass, 0 * mass + 200, **{"dimension": 2, "dx": 0.02, **values})


def test_an_angle_of_a_shape_in_radians_is_told(tiny):
    turned = Shape.transform(Shape.box([0.6, 0.05], [0.1, 0.1]), angle=0.7)
    scene = tiny.with_({"obstacles": [Obstacle(shape=turned, name="board")]})
    with pytest.warns(UnusualValueNote, match=r"/shape/angle: 0\.7 degrees is unusual"):
        Simulation(scene)


def test_a_width_in_millimetres_is_told(tiny):
    scene = tiny.with_({"dimension": 3, "panel.width": 500})
    with pytest.warns(UnusualValueNote, match=r"/panel/width: 500 m wide beside a panel of .* m"):
        Simulation(scene)


def test_a_factor_without_effect_in_2d_is_told(tiny):
    with pytest.warns(SnowshedNote, match=r"panel\.width: has no effect in 2D"):
        Study.product(tiny, {"panel.width": [0.1, 0.2], "panel.tilt": [40]})
    with record_notes() as notes:
        Study.product(tiny, {"panel.width": [0.1, 0.2], "dimension": [2, 3]})
    assert notes == []
