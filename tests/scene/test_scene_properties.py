"""Properties of scenes that hold for any values, files and options (with hypothesis).

Every scene here starts from a valid one, so that every error comes from the test.
"""

import contextlib
import json
import math
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from snowshed import (
    Body,
    InputError,
    Layer,
    Motion,
    Obstacle,
    ResolvedScene,
    Scene,
    Shape,
    Snow,
)
from snowshed.cli.main import main
from snowshed.cli.options.scene import option_name
from snowshed.running.scene_notes import notes_of_beginning
from snowshed.scene.schema import Parameter, scene_parameters

fifty_examples = settings(max_examples=50)

PARAMETERS = {parameter.path: parameter for parameter in scene_parameters()}
FOLLOWERS = ("slab.length", "slab.width", "seeding.particles_per_voxel")
small = st.floats(-2, 2)
lengths = st.floats(0.01, 1)


def vectors(numbers: st.SearchStrategy = small) -> st.SearchStrategy:
    return st.lists(numbers, min_size=3, max_size=3)


def shapes() -> st.SearchStrategy:
    simple = st.one_of(
        st.builds(Shape.sphere, vectors(), lengths),
        st.builds(Shape.box, vectors(), vectors(lengths)),
        st.builds(Shape.capsule, vectors(), vectors(), lengths),
        st.builds(Shape.plane, vectors(), vectors()),
    )
    return st.recursive(simple, lambda inner: st.builds(Shape.union, inner, inner), max_leaves=4)


PLAUSIBLE = {
    "number": st.one_of(lengths, st.integers(0, 5), st.floats(1, 1e6), lengths.map(np.float32)),
    "integer": st.integers(0, 4),
    "boolean": st.booleans(),
    "string": st.text(max_size=5),
    "vector": st.one_of(vectors(), vectors().map(np.array)),
}
MOTIONS = st.none() | st.builds(Motion, velocity=st.none() | vectors(), start=st.none() | lengths)
SNOWS = st.none() | st.builds(Snow, density=st.none() | lengths.map(lambda part: 400 * part))
EVENTS = st.none() | st.integers(0, 4)
ITEMS = {
    "obstacles": st.builds(Obstacle, shape=shapes(), friction=st.none() | small, motion=MOTIONS),
    "bodies": st.builds(Body, shape=shapes(), event=EVENTS, snow=SNOWS),
    "slab.layers": st.builds(Layer, thickness=lengths, snow=SNOWS, event=EVENTS),
}
JSON_VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=5,
)
NO_JSON = st.sampled_from([math.nan, -math.inf, 10**400, 1j, b"x", {1}, object(), "\\ud800"])
ANYTHING = st.recursive(
    JSON_VALUES | NO_JSON,
    lambda inner: st.lists(inner, max_size=2) | st.dictionaries(st.text(max_size=2), inner),
    max_leaves=3,
)


def plausible(parameter: Parameter) -> st.SearchStrategy:
    """Values of the correct type, many of them in range."""
    if parameter.choices:
        return st.sampled_from(parameter.choices)
    if parameter.path in ITEMS:
        return st.lists(ITEMS[parameter.path], max_size=3)
    values = PLAUSIBLE[parameter.kind]
    if parameter.kind == "number" and parameter.default:
        values |= lengths.map(lambda part: part * parameter.default)
    return values


def assignments(*strategies: st.SearchStrategy) -> st.SearchStrategy:
    """Pairs of a parameter's path and a value for it."""
    return st.sampled_from(list(PARAMETERS.values())).flatmap(
        lambda p: st.tuples(st.just(p.path), st.one_of(plausible(p), *strategies))
    )


def pointer(path: str) -> str:
    return "/" + path.replace(".", "/")


def value_at(data: Any, path: str) -> Any:
    for key in path.split("."):
        data = data[key]
    return data


def has_value(data: Any, path: str, value: Any) -> bool:
    """Return whether the scene has the value that was set; None and these zeros mean a default."""
    if value is None or (path in FOLLOWERS and value == 0):
        return True
    if path == "method":  # the default is not written
        return bool(data.get(path, "mpm") == value)
    return bool(value_at(data, path) == (value.tolist() if hasattr(value, "tolist") else value))


@fifty_examples
@given(st.sampled_from([Scene.set, Scene.append]), assignments(ANYTHING))
def test_appending_gives_a_scene_or_an_error_that_names_the_list(change, assignment):
    path, value = assignment
    scene = Scene.preset("lab-50").append("obstacles", Obstacle(shape=Shape.sphere((1, 0, 1), 0.1)))
    with contextlib.suppress(InputError):
        change(scene, path, value)
    try:
        scene.append(path, value).resolve()
    except InputError as error:
        assert str(error).startswith("/")


@pytest.mark.parametrize(
    "content",
    [b"[" * 100000, b'{"snow": {"density": 1, "density": 2}}', b'{"gravity": 1' + b"0" * 5000],
    ids=["nested", "twice", "long"],
)
def test_files_on_which_json_readers_disagree_are_refused(tmp_path, content):
    (tmp_path / "scene.json").write_bytes(content)
    for load in (Scene.load, ResolvedScene.load):
        with pytest.raises(InputError):
            load(tmp_path / "scene.json")


def test_values_beyond_all_bounds_are_refused():
    endless: list = []
    endless.append(endless)
    with pytest.raises(InputError, match=r"^/gravity: \[\[...\]\] is not a number"):
        Scene().set("gravity", endless)
    shape: dict = {"type": "union"}
    shape["shapes"] = [shape]
    with pytest.raises(InputError, match=r"^/bodies/0/shape/.*nested more than 64 deep"):
        Scene().set("bodies", [{"shape": shape}])
    cyclic = Shape.union()
    list.append(cyclic.shapes, cyclic)  # the list's own method would append a copy
    with pytest.raises(InputError, match=r"^/bodies/0/shape/.*nested more than 64 deep"):
        Scene(bodies=[Body(shape=cyclic)]).to_data()
    with pytest.raises(InputError, match=r"^/gravity: an integer of 16610 bits is not a finite"):
        Scene().set("gravity", 10**5000).resolve()
    with pytest.raises(InputError, match=r"^/obstacles/0: None is not an object"):
        Scene().set("obstacles", [None]).set("obstacles.0.name", "x")


@fifty_examples
@given(st.lists(assignments(), max_size=6) | st.lists(assignments(ANYTHING), max_size=3))
def test_sets_give_a_stable_scene_or_an_error_that_names_a_path(sets):
    scene = Scene.preset("lab-50")
    try:
        for path, value in sets:
            scene.set(path, value)
        resolved = scene.resolve()
    except InputError as error:
        assert str(error).startswith("/")
        assert any(path.partition(".")[0] in str(error) for path, _ in sets), (error, sets)
        return
    assert ResolvedScene.parse(resolved.json) == resolved
    assert Scene.from_data(resolved.data).resolve() == resolved
    for path, value in dict(sets).items():
        assert path in ITEMS or has_value(resolved.data, path, value), path


def wrong_values(parameter: Parameter) -> st.SearchStrategy:
    """Values of other types than the parameter's, and numbers that no parameter allows."""
    types = {"boolean": bool, "string": str, "vector": list, "list": list, "number": (int, float)}
    right = types.get(parameter.kind, (int, float))
    free_text = parameter.kind == "string" and parameter.choices is None
    return st.one_of(
        ANYTHING.filter(lambda value: value is not None and type(value) is not bool).filter(
            lambda value: not isinstance(value, right)
        ),
        st.sampled_from(
            [math.nan, math.inf, -math.inf, 10**400, -1e300, [[]], *(() if free_text else "\0")]
        ),
    )


@fifty_examples
@given(
    st.sampled_from(list(PARAMETERS.values())).flatmap(
        lambda p: st.tuples(st.just(p), wrong_values(p))
    )
)
def test_a_wrong_value_is_refused_by_its_path(case):
    parameter, value = case
    with pytest.raises(InputError) as error:
        Scene.preset("lab-50").set(parameter.path, value).resolve()
    assert str(error.value).startswith(pointer(parameter.path))


@st.composite
def damaged_scenes(draw: Callable) -> str:
    """A scene's JSON with one value, anywhere in it, replaced by another."""
    data = Scene.preset("lab-50").append("obstacles", draw(ITEMS["obstacles"])).to_data()
    holder, key = None, None
    inner: Any = data
    while isinstance(inner, (dict, list)) and inner and (holder is None or draw(st.booleans())):
        holder = inner
        key = draw(st.sampled_from(list(inner) if isinstance(inner, dict) else range(len(inner))))
        inner = holder[key]
    holder[key] = draw(lengths | JSON_VALUES)
    return json.dumps(data)


@st.composite
def damaged_texts(draw: Callable) -> str:
    """A scene's JSON text with a piece replaced by other characters."""
    text = Scene.preset("lab-50").resolve().json
    start, end = sorted(draw(st.lists(st.integers(0, len(text)), min_size=2, max_size=2)))
    return text[:start] + draw(st.text(max_size=5)) + text[min(end, start + 20) :]


@fifty_examples
@given(st.one_of(st.text(), JSON_VALUES.map(json.dumps), damaged_scenes(), damaged_texts()))
def test_any_text_gives_a_stable_scene_or_an_input_error(text):
    try:
        resolved = ResolvedScene.parse(text)
    except InputError as error:
        assert str(error).startswith(("/", "scene:")), error
    else:
        assert ResolvedScene.parse(resolved.json) == resolved
        assert Scene.from_data(resolved.data).resolve() == resolved


@fifty_examples
@given(st.binary() | damaged_scenes().map(str.encode) | damaged_texts().map(str.encode))
def test_any_file_gives_a_scene_or_an_input_error(tmp_path_factory, content):
    file = tmp_path_factory.getbasetemp() / "any.json"
    file.write_bytes(content)
    try:
        scene = Scene.load(file)
        resolved = scene.resolve()
    except InputError:
        with pytest.raises(InputError):
            ResolvedScene.load(file)
        return
    if "snowshed" in json.loads(content):  # only a part of a scene may lack this key
        assert resolved == ResolvedScene.load(file)


def as_options(path: str, value: Any) -> list[str]:
    """Return the command line's words for a value that a parameter may have."""
    name = option_name(path)
    if isinstance(value, bool):
        return [name if value else f"--no-{name[2:]}"]
    if path in ITEMS:
        return [f"{name}={json.dumps(item.to_data())}" for item in value]
    if hasattr(value, "tolist"):
        value = value.tolist()
    return [f"{name}={','.join(map(str, value)) if isinstance(value, list) else value}"]


@fifty_examples
@given(st.lists(assignments(), max_size=6))
def test_options_make_the_same_scene_as_sets_or_the_same_error(sets):
    assume(
        not {"numerics.flip_ratio", "numerics.damping_rate"} <= set(dict(sets))
    )  # these exclude each other
    scene = Scene.preset("lab-50")
    words = ["scene", "--preset=lab-50"]
    for path, value in dict(sets).items():
        words += as_options(path, value)
    output, errors = StringIO(), StringIO()
    with redirect_stdout(output), redirect_stderr(errors):
        code = main(words)
    assume("GB of memory" not in errors.getvalue())  # the free memory changes between runs
    try:
        scene.update(dict(sets))
        resolved = scene.resolve()
        notes_of_beginning(resolved)  # the command refuses misplaced snow, too
        expected = resolved.json
    except InputError as error:
        assert code == 2
        assert " ".join(str(error).split()).partition(":")[2] in errors.getvalue()
    else:
        assert (code, output.getvalue().rstrip()) == (0, expected.rstrip()), errors.getvalue()
