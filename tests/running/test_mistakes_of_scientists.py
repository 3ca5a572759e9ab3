"""Typical mistakes of scientists with scenes, runs and studies: none is silent.

Each mistake must be told by a clear error, or by a note. Mistakes with arrays, tables and files are
in `tests/io/test_mistakes_with_data.py`, those in the shell and in Lua in
`tests/cli/test_mistakes_in_the_shell.py`. Tests elsewhere have further ones:

- two studies from one scene, shared parts: ``test_scene_copies.py``
- results of another build in a store, failed runs in a study: ``test_other_builds.py``
- a cell that is run twice, an interrupted cell: ``test_notebooks.py``
- a run.json that was changed, or is of another build: ``test_run_repeated.py``
- values that have no effect or are unusual, pauses, ranges: ``test_unlikely_values.py``
- laws of a wrong type or of changed code: ``test_laws.py``
- simulations used by two threads, or from their own functions: ``test_simulation.py``
- notes on snow that stays or still moves: ``test_notes_of_runs.py``
"""

import pickle

import numpy as np
import pandas as pd
import pytest
from helpers.mistakes import texts_of

import snowshed
from snowshed import InputError, Panel, Results, Scene, Simulation, SlideSettings, Snow, Study
from snowshed.running import LAW_PROTOTYPES, Laws
from snowshed.study import Factor, Span, latin_hypercube, linear, read_table, sobol


def lab(**values):
    """A slab of five cells that falls for a moment, without notes."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.01})
    scene.update({"numerics.threads": 1, "slab.thickness": 0.05, "title": ""})
    return scene.update({"events": {"count": 1, "max_time": 0.03, "rest_time": 0.01}, **values})


def test_the_scene_itself_is_no_mistake(tmp_path):
    assert texts_of(lambda: Simulation(lab()).begin_event()) == []


#: Values of a scene, and what is told of them.
VALUES = {
    "preconsolidation pressure in kPa": ({"snow.preconsolidation_pressure": 7}, "7 Pa is unusual"),
    "density in g/cm3": ({"snow.density": 0.2}, "0.2 kg/m3 is unusual"),
    "Young's modulus in MPa": ({"snow.youngs_modulus": 1}, "1 Pa is unusual"),
    "Young's modulus in kPa": ({"snow.youngs_modulus": 1000}, "Pa is unusual"),
    "cohesion in Pa": ({"snow.cohesion": 100}, "allowed range (0 <= value <= 1)"),
    "Poisson's ratio in percent": ({"snow.poissons_ratio": 30}, "allowed range"),
    "friction angle for a slope": ({"snow.critical_state_slope": 35}, "35 is unusual"),
    "friction in degrees": ({"panel.friction": 22}, "22 is unusual"),
    "negative friction": ({"panel.friction": -0.3}, "-0.3 is outside"),
    "height in cm": ({"panel.height": 330}, "330 m is unusual"),
    "height in mm": ({"panel.height": 3300}, "m is unusual"),
    "length in cm": ({"panel.length": 200}, "200 m is unusual"),
    "tilt in radians": ({"panel.tilt": 0.87}, "0.87 degrees is unusual"),
    "tilt of the ground in radians": ({"ground.tilt": 0.3}, "0.3 degrees is unusual"),
    "thickness in cm": ({"slab.thickness": 5}, "5 m thick beside a panel"),
    "slab of less than two cells": ({"slab.thickness": 0.015}, "less than two cells of 10 mm"),
    "cells in cm": ({"numerics.dx": 2}, "less than two cells"),
    "cells too small for the memory": ({"numerics.dx": 1e-6}, "memory"),
    "gravity in cm/s2": ({"gravity": 981}, "981 m/s2 is unusual"),
    "gravity downwards": ({"gravity": -9.81}, "-9.81 is outside"),
    "speed of rest in mm/s": ({"events.rest_speed": 50}, "50 m/s is unusual"),
    "a million threads": ({"numerics.threads": 1_000_000}, "1000000 is outside"),
    "negative threads": ({"numerics.threads": -1}, "-1 is outside"),
    "seed with a fraction": ({"seeding.seed": 1.5}, "1.5 is not a whole number"),
    "negative seed": ({"seeding.seed": -1}, "-1 is outside"),
    "a single particle in each cell": ({"seeding.particles_per_voxel": 1}, "too few in 2D"),
    "share in percent": ({"numerics.flip_ratio": 99}, "99 is outside"),
    "Courant factor above 1": ({"numerics.courant_factor": 5}, "5 is outside"),
    "no events": ({"events.count": 0}, "0 is outside"),
    "half an event": ({"events.count": 2.5}, "2.5 is not a whole number"),
    "an event shorter than its rest": ({"events.max_time": 0.005}, "is longer than an event"),
    "number as a text": ({"panel.tilt": "40"}, "'40' is not a number"),
    "truth value as a number": ({"panel.tilt": True}, "True is not a number"),
    "not a number": ({"panel.tilt": float("nan")}, "nan is not a finite number"),
    "array for a number": ({"panel.tilt": np.array([40.0, 50.0])}, "is not a number"),
    "four dimensions": ({"dimension": 4}, "4 is outside"),
    "dimension as a text": ({"dimension": "2D"}, "'2D' is not a whole number"),
    "misspelled key": ({"panel.tlit": 40}, "did you mean tilt?"),
    "misspelled part": ({"pannel.tilt": 40}, "did you mean panel?"),
    "misspelled condition": ({"panel.condition": "stick"}, "did you mean sticky?"),
    "unknown method": ({"method": "dem"}, "is none of mpm, slide, grains, mps"),
    "settings of another method": ({"numerics": SlideSettings()}, "takes MpmSettings, not"),
    "obstacle of three dimensions in 2D": (
        {"obstacles": [{"shape": {"type": "box", "center": [1, 1, 1], "size": [1, 1, 1]}}]},
        "the scene is 2D",
    ),
    "obstacle in mm": (
        {"obstacles": [{"shape": {"type": "box", "center": [900, 300], "size": [20, 20]}}]},
        "check its unit",
    ),
    "mesh that is not there": (
        {"obstacles": [{"shape": {"type": "mesh", "file": "missing.stl"}}]},
        "missing.stl: no such file",
    ),
}


@pytest.mark.parametrize("mistake", VALUES)
def test_a_value_that_is_a_mistake_is_told(mistake):
    values, expected = VALUES[mistake]
    texts = texts_of(lambda: Simulation(lab().with_(values)))
    assert any(expected in text for text in texts), texts


def fail(*_):
    raise ValueError("the user's own")


def begun(**values):
    simulation = Simulation(lab(**values))
    simulation.begin_event()
    return simulation


def run_with_friction(function):
    law = LAW_PROTOTYPES["friction"](function)
    Simulation(lab(), laws=Laws("mine", friction={"panel": law})).run()


#: Calls, and what is told of them; `f` is a folder with a run, and `new` a new one.
CALLS = {
    "misspelled attribute": (lambda f, new: setattr(lab().panel, "tlit", 20), "did you mean tilt?"),
    "misspelled attribute of a scene": (lambda f, new: setattr(lab(), "pannel", 1), "mean panel?"),
    "misspelled argument": (lambda f, new: Panel(heigth=1), "did you mean height?"),
    "misspelled preset": (lambda f, new: Scene.preset("lab50"), 'did you mean "lab-50"?'),
    "misspelled snow": (lambda f, new: Snow.preset("Reference"), 'did you mean "reference"?'),
    "folder with results": (lambda f, new: snowshed.run(lab(), f), "not empty; choose a new"),
    "file for a folder": (lambda f, new: snowshed.run(lab(), f / "run.json"), "not a folder"),
    "resuming another scene": (
        lambda f, new: snowshed.run(lab(**{"panel.tilt": 40}), f, resume=True),
        "made by another scene, which differs in /panel/tilt",
    ),
    "resuming another scene in a notebook": (
        lambda f, new: snowshed.run(lab(**{"panel.tilt": 40}), f, resume="auto"),
        "made by another scene",
    ),
    "resuming nothing": (lambda f, new: snowshed.run(lab(), new, resume=True), "nothing to resume"),
    "slide of a panel": (lambda f, new: snowshed.slide(lab(), new), "a value of type Scene"),
    "curve of a stack": (lambda f, new: Results(f).curve, 'the method "mpm" has no curve'),
    "maps of a stack": (lambda f, new: Results(f).maps, 'the method "mpm" has no maps'),
    "an event that was not simulated": (lambda f, new: Results(f).particles(9), "event: 9"),
    "results of a folder that is not there": (lambda f, new: Results(new), "no results"),
    "time that has passed": (lambda f, new: begun().run(until=-1), "-1 s has passed"),
    "time in ms": (lambda f, new: begun().run(until=300), "beyond the time limit"),
    "condition as a word": (lambda f, new: begun().run(until="still"), "until: 'still'"),
    "condition without an answer": (lambda f, new: begun().run(until=lambda s: None), "None"),
    "a number for a function": (lambda f, new: begun().run(on_step=3), "needed: a function"),
    "law that raises an error": (lambda f, new: run_with_friction(fail), "ValueError: the user's"),
    "law that returns nothing": (
        lambda f, new: run_with_friction(lambda speed, stress: None), "raised TypeError"
    ),
    "law that returns a text": (
        lambda f, new: run_with_friction(lambda speed, stress: "0.3"), "raised TypeError"
    ),
    "law that is not compiled": (
        lambda f, new: Laws("mine", friction={"panel": lambda speed, stress: 0.3}),
        "numba.cfunc or ctypes",
    ),
    "law of an obstacle that is not there": (
        lambda f, new: Simulation(
            lab(), laws=Laws("a", friction={"roof": LAW_PROTOTYPES["friction"](fail)})
        ),
        'no obstacle is called "roof"',
    ),
    "velocities of a wrong shape": (
        lambda f, new: begun().add_velocity(np.ones((3, 5))), "an array of shape (3, 5); needed"
    ),
    "velocities that are not finite": (
        lambda f, new: begun().add_velocity((np.nan, 0)), "all must be finite"
    ),
    "transposed positions": (
        lambda f, new: begun().add_snow(np.ones((2, 50))), "(2, 50); needed: (n, 3) or (n, 2)"
    ),
    "pickled simulation": (lambda f, new: pickle.dumps(begun()), "cannot pickle"),
    "number of steps as a text": (lambda f, new: begun().step("x"), "needed: a whole number"),
}  # fmt: skip


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("mistakes") / "run"
    texts_of(lambda: snowshed.run(lab(), folder, pictures=False))
    return folder


@pytest.mark.parametrize("mistake", CALLS)
def test_a_call_that_is_a_mistake_is_told(mistake, run_folder, tmp_path):
    call, expected = CALLS[mistake]
    texts = texts_of(lambda: call(run_folder, tmp_path / "new"))
    assert any(expected in text for text in texts), texts


@pytest.mark.parametrize("argument", ["until", "on_step"])
def test_errors_of_functions_reach_the_user(argument):
    with pytest.raises(ValueError, match="the user's own"):
        begun().run(**{argument: fail})


def test_a_run_whose_law_raises_an_error_is_recorded_as_failed(tmp_path):
    law = Laws("mine", friction={"panel": LAW_PROTOTYPES["friction"](fail)})
    texts = texts_of(lambda: snowshed.run(lab(), tmp_path / "out", laws=law, pictures=False))
    assert "a function raised ValueError: the user's own" in texts[0]
    assert Results(tmp_path / "out").run["status"] == "failed"


def test_a_pickled_scene_is_the_same_scene_and_shares_nothing():
    scene = lab()
    copy = pickle.loads(pickle.dumps(scene))
    assert copy == scene
    copy.set("panel.tilt", 33)
    assert scene.panel.tilt == 50


def study(axes, **options):
    return Study.product(lab(), axes, **options)


#: Studies, and what is told of them.
STUDIES = {
    "misspelled parameter": (lambda new: study({"panel.tlit": [40]}), "did you mean tilt?"),
    "a value for a list": (lambda new: study({"panel.tilt": 40}), "needed: a sequence"),
    "a text for a list": (lambda new: study({"panel.tilt": "40"}), "needed: a sequence"),
    "no values": (lambda new: study({"panel.tilt": []}), "0 values"),
    "not a number among values": (lambda new: study({"panel.tilt": [40, np.nan]}), "finite"),
    "numbers as texts": (lambda new: study({"panel.tilt": ["40"]}), "'40' is not a number"),
    "tilts in radians": (lambda new: study({"panel.tilt": [0.7, 0.8]}), "0.7 degrees is unusual"),
    "pressures in kPa": (
        lambda new: study({"snow.preconsolidation_pressure": [5, 7]}), "5 Pa is unusual"
    ),
    "a parameter without effect": (lambda new: study({"title": ["a"]}), "does not change a result"),
    "data for a scene": (
        lambda new: Study.product(lab().to_data(), {"panel.tilt": [40]}), "needed: Scene"
    ),
    "number of seeds for seeds": (lambda new: study({"panel.tilt": [40]}, seeds=3), "a sequence"),
    "seeds as a text": (lambda new: study({"panel.tilt": [40]}, seeds="12"), "a sequence"),
    "no processes": (lambda new: study({"panel.tilt": [40]}).run(new, jobs=0), "0 is not positive"),
    "table with other columns": (
        lambda new: Study(lab(), [[Factor(pd.DataFrame({"tilt": [40.0]}))]]), "unknown key"
    ),
    "columns of different lengths": (
        lambda new: Factor({"panel.tilt": [1, 2], "panel.height": [1]}), "equally many values"
    ),
    "matrix for a list": (
        lambda new: Study(lab(), [[Factor({"panel.tilt": np.eye(2)})]]), "is not a number"
    ),
    "step as third argument": (lambda new: linear(40, 60, 10), "takes 2 positional arguments"),
    "span upside down": (
        lambda new: latin_hypercube({"snow.cohesion": Span(0.3, 0.05)}, 4), "is not above"
    ),
    "Sobol of three": (lambda new: sobol({"snow.cohesion": Span(0, 0.3)}, 3), "not a power of two"),
    "table of nothing": (lambda new: read_table(new), "holds no study"),
    "coarse cells in a study": (
        lambda new: study({"numerics.dx": [0.05]}).run(new, jobs=1), "less than two cells of 50 mm"
    ),
}  # fmt: skip


@pytest.mark.parametrize("mistake", STUDIES)
def test_a_study_that_is_a_mistake_is_told(mistake, tmp_path):
    make, expected = STUDIES[mistake]
    texts = texts_of(lambda: make(tmp_path / "new"))
    assert any(expected in text for text in texts), texts


def test_a_study_in_the_folder_of_a_run_is_refused(run_folder):
    with pytest.raises(InputError, match="not empty, but holds no study"):
        study({"panel.tilt": [40]}).run(run_folder, jobs=1)
    with pytest.raises(InputError, match="holds no study"):
        read_table(run_folder)


def test_a_law_of_numba_that_raises_an_error_is_told():
    numba = pytest.importorskip("numba")

    @numba.cfunc("float64(float64, float64)")
    def wrong(speed, stress):
        raise ValueError("the user's own")

    texts = texts_of(Simulation(lab(), laws=Laws("mine", friction={"panel": wrong})).run)
    assert any("raised ValueError: the user's own" in text for text in texts), texts
