"""Records: misspelt names and values of a wrong type are errors at once."""

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

from snowshed._core import InputError
from snowshed.base.record import UnknownFieldError
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.scene import Domain, Motion, Obstacle, Panel, Scene, Seeding, Shape


@pytest.mark.parametrize(
    ("use", "message"),
    [
        (
            lambda: setattr(Panel(), "tlit", 20),
            "Panel.tlit: Panel has no such field; did you mean tilt?",
        ),
        (lambda: Panel().tlit, "Panel.tlit: .* did you mean tilt"),
        (lambda: Panel(tlit=20), "Panel.tlit: .* did you mean tilt"),
        (lambda: Panel.from_data({"tlit": 20}), "^/tlit: unknown key; .* did you mean tilt"),
        (lambda: setattr(Scene(), "pannel", Panel()), "Scene.pannel: .* did you mean panel"),
        (lambda: setattr(MpmSettings(), "DX", 1), "MpmSettings.DX: .* did you mean dx"),
        (lambda: setattr(Panel(), "keys", 1), "Panel.keys: .* it has height, length"),
        (lambda: setattr(Panel(), "_tilt", 1), "Panel._tilt: "),
    ],
)
def test_a_misspelt_name_is_an_error_that_names_the_class_and_a_field(use, message):
    with pytest.raises(InputError, match=message):
        use()


def test_unknown_fields_are_attribute_errors_and_type_errors():
    assert not hasattr(Panel(), "tlit")
    for builtin in (AttributeError, TypeError):
        assert issubclass(UnknownFieldError, builtin)


@pytest.mark.parametrize(
    ("use", "message"),
    [
        (lambda: Panel(tilt="40"), "Panel.tilt: '40' is not a number"),
        (lambda: Panel(tilt=True), "Panel.tilt: True is not a number"),
        (lambda: Panel(tilt=float("nan")), "Panel.tilt: nan is not a finite number"),
        (lambda: Panel(condition="stiky"), "none of sticky, slip, separate; did you mean sticky"),
        (lambda: Seeding(seed=1.5), "Seeding.seed: 1.5 is not a whole number"),
        (lambda: Seeding(allow_sparse=1), "Seeding.allow_sparse: 1 is not true or false"),
        (lambda: Scene(title=3), "Scene.title: 3 is not a text"),
        (lambda: Domain(min=3.0), "Domain.min: 3.0 is not a vector"),
        (lambda: Domain(min=(0, "x")), "Domain.min/1: 'x' is not a number"),
        (lambda: Motion(angular_velocity="x"), "not a vector such as .* or a number"),
        (lambda: Scene(panel=3), "Scene.panel: 3 is not an object such as Panel"),
        (lambda: Scene(panel=Shape()), r"Scene.panel: Shape\(.* is not an object such as Panel"),
        (lambda: Scene(panel={"tlit": 3}), "Scene.panel/tlit: unknown key"),
        (lambda: Scene(obstacles=Obstacle()), "Scene.obstacles: .* is not a list"),
        (lambda: Scene(obstacles=[3]), "Scene.obstacles/0: 3 is not an object such as Obstacle"),
    ],
)
def test_a_value_of_the_wrong_type_is_an_error_at_once(use, message):
    with pytest.raises(InputError, match=message):
        use()


def test_a_refused_value_leaves_the_old_one():
    panel = Panel(tilt=40)
    with pytest.raises(InputError):
        panel.tilt = "steep"
    assert panel.tilt == 40


def test_numpy_values_and_paths_become_json_values():
    domain = Domain(min=np.array([0.5, 1], dtype=np.float32), max=[np.int64(2), 3])
    assert (domain.min, domain.max) == ((0.5, 1.0), (2, 3))
    assert type(Panel(tilt=np.float32(45)).tilt) is float
    assert type(Seeding(seed=np.uint64(2)).seed) is int
    assert type(Seeding(seed=2.0).seed) is int
    assert Seeding(allow_sparse=np.bool_(True)).allow_sparse is True
    assert Shape.mesh(Path("a") / "b.stl").file == str(Path("a") / "b.stl")


def test_a_dict_becomes_a_component():
    scene = Scene(panel={"tilt": 40}, obstacles=[{"shape": {"type": "box"}}])
    assert scene.panel == Panel(tilt=40)
    assert scene.obstacles == [Obstacle(shape=Shape(type="box"))]


def test_a_dict_added_to_a_list_is_checked_when_the_scene_is_written():
    scene = Scene(obstacles=[])
    scene.obstacles.append({"nam": "post"})
    with pytest.raises(InputError, match=r"^/obstacles/0/nam: unknown key; .* did you mean name"):
        scene.to_data()


def test_names_of_pvlib_are_aliases_of_fields():
    panel = Panel(surface_tilt=40, slant_height=2, lower_edge_height=1)
    assert panel == Panel(tilt=40, length=2, height=1)
    panel.surface_tilt = 50
    assert (panel.tilt, panel.surface_tilt) == (50, 50)
    assert Panel.from_data({"surface_tilt": 50}).to_data() == {"tilt": 50}


@pytest.mark.parametrize(
    "use",
    [
        lambda: Panel(tilt=40, surface_tilt=40),
        lambda: Panel.from_data({"tilt": 40, "surface_tilt": 40}),
        lambda: Scene().update({"panel": {"tilt": 40, "surface_tilt": 40}}),
        lambda: Scene().update({"panel.tilt": 40, "panel.surface_tilt": 40}),
        lambda: Scene().update({"numerics.step_factor": 0.5, "numerics": {"courant_factor": 0.5}}),
    ],
)
def test_a_field_by_two_names_is_an_error(use):
    with pytest.raises(InputError, match=r"means the same as .*; give one of the two"):
        use()


def test_copies_are_equal():
    scene = Scene(panel=Panel(tilt=40), obstacles=[Obstacle(shape=Shape.sphere((0, 1), 0.2))])
    assert copy.deepcopy(scene) == scene
    assert pickle.loads(pickle.dumps(scene)) == scene
