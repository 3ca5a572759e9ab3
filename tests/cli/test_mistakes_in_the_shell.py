"""Typical mistakes of scientists in the shell, in scene files and in Lua: none is silent.

Mistakes in Python are in `tests/running/test_mistakes_of_scientists.py`, those with arrays and
tables in `tests/io/test_mistakes_with_data.py`. Tests elsewhere have further ones: options in
``test_cli.py``, rasters in ``test_slide_rasters.py``, scripts in `tests/scene/lua`, study files in
``test_study_file.py``.
"""

import json

import numpy as np
import pytest
from helpers.mistakes import texts_of, texts_of_command

import snowshed
from snowshed import Scene
from snowshed.io import Raster
from snowshed.scene import slide_scene

PANEL = ("panel", "--preset", "lab-50", "--dim", 2, "--dx", 0.01, "--thickness", 0.05)
DRY = ("--dry-run",)
NEW = ("-o", "new")
SCENE = json.dumps(Scene.preset("lab-50").with_({"dimension": 2}).to_data())
STUDY = "[scene]\npreset = 'lab-50'\ndimension = 2\n"

#: Files of the commands below.
FILES = {
    "twice.json": '{"snowshed": 2, "dimension": 2, "dimension": 3}',
    "comma.json": '{"snowshed": 2, "dimension": 2,}',
    "nan.json": '{"snowshed": 2, "gravity": NaN}',
    "comment.json": '{"snowshed": 2} // mine',
    "later.json": '{"snowshed": 3}',
    "upper.json": SCENE.replace('"tilt"', '"Tilt"'),
    "unit.json": SCENE.replace('"tilt": 50.0', '"tilt": "50 deg"'),
    "empty.json": "",
    "list.json": "[]",
    "parameter.toml": f"{STUDY}[axes]\npanel.tlit = [40]\n",
    "table.toml": f"{STUDY}[axis]\npanel.tilt = [40]\n",
    "radians.toml": f"{STUDY}[axes]\npanel.tilt = [0.7]\n",
    "twice.toml": f"{STUDY}[axes]\npanel.tilt = [40]\npanel.tilt = [50]\n",
    "range.toml": f"{STUDY}[axes]\npanel.tilt = {{ from = 40, to = 60 }}\n",
    "semicolons.csv": "date;snowfall_m;temperature_c\n2024-12-01;0,2;-3\n",
    "snowfalls.csv": "date,snowfall_m,temperature_c\n2024-12-01,0.2,-3\n",
    "require.lua": "local geometry = require('geometry')\n",
    "syntax.lua": "panel = {\n",
    "nothing.lua": "x = 1\n",
    "endless.lua": "while true do end\n",
    "files.lua": "io.open('data.txt')\n",
    "nil.lua": "local x = heigth + 1\n",
}
SEASON = ("--dim", 2, "--height", 0.8, "--length", 2, "--tilt", 40, "--dx", 0.05, *NEW)
CLEARANCE = ("clearance", "example", "--slope-length", 2, "--tilt", 50, "--dx", 0.1, *NEW)

#: Commands, and what is told of them.
COMMANDS = {
    "misspelled option": ((*PANEL, "--titl", 40, *NEW), "--tilt"),
    "no results folder": (PANEL, "Missing option '-o'"),
    "misspelled preset": (("panel", "--preset", "lab50", *NEW), 'did you mean "lab-50"?'),
    "misspelled command": (("pannel", *NEW), "No such command"),
    "width in 2D": ((*PANEL, "--width", 3, *DRY), "--width has no effect: the scene is 2D"),
    "width of the slab in 2D": (
        (*PANEL, "--slab-width", 3, *DRY), "--slab-width has no effect: the scene is 2D"
    ),
    "between a single event": (
        (*PANEL, "--events", 1, "--between", "reseed", *DRY),
        "--between has no effect: there is a single event",
    ),
    "width of a season in 2D": (
        ("season", "snowfalls.csv", *SEASON, "--width", 3, *DRY), "--width has no effect"
    ),
    "a range twice": (
        (*CLEARANCE, "--range", "friction=0.3:0.5", "--range", "friction=0.4", *DRY),
        "--range: the name friction is given twice",
    ),
    "heights in cm": (
        (*CLEARANCE, "--heights", "100,150", *DRY), "needed: at least one from 0 to 100 m"
    ),
    "a tilt twice": ((*CLEARANCE, "--tilt", "50,50", *DRY), "equal numbers count once"),
    "a condition twice": (
        ("regress", "t.csv", "--where", "seed=1", "--where", "seed=2", *NEW),
        "--where: the name seed is given twice",
    ),
    "an input twice": (
        ("predict", "--input", "snow.cohesion=0.1", "--input", "snow.cohesion=0.2"),
        "--input: the name snow.cohesion is given twice",
    ),
    "tilt in radians": ((*PANEL, "--tilt", 0.87, *DRY), "0.87 degrees is unusual"),
    "height in cm": ((*PANEL, "--height", 330, *DRY), "330 m is unusual"),
    "strength in kPa": (
        (*PANEL, "--preconsolidation-pressure", 7, *DRY), "7 Pa is unusual"
    ),
    "decimal comma": ((*PANEL, "--tilt", "40,5", *NEW), "'40,5' is not a valid float"),
    "slab of less than two cells": (
        ("panel", "--preset", "lab-50", "--dim", 2, "--thickness", 0.015, "--dx", 0.01, *DRY),
        "less than two cells",
    ),
    "a million threads": ((*PANEL, "--threads", 1_000_000, *NEW), "1000000 is outside"),
    "folder with results": ((*PANEL, "-o", "run"), "not empty"),
    "resuming nothing": ((*PANEL, "--resume", *NEW), "nothing to resume"),
    "scene that is not there": (("run", "missing.json", *NEW), "missing.json: no such file"),
    "results folder for a scene": (("run", "run", *NEW), "run"),
    "study for a scene": (("run", "radians.toml", *NEW), "not valid JSON"),
    "scene for a study": (("study", "run", "upper.json", *NEW), "upper.json"),
    "key twice": (("run", "twice.json", *NEW), "this key appears twice"),
    "comma at the end": (("run", "comma.json", *NEW), "comma.json:1:"),
    "NaN in a scene": (("run", "nan.json", *NEW), "nan.json:1:28: not valid JSON"),
    "comment in a scene": (("run", "comment.json", *NEW), "comment.json:1:"),
    "file of another encoding": (("run", "latin.json", *NEW), "ill-formed UTF-8"),
    "version of the future": (("run", "later.json", *NEW), "not a version that this program reads"),
    "key in upper case": (("run", "upper.json", *NEW), 'did you mean "tilt"?'),
    "unit beside a number": (("run", "unit.json", *NEW), "/panel/tilt"),
    "empty file": (("run", "empty.json", *NEW), "an empty input"),
    "list for a scene": (("run", "list.json", *NEW), "list.json"),
    "misspelled parameter in a study": (
        ("study", "run", "parameter.toml", *NEW), "did you mean tilt?"
    ),
    "misspelled table in a study": (("study", "run", "table.toml", *NEW), "axis: unknown key"),
    "radians in a study": (("study", "run", "radians.toml", *DRY), "0.7 degrees is unusual"),
    "parameter twice in a study": (("study", "run", "twice.toml", *NEW), "not TOML"),
    "range without a step": (("study", "run", "range.toml", *NEW), "either a step or a count"),
    "table of a run": (("study", "export", "run", "-o", "t.csv"), "holds no study"),
    "weather with semicolons": (("season", "semicolons.csv", *SEASON), "semicolons.csv"),
    "slab in a season": (
        ("season", "snowfalls.csv", *SEASON, "--thickness", 0.3), "--thickness has no effect on a"
    ),
    "events in a season": (
        ("season", "snowfalls.csv", *SEASON, "--events", 3), "--events has no effect on a season"
    ),
    "age of bonds that do not sinter": (
        ("season", "snowfalls.csv", *SEASON, "--strength-age", 3),
        "--strength-age has no effect without --sintering",
    ),
    "column of the example's snow": (
        ("clearance", "example", "--slope-length", 4, "--tilt", 60, "--snow-from", "depth", *NEW),
        "--snow-from has no effect with the word example",
    ),
    "empty name of a folder": ((*PANEL, "-o", ""), "the path is empty"),
    "weather that is not there": (("season", "missing.csv", *SEASON), "missing.csv"),
    "stacks of another method": (("compare", "run", "slide"), "holds no events.csv"),
    "view of nothing": (("view", "missing"), "no results"),
    "grid of a slide": (("grid", "slide"), '"slide" has no grid'),
    "maps of a stack": (("maps", "run"), 'the method "mpm" has no maps'),
    "loads that were not recorded": (("loads", "run"), "output.forces"),
    "further slides": (("extend", "slide", "--events", 1, *NEW), "single event"),
    "folder for a record": (("repeat", "run", *NEW), "a folder; give run/run.json"),
    "folder without a record": (("repeat", ".", *NEW), "a folder; give the record of a result"),
    "record that is none": (("repeat", "upper.json", *NEW), "no record of a run"),
    "script that is not there": (("lua", "missing.lua", *NEW), "missing.lua"),
    "required script that is not there": (
        ("lua", "require.lua", *NEW), "there is no geometry.lua beside the script"
    ),
    "wrong syntax in a script": (("lua", "syntax.lua", *NEW), "syntax.lua:2:"),
    "script without a scene": (("lua", "nothing.lua", *NEW), "there is no snow"),
    "endless script": (("lua", "endless.lua", *NEW), "stopped after"),
    "script that opens files": (("lua", "files.lua", *NEW), "io is not available"),
    "misspelled name in a script": (("lua", "nil.lua", *NEW), "heigth"),
}  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the files, a run and a slide."""
    place = tmp_path_factory.mktemp("shell")
    for name, text in FILES.items():
        (place / name).write_text(text)
    (place / "latin.json").write_bytes('{"snowshed": 2, "title": "für"}'.encode("latin-1"))
    short = Scene.preset("lab-50").with_({"dimension": 2, "numerics.dx": 0.02, "events.count": 1})
    short.set("events.max_time", 0.05)
    texts_of(lambda: snowshed.run(short, place / "run", pictures=False))
    hill = Raster(np.repeat([np.linspace(60.0, 0.0, 41)], 21, axis=0), 0.0, 0.0, 5.0)
    geometry = pytest.importorskip("shapely.geometry")
    scene = slide_scene(hill, geometry.box(20, 30, 60, 70), thickness=0.5)
    scene.set("events.max_time", 0.5)
    texts_of(lambda: snowshed.run(scene, place / "slide", pictures=False))
    return place


@pytest.mark.parametrize("mistake", COMMANDS)
def test_a_command_that_is_a_mistake_is_told(mistake, folder, monkeypatch):
    if COMMANDS[mistake][0][0] == "lua":
        pytest.importorskip("lupa")
    monkeypatch.chdir(folder)
    arguments, expected = COMMANDS[mistake]
    texts = texts_of_command(arguments)
    assert any(expected in text for text in texts), texts
    assert not (folder / "new").exists()
