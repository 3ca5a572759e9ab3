import json

import numpy as np
import pytest

from snowshed import (
    InputError,
    Obstacle,
    Panel,
    ResolvedScene,
    Scene,
    Shape,
    SlideSettings,
    Snow,
    _core,
)
from snowshed.base.record import Record
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.methods.registry import METHODS
from snowshed.scene.schema import (
    properties,
    resolve,
    scene_parameters,
    scene_schema,
    schema_of_method,
)

SCHEMA = scene_schema()


def check_mirror(record: type[Record], node: dict, checked: set) -> None:
    """Compare a record's fields with the core's properties, recursively."""
    inner = properties(SCHEMA, node)
    if record is not MpmSettings:  # this node of the schema has the settings of all methods
        assert set(record.keys()) == set(inner), record
    checked.add(record)
    for key in record.keys():  # noqa: SIM118 (a class method, not a mapping's)
        kind = record().record_type(key)
        full = resolve(SCHEMA, inner[key])
        child = full.get("items", inner[key])
        assert (kind is not None) == bool(properties(SCHEMA, child)), key
        if kind is not None and kind not in checked:
            check_mirror(kind, child, checked)


def test_fields_agree_with_the_cores_schema():
    checked: set = set()
    check_mirror(Scene, SCHEMA, checked)
    assert len(checked) == 26  # every record except the settings of other methods


@pytest.mark.parametrize("method", METHODS)
def test_settings_agree_with_the_cores_schema(method):
    inner = properties(SCHEMA, schema_of_method(method)["properties"]["numerics"])
    assert set(METHODS[method].settings.keys()) == set(inner)


def test_the_last_value_applies(tiny):
    tiny.set("snow.density", 300).update({"snow": {"density": 250, "cohesion": 0.3}})
    assert tiny.resolve().data["snow"]["density"] == 250
    assert tiny.resolve().data["snow"]["cohesion"] == 0.3
    assert tiny.resolve().data["snow"]["youngs_modulus"] == 1e6  # unchanged by the update


def test_items_are_appended_and_changed(tiny):
    tiny.append("obstacles", Obstacle("post", Shape.sphere((0.5, 0.1), 0.05)))
    tiny.append("obstacles", {"shape": {"type": "box", "center": [1, 0], "size": [0.1, 0.1]}})
    tiny.set("obstacles.1.friction", 0.7)
    first, second = tiny.resolve().data["obstacles"]
    assert first["name"] == "post"
    assert second["friction"] == 0.7
    assert isinstance(tiny.obstacles[1], Obstacle)


def test_missing_parts_of_a_path_are_created():
    assert Scene().set("panel.tilt", 30).to_data()["panel"] == {"tilt": 30}


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("snow.densty", "/snow/densty: unknown key; allowed: model, density"),
        ("gravity.x", "/gravity: a value"),
        ("obstacles.3.friction", "/obstacles/3: no such item"),
        ("obstacles.0", "/obstacles/0: set a key"),
    ],
)
def test_wrong_paths_are_refused(tiny, path, message):
    with pytest.raises(InputError, match=message):
        tiny.set(path, 1)


def test_values_that_are_not_finite_are_refused(tiny):
    with pytest.raises(InputError, match="/panel/tilt: nan is not a finite number"):
        tiny.set("panel.tilt", float("nan")).resolve()


def test_a_failed_call_does_not_change_the_scene(tiny):
    before = tiny.to_data()
    for change in (
        lambda: tiny.set("domain.mn", 1),
        lambda: tiny.set("domain.min", "far"),
        lambda: tiny.append("obstacles", {"nam": "post"}),
        lambda: tiny.update({"panel.tilt": 30, "domain": {"min": (0, 0), "mx": (1, 1)}}),
    ):
        with pytest.raises(InputError):
            change()
    assert tiny.to_data() == before and tiny.domain is None


def test_the_method_determines_the_settings(tiny):
    assert tiny.set("method", "mpm").resolve() == Scene.from_data(tiny.to_data()).resolve()
    assert "method" not in tiny.resolve().data
    with pytest.raises(
        InputError, match=r"^/method: 'mpmm' is none of mpm, slide, grains, mps; did you mean mpm"
    ):
        tiny.set("method", "mpmm")
    with pytest.raises(
        InputError, match=r"^/method: the method 'slide' takes SlideSettings, not Mpm"
    ):
        tiny.set("method", "slide")
    assert isinstance(Scene(method="slide").set("numerics.friction", 0.3).numerics, SlideSettings)


def test_the_former_name_of_the_courant_factor_is_read(tmp_path, tiny):
    data = {**tiny.to_data(), "numerics": {"dx": 0.02, "step_factor": 0.5}}
    (tmp_path / "scene.json").write_text(json.dumps(data))
    for load in (Scene.load, ResolvedScene.load):
        scene = load(tmp_path / "scene.json")
        scene = scene.resolve() if isinstance(scene, Scene) else scene
        assert scene.data["numerics"]["courant_factor"] == 0.5
    assert tiny.set("numerics.step_factor", 0.4).numerics.courant_factor == 0.4


def test_errors_of_the_core_name_the_path(tiny):
    with pytest.raises(InputError, match=r"^/snow/poissons_ratio: 0\.5"):
        tiny.set("snow.poissons_ratio", 0.5).resolve()


def test_numpy_values_are_accepted(tiny):
    tiny.set("domain", {"min": np.array([-2, -1]), "max": np.array([2.0, 2.0])})
    tiny.set("panel.tilt", np.float32(45))
    assert tiny.resolve().data["domain"]["min"] == [-2, -1]


def test_a_saved_scene_is_read_back(tmp_path, tiny):
    resolved = tiny.resolve()
    resolved.save(tmp_path / "scene.json")
    assert ResolvedScene.load(tmp_path / "scene.json").data == resolved.data
    assert Scene.load(tmp_path / "scene.json").resolve().data == resolved.data


def test_files_without_a_scene_are_refused_with_the_reason(tmp_path):
    path = tmp_path / "scene.json"
    path.write_text("{")
    with pytest.raises(InputError, match="not JSON"):
        Scene.load(path)
    path.write_text('{"panel": {"hight": 1}}')
    with pytest.raises(InputError, match="/panel/hight: unknown key"):
        Scene.load(path)
    path.write_text('{"panel": {"tilt": null}}')
    with pytest.raises(InputError, match=r"/panel/tilt: null is not a value; leave the key out"):
        Scene.load(path)
    path.write_text('{"panel": 3}')
    with pytest.raises(InputError, match=r"scene\.json: /panel: 3 is not an object"):
        Scene.load(path)
    for number in ("NaN", "-Infinity", "1e999", "1" + "0" * 400):
        path.write_text(f'{{"panel": {{"tilt": {number}}}}}')
        with pytest.raises(InputError, match=r"scene\.json: /panel/tilt: .* is not a finite"):
            Scene.load(path)


@pytest.mark.parametrize(
    "shape",
    [
        Shape.plane((0, 0, 0), (0, 0, 1)),
        Shape.box((0, 0, 1), (1, 1, 1)),
        Shape.sphere((0, 0, 1), 0.5),
        Shape.cylinder((0, 0, 0), (0, 0, 1), 0.1),
        Shape.capsule((0, 0, 0), (0, 0, 1), 0.1),
        Shape.plate((0, 0, 1), (0, 0, 1), 1.0, width=1.0, thickness=0.02),
        Shape.union(Shape.sphere((0, 0, 1), 0.5), Shape.sphere((0, 0, 2), 0.5)),
        Shape.difference(Shape.sphere((0, 0, 1), 0.5), Shape.sphere((0, 0, 1), 0.2)),
        Shape.transform(Shape.box((0, 0, 0), (1, 1, 1)), axis=(0, 1, 0), angle=30),
    ],
    ids=lambda shape: shape.type,
)
def test_the_core_accepts_every_shape(shape):
    scene = Scene.preset("lab-50").append("obstacles", Obstacle(shape=shape))
    assert scene.resolve().data["obstacles"][0]["shape"]["type"] == shape.type


def test_parameters_have_kinds_and_defaults():
    parameters = {parameter.path: parameter for parameter in scene_parameters()}
    assert parameters["snow.density"].unit == "kg/m3"
    assert parameters["events.between"].choices == ("carry", "reseed")
    assert parameters["obstacles"].kind == "list"
    assert parameters["domain.min"].kind == "vector"
    assert parameters["output.energy"].kind == "boolean"


def test_defaults_are_not_stored_in_scenes():
    assert Panel() == Panel(None, None, None)
    assert Scene().to_data() == {"snowshed": 2}


def test_lab_presets_agree_with_table_2_3_1():
    for tilt in (40, 50):
        data = Scene.preset(f"lab-{tilt}").resolve().data
        panel, slab = data["panel"], data["slab"]
        assert panel["tilt"] == tilt
        assert (panel["height"], panel["length"], panel["width"]) == (0.33, 0.245, 0.213)
        assert (slab["length"], slab["width"], slab["thickness"]) == (0.245, 0.142, 0.02)
        assert (data["snow"]["density"], data["numerics"]["dx"]) == (210, 0.01)
        assert (data["dimension"], data["events"]["count"]) == (3, 5)


def test_the_sensitivity_preset_agrees_with_table_3_2_1():
    data = Scene.preset("sensitivity").to_data()
    assert (data["panel"]["height"], data["panel"]["tilt"]) == (0.5, 40)
    assert (data["dimension"], data["events"]["count"]) == (3, 3)


def test_the_geometry_preset_agrees_with_table_5_1_1():
    data = Scene.preset("geometry").to_data()
    panel = data["panel"]
    assert (panel["height"], panel["length"], panel["tilt"]) == (2, 2, 40)
    assert (data["slab"]["thickness"], data["numerics"]["dx"]) == (0.05, 0.01)
    assert (data["dimension"], data["events"]["count"]) == (2, 5)


def test_the_slab_of_a_preset_takes_the_length_of_its_panel():
    for name in ("lab-40", "lab-50", "sensitivity", "geometry"):
        data = Scene.preset(name).set("panel.length", 4.0).resolve().data
        assert data["slab"]["length"] == 4.0


def test_calibrated_snow_agrees_with_table_4_3_1():
    snow = Snow.preset("calibrated")
    assert (snow.critical_state_slope, snow.preconsolidation_pressure) == (0.5, 7e3)
    assert (snow.cohesion, snow.hardening_factor, snow.youngs_modulus) == (0.2, 0.1, 1e6)


def test_unknown_presets_are_refused():
    with pytest.raises(InputError, match="lab-40"):
        Scene.preset("lab")
    with pytest.raises(InputError, match="calibrated"):
        Snow.preset("wet")


def test_distances_follow_moving_obstacles(tiny):
    tiny.append("obstacles", Obstacle("post", Shape.sphere((3.0, 1.0), 0.5)))
    tiny.append("obstacles", Obstacle("cart", Shape.box((9.0, 0.5), (1.0, 1.0))))
    tiny.set("obstacles.1.motion.velocity", [10.0, 0.0])
    simulation = _core.Simulation(tiny.set("events.max_time", 0.1).resolve().json)
    points = np.array([[3.0, 0, 1.0], [3.0, 0, 2.0], [9.0, 0, 0.5]])
    assert simulation.obstacle_distance(points) == pytest.approx([-0.5, 0.5, -0.5])
    simulation.begin_event()
    simulation.run(lambda info: True)
    assert simulation.obstacle_distance(points)[2] == pytest.approx(10 * 0.1 - 0.5, abs=0.02)
    with pytest.raises(InputError, match="points"):
        simulation.obstacle_distance(points[0])
