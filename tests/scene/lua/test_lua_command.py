"""The command ``snowshed lua``, also without Lua."""

import json

import pytest
from helpers.processes import modules_after

from snowshed import Scene, read_events
from snowshed.cli.main import main

TINY = """
preset "lab-50"
dimension(2)
grid_size(0.02)
events { count = 1, max_time = 0.1 }
set("numerics.threads", 1)
print("tilt", 50)
"""


@pytest.fixture
def scripts(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "init.lua").write_text(TINY)
    (tmp_path / "update.lua").write_text("panel { tilt = 40 }")
    (tmp_path / "runs.lua").write_text(
        "for _, t in ipairs { 35, 45 } do panel { tilt = t } run('t' .. t) end"
    )
    return tmp_path


def test_to_json_writes_the_scene_of_the_scripts(scripts, capsys):
    assert main(["lua", "init.lua", "update.lua", "--to-json", "scene.json"]) == 0
    printed, *notes = capsys.readouterr().err.splitlines()
    assert printed == "tilt 50"
    assert notes and all(note.startswith("note: the slab is 20 mm thick") for note in notes)
    expected = Scene.preset("lab-50").update(
        {
            "dimension": 2,
            "numerics": {"dx": 0.02, "threads": 1},
            "events": {"count": 1, "max_time": 0.1},
            "panel.tilt": 40,
        }
    )
    assert json.loads((scripts / "scene.json").read_text()) == expected.resolve().data


def test_to_json_notes_a_tilt_in_radians(scripts, capsys):
    (scripts / "radians.lua").write_text("panel { tilt = math.rad(50) }")
    assert main(["lua", "init.lua", "radians.lua", "--to-json", "scene.json"]) == 0
    assert "note: /panel/tilt: 0.873 degrees is unusual" in capsys.readouterr().err


def test_a_script_that_returns_its_scene_is_refused(scripts, capsys):
    (scripts / "table.lua").write_text("return { panel = { tilt = 50 } }")
    assert main(["lua", "init.lua", "table.lua", "--to-json", "scene.json"]) == 2
    assert "table.lua: the script returns a value, which sets nothing" in capsys.readouterr().err
    assert not (scripts / "scene.json").exists()


def test_a_script_and_its_json_give_the_same_run(scripts, capsys):
    assert main(["lua", "init.lua", "-q", "-o", "a", "--to-json", "scene.json"]) == 0
    assert capsys.readouterr() == ("", "")
    assert main(["run", "scene.json", "-q", "-o", "b"]) == 0
    columns = ["height_m", "length_m", "mass_kg", "steps"]
    assert read_events("a")[columns].equals(read_events("b")[columns])
    assert (scripts / "a" / "stack.png").exists()


def test_named_runs_get_folders_and_resume_starts_missing_runs(scripts, capsys):
    assert main(["lua", "init.lua", "runs.lua", "-o", "out"]) == 0
    assert "run 2 of 2: t45" in capsys.readouterr().out
    tilts = [json.loads((scripts / f"out/t{t}/scene.json").read_text()) for t in (35, 45)]
    assert [scene["panel"]["tilt"] for scene in tilts] == [35, 45]

    assert main(["lua", "init.lua", "runs.lua", "-o", "out"]) == 2
    assert "out: not empty" in capsys.readouterr().err
    (scripts / "out" / "t45").rename(scripts / "elsewhere")
    assert main(["lua", "init.lua", "runs.lua", "-q", "-o", "out", "--resume"]) == 0
    assert len(read_events("out/t35")) == len(read_events("out/t45")) == 1


def test_named_scenes_are_written_to_a_folder(scripts, capsys):
    assert main(["lua", "init.lua", "runs.lua", "--to-json", "scenes"]) == 0
    assert sorted(f.name for f in (scripts / "scenes").iterdir()) == ["t35.json", "t45.json"]
    assert main(["lua", "init.lua", "runs.lua", "--to-json", "init.lua"]) == 2
    assert "--to-json: init.lua is a file" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["init.lua"], "give -o DIR to run the scene, or --to-json FILE"),
        (["none.lua", "-o", "out"], "none.lua: No such file"),
        (["bad.lua", "-o", "out"], "bad.lua:1: os is not available to scene scripts"),
        (["bytes.lua", "-o", "out"], "bytes.lua: not a UTF-8 text"),
        (["init.lua", "bad.lua", "-q", "-o", "out"], "bad.lua:1: os is not available"),
    ],
)
def test_bad_input_gives_one_line_and_no_files(scripts, capsys, arguments, message):
    (scripts / "bad.lua").write_text("os.exit(0)")
    (scripts / "bytes.lua").write_bytes(b"x = '\xff'")
    assert main(["lua", *arguments]) == 2
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1
    assert not (scripts / "out").exists()


def test_without_lupa_the_error_says_what_to_install(scripts, capsys, hide):
    hide("lupa")
    assert main(["lua", "init.lua", "-o", "out"]) == 2
    error = capsys.readouterr().err
    assert "running Lua scripts needs lupa" in error
    assert 'pip install "snowshed[lua]"' in error
    assert main(["scene", "--preset", "lab-50"]) == 0  # everything else works


def test_other_commands_do_not_import_lua():
    modules = modules_after("import snowshed.cli.main")
    assert "snowshed.cli.main" in modules
    assert not [m for m in modules if m.startswith(("lupa", "snowshed.scene.lua"))]
