"""A scene is text only where it enters and leaves the process, and is parsed once."""

import ast
import copy
import json
import pickle

import pytest
from conftest import tiny_scene
from helpers.paths import ROOT

import snowshed._core as core
from snowshed import ResolvedScene
from snowshed.cli.main import main
from snowshed.scene.scene import resolve_scene

#: Texts that the core gives or takes: scenes, their snow and their schema.
OF_SCENES = {"scene", "json", "snow", "snows", "scene_json", "ready", "resolved", "run", "task"}


def test_only_the_package_of_scenes_parses_them():
    """Elsewhere, `json.loads` reads texts with other names."""
    package = ROOT / "python" / "snowshed"
    wrong = []
    for path in package.rglob("*.py"):
        if path.is_relative_to(package / "scene"):
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ("json.loads", "loads"):
                inside = [child for argument in node.args for child in ast.walk(argument)]
                names = {child.attr for child in inside if isinstance(child, ast.Attribute)}
                names |= {child.id for child in inside if isinstance(child, ast.Name)} - {"json"}
                if names & OF_SCENES:
                    wrong.append(f"{path.relative_to(package)}, line {node.lineno}")
    assert wrong == []


@pytest.fixture
def handled(monkeypatch):
    """The calls that turn scenes into data or into text."""
    calls = []

    def is_scene(value):
        text = value if isinstance(value, str) else ""
        keys = value if isinstance(value, dict) else ()
        return ('"snowshed"' in text and '"numerics"' in text) or "numerics" in keys

    def counted(owner, name, is_counted):
        original = getattr(owner, name)

        def call(*arguments, **options):
            if is_counted(arguments[0]):
                calls.append(name)
            return original(*arguments, **options)

        monkeypatch.setattr(owner, name, staticmethod(call) if isinstance(owner, type) else call)

    for name in ("loads", "dumps"):
        counted(json, name, is_scene)
    for name in ("load", "parse"):
        counted(core.ParsedScene, name, lambda argument: True)
    for name in ("create", "resume"):
        counted(core.EventSequence, name, is_scene)
    for name in ("plan", "expected_work", "scene_checksum", "update_version"):
        counted(core, name, is_scene)
    return calls


@pytest.mark.parametrize("energy", [False, True])
def test_a_run_parses_its_scene_twice(tmp_path, handled, energy):
    """The core reads the file, and Python reads the text that the core completed."""
    scene = tiny_scene(**{"events.count": 2, "output.energy": energy}).resolve()
    scene.save(tmp_path / "scene.json")
    for folder in ("first", "second"):  # the first run reads presets, too
        handled.clear()
        assert main(["run", str(tmp_path / "scene.json"), "-o", str(tmp_path / folder)]) == 0
    assert handled == ["load", "loads"]


def test_data_of_a_scene_is_created_once_and_read_only():
    scene = tiny_scene().resolve()
    assert scene.data is scene.data
    for change in (
        lambda data: data.update(gravity=1.0),
        lambda data: data["panel"].pop("tilt"),
        lambda data: data["obstacles"].append({}),
        lambda data: data.__setitem__("title", ""),
    ):
        with pytest.raises(TypeError, match="read-only"):
            change(scene.data)
    copied = scene.copied_data()
    copied["panel"]["tilt"] = 10.0
    assert scene.data["panel"]["tilt"] == 50.0
    assert json.loads(json.dumps(scene.data)) == json.loads(scene.json) == scene.data


def test_a_scene_is_pickled_and_copied_as_its_text():
    scene = tiny_scene().resolve()
    assert scene.data and scene.core
    for copied in (pickle.loads(pickle.dumps(scene)), copy.deepcopy(scene)):
        assert copied == scene and set(vars(copied)) == {"json", "base_dir"}
    assert core.Simulation(copied.core).event_count == 2
    assert pickle.loads(pickle.dumps(scene.data)) == copy.deepcopy(scene.data) == scene.data


def test_the_core_accepts_a_scene_as_text_too():
    scene = tiny_scene().resolve()
    assert core.Simulation(scene.json).scene == core.Simulation(scene.core).scene == scene.json
    with pytest.raises(core.InputError):
        core.Simulation("{}")
    with pytest.raises(TypeError):
        core.Simulation(5)
    assert resolve_scene(ResolvedScene.parse(scene.json)) == scene
