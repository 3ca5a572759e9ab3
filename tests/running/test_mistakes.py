"""Mistakes that were silent once: each is an error or a note now."""

import ctypes
import re
from pathlib import Path

import click
import numpy as np
import pandas as pd
import pytest
from helpers.interrupted_runs import interrupt_at

import snowshed
from snowshed import InputError, Scene, Simulation, SimulationError, SnowshedNote, Study
from snowshed.analysis.calibration import read_simulated_stacks
from snowshed.analysis.calibration.measurements import Measurement
from snowshed.analysis.clearance.panel_design import check_base
from snowshed.base.notes import record_notes
from snowshed.cli import main
from snowshed.cli.deferred import Deferred
from snowshed.running import LAW_PROTOTYPES, Laws, extend_run, sequence
from snowshed.scene import grains_scene, slide_scene
from snowshed.season import SeasonSettings
from snowshed.study import read_table


@pytest.fixture
def falling(tiny):
    """The snow of the first event, in motion."""
    simulation = Simulation(tiny)
    simulation.begin_event()
    return simulation


always = LAW_PROTOTYPES["friction"](lambda speed, stress: 0.3)


def terrain(**attributes):
    xarray = pytest.importorskip("xarray")
    heights = np.repeat([np.linspace(60.0, 0.0, 41)], 21, axis=0)
    axes = {"y": 5.0 * np.arange(21), "x": 5.0 * np.arange(41)}
    return xarray.DataArray(heights, axes, ("y", "x"), attrs=attributes)


def polygon():
    return pytest.importorskip("shapely.geometry").box(20, 30, 60, 70)


@pytest.mark.parametrize(
    ("base", "message"),
    [
        ({"panel.height": 3.0}, "panel.height: the search sets it"),
        ({"panel.tilt": 20}, "`tilt=` sets it"),
        ({"numerics": {"dx": 0.2}}, r"give dotted paths, such as numerics\.dx"),
    ],
)
def test_a_clearance_refuses_what_it_varies_itself(base, message):
    with pytest.raises(InputError, match=message):
        check_base(base)


def test_a_record_of_a_run_with_laws_needs_them_again(tiny, tmp_path):
    laws = Laws("rough", friction={"panel": always})
    with pytest.warns(SnowshedNote):
        snowshed.run(tiny.with_({"events.count": 1}), tmp_path / "out", laws=laws, pictures=False)
    with pytest.raises(InputError, match="made with the laws 'rough'; give them"):
        snowshed.run(tmp_path / "out/run.json")


def test_a_law_with_another_result_is_refused():
    single = ctypes.CFUNCTYPE(ctypes.c_float, ctypes.c_double, ctypes.c_double)
    with pytest.raises(InputError, match="has other arguments"):
        Laws("single", friction={"panel": single(lambda speed, stress: 0.1)})


@pytest.mark.parametrize("value", [float("nan"), -0.5])
def test_a_coefficient_that_is_none_ends_the_run(tiny, value):
    law = LAW_PROTOTYPES["friction"](lambda speed, stress: value)
    with pytest.warns(SnowshedNote):
        simulation = Simulation(tiny, laws=Laws("wrong", friction={"panel": law}))
    with pytest.raises(SimulationError, match="no longer finite"):
        simulation.run()


def test_the_friction_of_a_sticky_obstacle_is_noted(tiny):
    laws = Laws("sticky", friction={"ground": always})
    with pytest.warns(SnowshedNote, match='friction of "ground" is not used'):
        Simulation(tiny, laws=laws)


def test_the_limits_of_a_slide_are_notes(tmp_path):
    with pytest.warns(SnowshedNote, match="still moving at the time limit"):
        results = snowshed.slide(terrain(), polygon(), tmp_path / "out", thickness=0.5,
                                 max_time=1, pictures=False)  # fmt: skip
    assert any("time limit" in note for note in results.run["notes"])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda a: a.assign_attrs(units="ft"), "its units are 'ft'"),
        (lambda a: a.drop_vars(["x", "y"]), "has no coordinates y"),
        (lambda a: a.values, "a value of type ndarray"),
    ],
)
def test_terrain_of_unknown_scale_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        slide_scene(change(terrain()), polygon(), thickness=0.5)


def test_measured_stacks_in_centimetres_or_percent_are_noted():
    with pytest.warns(SnowshedNote, match="is it in centimetres"):
        Measurement(50, 1, 1, "height", 4.2, 0.3)
    with pytest.warns(SnowshedNote, match="larger than the value"):
        Measurement(50, 1, 1, "height", 0.05, 5.0)
    with pytest.raises(InputError, match="a positive uncertainty"):
        Measurement(50, 1, 1, "height", 0.05, 0.0)
    with pytest.warns(SnowshedNote, match="is it in radians"):
        Measurement(0.87, 1, 1, "height", 0.05, 0.002)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ((-50, 1, 1, "height", 0.05), "tilt: -50 is outside the allowed range"),
        (("50", 1, 1, "height", 0.05), "tilt: '50'; needed: a number"),
        ((50, 0, 1, "height", 0.05), "event: 0 is not a whole number from 1"),  # STEP 0
        ((50, 1, 0, "height", 0.05), "round: 0 is not a whole number from 1"),
        ((50, 1, 1, "heigth", 0.05), "quantity: 'heigth'; allowed: height, length"),
        ((50, 1, 1, "height", -0.05), "-0.05 m is not positive"),
    ],
)
def test_a_measurement_that_cannot_be_is_refused_where_it_is_made(given, message):
    with pytest.raises(InputError, match=re.escape(message)):
        Measurement(*given, 0.002)


def test_a_saved_scene_says_that_its_arrays_end_with_the_process(tmp_path):
    scene = slide_scene(terrain(), polygon(), thickness=0.5).resolve()
    with pytest.warns(SnowshedNote, match="made from arrays in memory"):
        scene.save(tmp_path / "scene.json")


def test_velocities_along_y_are_refused_in_2d(tiny):
    simulation = Simulation(tiny)
    simulation.begin_event()
    with pytest.raises(InputError, match="y is not zero in 2D"):
        simulation.add_velocity((0, -1, 0))


def test_a_truth_value_is_no_time(tiny):
    simulation = Simulation(tiny)
    with pytest.raises(InputError, match="until: False"):
        simulation.run(until=simulation.at_rest)


def test_snow_added_outside_an_event_or_far_too_heavy_is_noted(tiny):
    simulation = Simulation(tiny)
    with pytest.warns(SnowshedNote, match="no event is running"):
        simulation.add_snow([[0.6, 0.5]])
    with pytest.warns(SnowshedNote, match="is it that of all particles"):
        simulation.add_snow([[0.6, 0.8]], mass=2.0)


def test_nothing_is_saved_before_the_first_event(tiny, tmp_path):
    with pytest.raises(SimulationError, match="no event has begun"):
        Simulation(tiny).save(tmp_path / "checkpoint.bin")


def test_methods_without_a_stack_say_so():
    scene = slide_scene(terrain(), polygon(), thickness=0.5)
    with pytest.raises(InputError, match='the snow of "slide" makes no stack'):
        Simulation(scene).measure()


@pytest.mark.parametrize("argument", ["ageing", "laws", "progress"])
def test_arguments_of_a_wrong_type_are_refused_before_the_run(tiny, tmp_path, argument):
    with pytest.raises(InputError, match=f"{argument}: "):
        snowshed.run(tiny, tmp_path / "out", **{argument: {"a": 1}})
    assert not (tmp_path / "out").exists()


def test_a_thickness_that_is_missing_names_its_argument():
    with pytest.raises(InputError, match=r"give one .`entrained_thickness=`"):
        slide_scene(terrain(), polygon(), thickness=0.5, entrainment=polygon())


def test_a_slide_without_a_folder_is_removed_with_its_results():
    with pytest.warns(SnowshedNote):
        results = snowshed.slide(terrain(), polygon(), thickness=0.5, max_time=1, pictures=False)
    folder = results.folder
    assert folder.is_dir()
    del results
    assert not folder.exists()


def test_unusual_speeds_of_rest_are_noted():
    scene = Scene.preset("lab-50").with_({"dimension": 2, "events.rest_speed": 20})
    with pytest.warns(SnowshedNote, match="/events/rest_speed: 20 m/s is unusual"):
        Simulation(scene)


def test_a_release_smaller_than_a_cell_is_noted():
    tiny_area = pytest.importorskip("shapely.geometry").box(20, 30, 21, 31)
    with pytest.warns(SnowshedNote, match="smaller than a cell of the terrain"):
        slide_scene(terrain(), tiny_area, thickness=0.5)


def test_impossible_speeds_are_refused(tiny):
    simulation = Simulation(tiny)
    simulation.begin_event()
    with pytest.raises(InputError, match="changes: faster than 10000 m/s"):
        simulation.add_velocity((0, 1e9))
    with pytest.raises(InputError, match="velocity: faster than 10000 m/s"):
        simulation.add_snow([[0.6, 0.5]], velocity=(0, 1e9))


def test_a_study_that_replaces_another_says_so(tiny, tmp_path):
    short = tiny.with_({"events": {"count": 1, "max_time": 0.05}})
    Study.product(short, {"panel.tilt": [40]}).run(tmp_path / "store", jobs=1)
    with pytest.warns(SnowshedNote, match="replaces a study of that name"):
        Study.product(short, {"panel.friction": [0.2]}).run(tmp_path / "store", jobs=1)
    changed = short.with_({"panel.tilt": 45})
    with pytest.warns(SnowshedNote, match="replaces .* with another scene or other values"):
        Study.product(changed, {"panel.friction": [0.2]}).run(tmp_path / "store", jobs=1)
    with record_notes() as notes:
        Study.product(changed, {"panel.friction": [0.2, 0.3]}).run(tmp_path / "store", jobs=1)
    assert not [note for note in notes if "replaces" in note]


def test_coincident_particles_are_refused(falling):
    points = [[0.3, 0.5], [0.3, 0.51], [0.3, 0.5]]
    with pytest.raises(InputError, match="indices 0 and 2 are the same place, and 1 of 3"):
        falling.add_snow(points)
    falling.add_snow(points[:2])


def test_positions_in_a_table_are_read_by_name(falling):
    added = pd.DataFrame({"z": [0.5, 0.51], "x": [0.3, 0.3]})
    falling.add_snow(added)
    assert falling.positions()[-2:] == pytest.approx(np.array([[0.3, 0, 0.5], [0.3, 0, 0.51]]))
    for columns in (["a", "b"], ["x", "y"], ["x", "old_x"]):
        with pytest.raises(InputError, match=r"positions: a table with the columns .* needed"):
            falling.add_snow(added.set_axis(columns, axis=1))
    with pytest.raises(InputError, match="changes: a table; needed: an array"):
        falling.add_velocity(added)


@pytest.mark.parametrize(
    "values",
    [
        {"method": "mps", "numerics": {"spacing": 0.05}},
        {"numerics": {"spacing": 0.05}, "method": "mps"},
        {"numerics": snowshed.MpsSettings(spacing=0.05), "method": "mps"},
        {"numerics.spacing": 0.05, "method": "mps"},
    ],
)
def test_method_and_settings_change_together(tiny, values):
    changed = tiny.with_(values)
    assert changed.method == "mps" and changed.numerics == snowshed.MpsSettings(spacing=0.05)
    assert tiny.with_({"method": "mpm", "numerics.dx": 0.03}).numerics.threads == 1
    with pytest.raises(
        InputError, match="takes MpsSettings, not MpmSettings; set numerics to None"
    ):
        tiny.with_(method="mps")


def test_a_part_that_a_method_does_not_take_is_refused_with_those_that_do():
    scene = Scene(method="slide", snow=snowshed.Snow(density=200))
    with pytest.raises(InputError) as caught:
        scene.resolve()
    assert str(caught.value) == (
        '/snow: the method "slide" takes no such part; methods that do: mpm'
    )


@pytest.mark.parametrize("name", ["settling", "sintering", "strength", "thaw"])
def test_none_as_a_text_is_refused_with_the_value_to_give(name):
    with pytest.raises(InputError, match=f"{name}: 'none'; allowed: .*, or None"):
        SeasonSettings(**{name: "none"})


def test_messages_in_python_name_arguments_and_calls_and_no_options(
    tiny, finished, tmp_path, monkeypatch
):
    unfinished = tmp_path / "unfinished"
    monkeypatch.setattr(sequence, "REPORT_INTERVAL", 0.0)
    with pytest.raises(snowshed.Interrupted):
        snowshed.run(tiny, unfinished, pictures=False, progress=interrupt_at(1, 0.05))
    (tmp_path / "grains.npy").touch()
    calls = {
        "nothing to resume; it holds no scene.json": lambda: snowshed.run(
            tiny, tmp_path / "no", resume=True
        ),
        "with `resume=True`, or replace its results with `overwrite=True`": lambda: snowshed.run(
            tiny, finished
        ),
        "give it in m (`voxel_size=`)": lambda: grains_scene(tmp_path / "grains.npy"),
        "start one with `Study.run`": lambda: read_table(tmp_path),
        "holds no study": lambda: read_simulated_stacks(tmp_path),
        "unfinished', resume=True)`": lambda: extend_run(unfinished, tmp_path / "new", 1),
    }
    for message, call in calls.items():
        with pytest.raises(InputError) as caught:
            call()
        assert message in str(caught.value)
        assert " --" not in str(caught.value) and "(--" not in str(caught.value)


def test_no_message_of_a_function_names_an_option_alone():
    """`snowshed.base.callers` names the option for a caller in the shell, and else the argument."""
    package = Path(snowshed.__file__).parent
    for file in package.rglob("*.py"):
        if "cli" not in file.parts:
            code = file.read_text(encoding="utf-8")
            for message in re.findall(r"raise \w*Error\((.*?)\)\n", code, re.DOTALL):
                assert not re.search(r"(?<!snowshed) --[a-z]|\(--", message), (file, message)


def test_every_message_names_options_that_a_command_has():
    """Both forms stand side by side in the code; the options are compared with the commands."""
    options, commands = set(), [main.cli]
    while commands:
        command = commands.pop()
        command = command.load() if isinstance(command, Deferred) else command
        commands += command.commands.values() if isinstance(command, click.Group) else []
        options |= {name for each in command.params for name in each.opts}
    package = Path(snowshed.__file__).parent
    named = {}
    for file in package.rglob("*.py"):
        code = "" if "cli" in file.parts else file.read_text(encoding="utf-8")
        for name, rest in re.findall(r"(?<!def )\bargument\(['\"](\w+)['\"]([^)]*)\)", code):
            option = re.search(r"option=['\"]([\w-]+)['\"]", rest)
            named["--" + (option[1] if option else name).replace("_", "-")] = file.name
    assert len(named) > 15
    assert {option: file for option, file in named.items() if option not in options} == {}
