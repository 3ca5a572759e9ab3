"""Scenes from scripts."""

import json
import re

import numpy as np
import pytest
from helpers.paths import ROOT
from lua_helpers import error_of, load

from snowshed import InputError, Scene, Simulation, SnowshedNote
from snowshed.base.notes import record_notes
from snowshed.scene import load_lua

EXAMPLES = ROOT / "lua_compat" / "examples"
DOCS = (ROOT / "docs" / "guides" / "lua.md").read_text()


def scene_of(folder, init, update=None):
    (run,) = load(folder, init, update)
    return run.scene.data


def test_the_lab_examples_equal_the_presets():
    (at_40,) = load_lua(EXAMPLES / "lab_init.lua")
    (at_50,) = load_lua(EXAMPLES / "lab_init.lua", EXAMPLES / "lab_update.lua")
    assert at_40.scene.data == Scene.preset("lab-40").resolve().data
    assert at_50.scene.data == Scene.preset("lab-50").resolve().data


def test_the_sensitivity_example_covers_the_table_of_the_thesis():
    reference, *others = load_lua(EXAMPLES / "sensitivity_init.lua")
    assert not others
    assert reference.scene.data == Scene.preset("sensitivity").resolve().data

    runs = load_lua(EXAMPLES / "sensitivity_init.lua", EXAMPLES / "sensitivity_update.lua")
    keys = (
        "youngs_modulus",
        "critical_state_slope",
        "preconsolidation_pressure",
        "hardening_factor",
        "cohesion",
    )
    snows = {tuple(run.scene.data["snow"][key] for key in keys) for run in runs}
    assert len(runs) == len(snows) == len({run.name for run in runs}) == 3**5
    assert tuple(reference.scene.data["snow"][key] for key in keys) in snows


def test_the_yard_example_overrides_by_name():
    (before,) = load_lua(EXAMPLES / "yard_init.lua")
    runs = load_lua(EXAMPLES / "yard_init.lua", EXAMPLES / "yard_update.lua")
    assert [run.name for run in runs] == ["friction-0.2", "friction-0.4", "friction-0.8"]
    for run, friction in zip(runs, (0.2, 0.4, 0.8)):
        obstacles = run.scene.data["obstacles"]
        assert [o["friction"] for o in obstacles] == 3 * [friction]
        for obstacle, old in zip(obstacles, before.scene.data["obstacles"]):
            assert {**obstacle, "friction": 0} == {**old, "friction": 0}


def test_every_word_sets_its_part_of_the_scene(tmp_path):
    data = scene_of(
        tmp_path,
        """
        title("All words")
        dimension(2)
        gravity(3.7)
        grid_size(0.02)
        material { rho = 300, E = 2e6, nu = 0.2, M = 0.6, p0 = 3000, beta = 0.15, xi = 0.3 }
        panel { height = 0.5, length = 1, tilt = 45, thickness = 0.1, condition = STICKY }
        slab { thickness = 0.1, length = 0.5 }
        ground { tilt = 5, condition = SLIP, friction = 0.6 }
        domain { min = { -5, -5 }, max = { 5, 5 } }
        levelset {
          shape = transform { union { box { center = { 0, 0 }, size = { 1, 2 } },
                                      capsule { from = { 0, 0 }, to = { 1, 1 }, radius = 0.1 } },
                              angle = 30, translate = { 2, 0 } },
          condition = SEPARATE,
          motion = { velocity = { 1, 0 }, ["end"] = 2 },
        }
        body { name = "ball", shape = sphere { center = { 3, 1 }, radius = 0.2 }, event = 2 }
        seeding { seed = 7 }
        numerics { transfer = "apic" }
        events { count = 2, between = "reseed" }
        frames { interval = 0.25, count = 8 }
        output { energy = true }
        set("numerics.threads", 1)
        append("bodies", { shape = sphere { center = { 3, 2 }, radius = 0.1 } })
        set("bodies.1.event", 1)
        """,
    )
    expected = Scene(title="All words", dimension=2, gravity=3.7).update(
        {
            "numerics": {"dx": 0.02, "transfer": "apic", "threads": 1},
            "snow": {
                "density": 300,
                "youngs_modulus": 2e6,
                "poissons_ratio": 0.2,
                "critical_state_slope": 0.6,
                "preconsolidation_pressure": 3000,
                "cohesion": 0.15,
                "hardening_factor": 0.3,
            },
            "panel": {
                "height": 0.5,
                "length": 1,
                "tilt": 45,
                "thickness": 0.1,
                "condition": "sticky",
            },
            "slab": {"thickness": 0.1, "length": 0.5},
            "ground": {"tilt": 5, "condition": "slip", "friction": 0.6},
            "domain": {"min": [-5, -5], "max": [5, 5]},
            "obstacles": [
                {
                    "shape": {
                        "type": "transform",
                        "angle": 30,
                        "translate": [2, 0],
                        "shapes": [
                            {
                                "type": "union",
                                "shapes": [
                                    {"type": "box", "center": [0, 0], "size": [1, 2]},
                                    {
                                        "type": "capsule",
                                        "from": [0, 0],
                                        "to": [1, 1],
                                        "radius": 0.1,
                                    },
                                ],
                            }
                        ],
                    },
                    "condition": "separate",
                    "motion": {"velocity": [1, 0], "end": 2},
                }
            ],
            "bodies": [
                {"shape": {"type": "sphere", "center": [3, 1], "radius": 0.2}, "event": 2},
                {"shape": {"type": "sphere", "center": [3, 2], "radius": 0.1}, "event": 1},
            ],
            "seeding": {"seed": 7},
            "events": {"count": 2, "between": "reseed", "max_time": 2.0},
            "output": {"snapshot_interval": 0.25, "energy": True},
        }
    )
    assert data == expected.resolve().data


def test_the_last_value_applies(tmp_path):
    data = scene_of(
        tmp_path,
        'preset "lab-50"\nmaterial { M = 0.3, beta = 0.1 }\nangle = 35',
        "panel { tilt = angle }\nmaterial { M = 0.7 }\nground {}",
    )
    expected = Scene.preset("lab-50").update(
        {"panel.tilt": 35, "snow.critical_state_slope": 0.7, "snow.cohesion": 0.1}
    )
    assert data == expected.resolve().data


def test_a_preset_replaces_earlier_settings(tmp_path):
    script = 'levelset { name = "a", friction = 1 } preset "lab-50" material "reference"'
    expected = Scene.preset("lab-50").update({"snow": {"preconsolidation_pressure": 5000}})
    assert scene_of(tmp_path, script) == expected.set("snow.cohesion", 0.1).resolve().data


def test_values_can_be_removed_and_lists_replaced(tmp_path):
    data = scene_of(
        tmp_path,
        """
        preset "lab-50"
        local ball = sphere { center = { 1, 0, 0 }, radius = 0.1 }
        append("obstacles", { name = "a", shape = ball })
        set("obstacles", { { name = "b", shape = ball } })
        levelset { name = "a", shape = ball }
        levelset { name = "b", friction = 0.7 }
        levelset { shape = ball }
        levelset { shape = ball }
        domain { min = { -9, -9, -9 }, max = { 9, 9, 9 } }
        set("domain", nil)
        """,
    )
    assert [o["name"] for o in data["obstacles"]] == ["b", "a", "", ""]
    assert [o["friction"] for o in data["obstacles"]] == [0.7, 0.3, 0.3, 0.3]
    assert "domain" not in data


def test_a_shape_replaces_the_former_shape(tmp_path):
    data = scene_of(
        tmp_path,
        """
        preset "lab-50"
        levelset { name = "a", shape = box { center = { 1, 0, 0 }, size = { 1, 1, 1 } } }
        levelset { name = "a", shape = sphere { center = { 1, 0, 0 }, radius = 0.1 } }
        """,
    )
    assert data["obstacles"][0]["shape"] == {
        "type": "sphere",
        "center": [1, 0, 0],
        "radius": 0.1,
    }


def test_a_script_makes_the_same_scene_every_time(tmp_path):
    script = """
        preset "lab-50"
        local named = {}
        for i = 1, 30 do named["post " .. i] = math.random() end
        for name, x in pairs(named) do
          levelset { name = name, shape = sphere { center = { 1 + x, 0, 0 }, radius = 0.1 } }
        end
    """
    first = scene_of(tmp_path, script)
    assert scene_of(tmp_path, script) == first
    names = [o["name"] for o in first["obstacles"]]
    assert len(names) == 30 and names == sorted(names)


def test_paths_are_relative_to_the_folder_of_the_scripts(tmp_path):
    (tmp_path / "parts").mkdir()
    np.save(tmp_path / "parts" / "heap.npy", np.ones((3, 3, 3)))
    (tmp_path / "parts" / "heap.vdb").touch()
    for word, file, settings in (("grid", "heap.npy", "spacing = 0.1"), ("vdb", "heap.vdb", "")):
        shape = f'{{ file = "parts/{file}", {settings} }}'
        data = scene_of(tmp_path, f'preset "lab-50" body {{ shape = {word}{shape} }}')
        assert data["bodies"][0]["shape"]["type"] == word
        assert data["bodies"][0]["shape"]["file"] == str(tmp_path / "parts" / file)


@pytest.mark.parametrize(
    ("file", "message"),
    [
        ("/dev/zero", "'/dev/zero' is not in the scripts' folder"),
        ("../heap.npy", "'../heap.npy' is not in the scripts' folder"),
        ("parts/../../heap.npy", "is not in the scripts' folder"),
        ("link.npy", "'link.npy' is not in the scripts' folder"),
        ("heap.npy", "there is no file 'heap.npy'"),
    ],
)
def test_files_outside_the_folder_of_the_scripts_are_refused(tmp_path, file, message):
    (tmp_path / "link.npy").symlink_to("/dev/zero")
    script = (
        f'preset "lab-50"\nlocal s = union {{ vdb {{ file = "{file}" }} }}\nbody {{ shape = s }}'
    )
    error = error_of(tmp_path, script)
    assert error.startswith("init.lua:3: /bodies/0/shape/shapes/0/file: ")
    assert message in error


VALID = 'preset "lab-50"\n'


@pytest.mark.parametrize(
    ("init", "update", "message"),
    [
        (VALID + "panel { tilt = 95 }", None, "init.lua:2: /panel/tilt: 95 is outside the allowed"),
        (VALID + "panel { tilt = 95 }", "panel { height = 1 }", "init.lua:2: /panel/tilt: 95"),
        (VALID + "panel { tilt = 40 }", "\n\npanel { tilt = 95 }", "update.lua:3: /panel/tilt"),
        (VALID + "panel {\n  tilt = 40,\n  tlit = 95,\n}", None, "/panel/tlit: unknown key"),
        (VALID + "material {\n  M = -1,\n}", None, "/snow/critical_state_slope: -1 is outside"),
        (VALID + "material { M = 1, critical_state_slope = 1 }", None, "init.lua:2: material has"),
        (VALID + 'material "wet"', None, 'init.lua:2: preset: "wet" is none of'),
        ('\npreset "wet"', None, 'init.lua:2: preset: "wet" is none of'),
        ("preset(4)", None, "init.lua:1: preset needs a name, not 4"),
        (VALID + "panel(4)", None, "init.lua:2: panel needs a table of named values, not 4"),
        (VALID + "panel()", None, "init.lua:2: panel needs 1 argument(s), not 0"),
        (VALID + "set('title')", None, "init.lua:2: set needs 2 argument(s), not 1"),
        (VALID + "set(1, 2)", None, "init.lua:2: set needs a path such as 'snow.density', not 1"),
        (VALID + "set('snow.colour', 2)", None, "init.lua:2: /snow/colour: unknown key"),
        (VALID + "append('title', 2)", "x = 1", "init.lua:2: /title: "),
        (VALID + "frames { interval = 0 }", None, "init.lua:2: frames needs an interval in s"),
        (VALID + "frames { interval = 1, rate = 2 }", None, "init.lua:2: frames needs an interval"),
        (VALID + "frames { interval = 1, count = '9' }", None, "init.lua:2: frames: count is '9'"),
        (VALID + "levelset { name = 4 }", None, "init.lua:2: levelset: name needs a name, not 4"),
        (VALID + "levelset { name = 'a' }", "x = 1", "init.lua:2: /obstacles/0/shape: missing"),
        (VALID + "levelset { shape = box { centre = {0} } }", None, "/shape/centre: unknown key"),
        (
            VALID + "slab { width = 1 }",
            "panel { friction = 1 }",
            "init.lua:2: /slab/width: 1 m is wider than the panel",
        ),
        (VALID + "run '../out'", None, "init.lua:2: run needs a name for its folder"),
        (VALID + "run()", None, "init.lua:2: run needs a name for its folder"),
        (VALID + "run 'a'", "\nrun 'a'", "update.lua:2: there is already a run 'a'"),
        (VALID + "for i = 1, 1001 do run('a' .. i) end", None, "init.lua:2: more than 1000 runs"),
        ("panel { length = 1 }", "run 'a'", "init.lua:1: /panel/height: missing"),
        ("dimension(2)", "gravity(1)", "update.lua: /: there is no snow"),
        ("dimension(2)", "\nrun 'a'", "update.lua:2: /: there is no snow"),
        ("\nmaterail { M = 1 }", None, "init.lua:2: attempt to call a nil value"),
        ("\n\nlocal x =", None, "init.lua:3: unexpected symbol near <eof>"),
        ("x = 1", "\ny = x.z.w", "update.lua:2: attempt to index"),
        ("function f() error('no') end", "\nf()", "init.lua:1: no"),
        ("function f() error('no', 2) end", "\nf()", "update.lua:2: no"),
        ("assert(1 == 2, 'sums')", None, "init.lua:1: sums"),
        ("pairs(4)", None, "init.lua:1: pairs needs a table"),
        ("pairs { [true] = 1 }", None, "init.lua:1: pairs needs keys that are"),
        ("box(4)", None, "init.lua:1: box needs a table of values, not a number"),
    ],
)
def test_errors_name_script_and_line(tmp_path, init, update, message):
    error = error_of(tmp_path, init, update)
    assert message in error
    assert re.match(r"(init|update)\.lua(:[1-9]\d*)?: ", error)


def test_lines_lost_by_a_tail_call_are_left_out(tmp_path):
    assert error_of(tmp_path, "return panel(4)").startswith("init.lua: panel needs a table")


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", DOCS, re.MULTILINE | re.DOTALL)


def test_scripts_in_the_docs(tmp_path, monkeypatch, capsys):
    init, update, loop = blocks("lua")
    (tmp_path / "init.lua").write_text(init)
    (tmp_path / "update.lua").write_text(update)
    (before,) = load_lua(tmp_path / "init.lua")
    (after,) = load_lua(tmp_path / "init.lua", tmp_path / "update.lua")
    assert (before.scene.data["panel"]["tilt"], after.scene.data["panel"]["tilt"]) == (45, 50)
    assert after.scene.data["obstacles"][0]["friction"] == 0.8

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("snowshed.run_events", lambda scene, folder: None)
    exec(*blocks("python"), {})
    assert capsys.readouterr().out == "50.0\n"

    (tmp_path / "update.lua").write_text(loop)
    runs = load_lua(tmp_path / "init.lua", tmp_path / "update.lua")
    assert len(runs) == 9 and runs[-1].name == "M0.7-beta0.3"


def test_errors_in_the_docs_are_real(tmp_path):
    base = VALID + "\n" * 5
    errors = [
        error_of(tmp_path, VALID, "\npanel { tilt = 95 }"),
        error_of(tmp_path, base + "materail {}"),
        error_of(tmp_path, base + "\n\npanel = { tilt = 30 }"),
        error_of(tmp_path, VALID + "\nwhile true do end"),
        error_of(tmp_path, "os.exit()"),
    ]
    shown = next(block for block in blocks("text") if "materail" in block)
    assert shown.splitlines() == [f"error: {error}" for error in errors]


def test_a_scene_from_lua_is_an_ordinary_scene(tmp_path):
    (run,) = load(tmp_path, VALID)
    assert Scene.from_data(json.loads(run.scene.json)).panel.tilt == 50
    with pytest.raises(InputError, match="unknown key"):
        Scene.from_data(run.scene.data).set("lua", 1)


def test_the_volume_of_a_body_gives_its_mass_as_in_the_thesis(tmp_path):
    """A stack of n slabs has n times their volume, whatever the solid has (A.3.5)."""
    init = """
        dimension(2)  grid_size(0.02)  ground {}
        material { rho = 250 }
        V_slab = 0.5 * 0.04
        body { name = "stack", shape = box { center = { 0, 0.1 }, size = { 0.4, 0.2 } },
               volume = 3 * V_slab }
    """
    data = scene_of(tmp_path, init, 'body { name = "stack", volume = 4 * V_slab }')
    (body,) = data["bodies"]
    assert body["volume"] == pytest.approx(4 * 0.5 * 0.04)
    with pytest.warns(SnowshedNote, match="the given volume of 0.08 m2, and the solid one of 0.08"):
        simulation = Simulation(data)
        simulation.begin_event()
    assert simulation.masses().sum() == pytest.approx(250 * 0.08)
    for factor in (1, 5):
        data = scene_of(tmp_path, init, f'body {{ name = "stack", volume = {factor} * V_slab }}')
        simulation = Simulation(data)
        simulation.begin_event()
        assert simulation.masses().sum() == pytest.approx(250 * factor * 0.02)
    error = error_of(tmp_path, init, 'body { name = "stack", volume = -1 }')
    assert "update.lua:1: /bodies/0/volume: -1 is outside the allowed range" in error


@pytest.mark.parametrize("name", ["panel", "dimension", "box"])
def test_a_word_that_is_set_like_a_variable_is_refused(tmp_path, name):
    script = f"preset 'lab-50'\nfriction = 0.1\n{name} = {{ tilt = 20 }}"
    error = error_of(tmp_path, script)
    assert error == f"init.lua:3: {name} = ... sets nothing; call {name}, without the equals sign"


def test_scripts_have_variables_of_their_own(tmp_path):
    data = scene_of(tmp_path, "preset 'lab-50'\nangle = 30", "panel { tilt = _G.angle }")
    assert data["panel"]["tilt"] == 30


@pytest.mark.parametrize("name", ["SEPERATE", "slip", "tlit"])
def test_a_name_without_a_value_is_noted_because_its_setting_is_left_out(tmp_path, name):
    script = f"preset 'lab-50'\npanel {{ condition = {name} }}"
    with pytest.warns(SnowshedNote, match=f"init.lua:2: {name} has no value"):
        load(tmp_path, script)


def test_a_variable_with_a_default_is_not_noted(tmp_path):
    with record_notes() as notes:
        data = scene_of(tmp_path, "tilt = tilt or 30\npreset 'lab-50'", "panel { tilt = tilt }")
    assert data["panel"]["tilt"] == 30
    assert not any("has no value" in note for note in notes)


def test_a_local_variable_that_hides_a_word_is_noted(tmp_path):
    script = "preset 'lab-50'\n-- local slab = {}\nlocal tilt, panel = 30, { tilt = 20 }"
    with pytest.warns(SnowshedNote, match="init.lua:3: the local variable panel hides the word"):
        load(tmp_path, script)
