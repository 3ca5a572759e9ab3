"""A scene keeps copies of given values, changes only on request, and shows its values."""

import operator
import pickle

import pytest

from snowshed import (
    Body,
    InputError,
    Layer,
    MpmSettings,
    Obstacle,
    Panel,
    Scene,
    Shape,
    Simulation,
    SimulationError,
    Slab,
    SlideSettings,
    Snow,
)
from snowshed.study import Study


def test_a_copy_with_other_values_does_not_change_the_scene():
    base = Scene.preset("lab-50")
    before = base.copy()
    runs = [base.with_({"panel.tilt": tilt}, snow={"density": 250}) for tilt in (30, 40)]
    assert [run.panel.tilt for run in runs] == [30, 40]
    assert runs[0].snow.density == 250
    assert base == before
    with pytest.raises(InputError, match="/panel/tlit: unknown key"):
        base.with_({"panel.tlit": 1})


def test_a_copy_has_the_same_base_folder_for_paths(tmp_path):
    (tmp_path / "scene.json").write_text('{"dimension": 2}')
    assert Scene.load(tmp_path / "scene.json").with_(dimension=3)._base_dir == str(tmp_path)


def test_studies_keep_copies_of_their_scene():
    base = Scene.preset("lab-50").update({"dimension": 2})
    weak = Study.product(base.set("snow.cohesion", 0.05), {"panel.tilt": [40]})
    strong = Study.product(base.set("snow.cohesion", 0.3), {"panel.tilt": [40]})
    assert weak.scene.snow.cohesion == 0.05
    assert weak.runs()[0].hash != strong.runs()[0].hash


def test_scenes_share_no_parts():
    panel, shelf = Panel(height=1.0, length=1.0), Obstacle(shape=Shape.box((0, 0), (1, 1)))
    first, second = Scene(panel=panel, obstacles=[shelf]), Scene(panel=panel)
    second.append("obstacles", shelf)
    panel.tilt = first.panel.tilt = 60
    first.obstacles[0].friction = 0.9
    assert second.panel == Panel(height=1.0, length=1.0)
    assert shelf == second.obstacles[0] == Obstacle(shape=Shape.box((0, 0), (1, 1)))


def entered_by(name):
    """A function that puts a part into a list of a scene."""

    def assign(items, part):
        items[:] = [part, part]

    def replace(items, part):
        items.append(None)
        items[0] = part

    def add(items, part):
        items += [part]

    return {
        "append": lambda items, part: items.append(part),
        "extend": lambda items, part: items.extend([part]),
        "insert": lambda items, part: items.insert(0, part),
        "slice": assign,
        "index": replace,
        "+=": add,
    }[name]


@pytest.mark.parametrize("name", ["append", "extend", "insert", "slice", "index", "+="])
def test_lists_of_scenes_share_no_parts(name):
    box = Shape.box((0, 0), (1, 1))
    for path, part, field in [
        ("obstacles", Obstacle(shape=box), "friction"),
        ("bodies", Body(shape=box), "volume"),
        ("slab.layers", Layer(thickness=0.1), "thickness"),
    ]:
        scenes = [Scene(slab=Slab()).set(path, []) for _ in range(2)]
        lists = [operator.attrgetter(path)(scene) for scene in scenes]
        before = getattr(part, field)
        for items in lists:
            entered_by(name)(items, part)
        setattr(lists[0][0], field, 0.77)
        assert getattr(lists[1][0], field) == getattr(part, field) == before
        assert all(getattr(item, field) == before for item in lists[0][1:] if item)


def test_a_list_given_to_two_scenes_and_repeated_in_one_is_copied():
    shelves = [Obstacle(shape=Shape.box((0, 0), (1, 1)))]
    first, second = Scene(obstacles=shelves), Scene(obstacles=shelves)
    first.obstacles *= 2
    second.obstacles = first.obstacles
    first.obstacles[0].friction = 0.11
    frictions = [[part.friction for part in scene.obstacles] for scene in (first, second)]
    assert frictions == [[0.11, 0.3], [0.3, 0.3]]
    assert pickle.loads(pickle.dumps(first)) == first == first.copy()


def test_every_scene_has_snow_seeding_settings_events_and_output():
    scene = Scene(panel=Panel(height=1.0, length=1.0))
    scene.snow.density = 250
    scene.numerics.dx = 0.02
    assert scene.to_data()["snow"] == {"density": 250}
    assert "events" not in scene.to_data()
    assert Scene().to_data() == {"snowshed": 2}
    assert Scene.from_data({"snow": {}}) == Scene()
    scene.snow = None
    assert scene.snow == Snow()
    assert isinstance(Scene(method="slide").numerics, SlideSettings)


def test_settings_must_suit_the_method():
    with pytest.raises(InputError, match="'mpm' takes MpmSettings, not SlideSettings"):
        Scene.preset("lab-50").set("numerics", SlideSettings(friction=0.2))
    with pytest.raises(InputError, match="'mpm' takes MpmSettings, not SlideSettings"):
        Scene(numerics=SlideSettings())
    scene = Scene(numerics=MpmSettings(dx=0.02))
    with pytest.raises(InputError, match=r"^Scene\.method: .* set numerics to None first"):
        scene.method = "slide"
    scene.numerics = None
    scene.method = "slide"
    assert isinstance(scene.numerics, SlideSettings)


def test_the_repr_shows_differences_from_the_defaults():
    scene = Scene(
        dimension=2, panel=Panel(height=1.5, length=4.0), slab=Slab(thickness=0.2, layers=[])
    )
    scene.snow.cohesion = 0.2  # the default
    assert repr(scene) == (
        "Scene(\n    dimension=2,\n    panel=Panel(height=1.5, length=4),\n"
        "    slab=Slab(thickness=0.2),\n)"
    )
    assert repr(Scene()) == "Scene()"
    assert repr(Panel(tilt=40)) == "Panel(tilt=40)"


def test_evaluating_the_repr_gives_the_same_scene():
    import snowshed

    scene = Scene.preset("lab-50").with_(dimension=2)
    scene.append("obstacles", Obstacle(name="post", shape=Shape.box((0.5, 0.1), (0.1, 0.2))))
    evaluated = eval(repr(scene), {name: getattr(snowshed, name) for name in snowshed.__all__})
    assert evaluated.resolve() == scene.resolve()


def test_run_begins_the_next_event():
    scene = Scene.preset("lab-50").update(
        {
            "dimension": 2,
            "numerics.dx": 0.02,
            "events": {"count": 2, "max_time": 0.02, "rest_time": 0.02},
        }
    )
    simulation = Simulation(scene)
    assert simulation.run(until=0.005) == "reached"
    assert simulation.event == 1
    assert [simulation.run(), simulation.run()] == ["time_limit", "time_limit"]
    assert simulation.event == 2
    with pytest.raises(SimulationError, match="all 2 events have ended"):
        simulation.run()
