"""JSON with a repeated key, in every reader of JSON."""

import json

import click
import pytest
from conftest import tiny_scene

from snowshed import InputError, ResolvedScene, Scene, Snow, _core
from snowshed.cli.options.scene import json_object
from snowshed.io.json_file import parse_object
from snowshed.io.json_text import loads

TWICE = [
    ('{"a": 1, "a": 1}', "/a", 1),
    ('{"a": 1,\n\n"\\u0061": 2}', "/a", 3),
    ('{"a": [{}, [], {"b": "},\\"b\\": ",\n"b": {}}]}', "/a/2/b", 2),
    ('[[{"x": 1}, {"x": {"y": 1}, "z/~": [],\r\n"z/~": 0}]]', "/0/1/z~1~0", 2),
    ('{"a": {"b": 1}, "c": {"b": 1}, "d": "e", "e": "d", "c": 2}', "/c", 1),
]


@pytest.mark.parametrize(("text", "path", "line"), TWICE)
def test_a_repeated_key_is_refused_with_path_and_line(text, path, line):
    for encoded in (text, text.encode(), text.encode("utf-16")):
        with pytest.raises(ValueError, match="appears twice") as error:
            loads(encoded)
        assert str(error.value) == f"{path}: this key appears twice, the second time in line {line}"


def test_unique_keys_are_read_as_json_reads_them():
    text = json.dumps(tiny_scene().resolve().data)
    assert loads(text) == json.loads(text)
    assert loads('{"a": {"a": [{"a": 1}, {"a": 1}]}}') == {"a": {"a": [{"a": 1}, {"a": 1}]}}
    with pytest.raises(ValueError, match="line 1"):
        loads("{")


@pytest.mark.parametrize("read", [Scene.load, ResolvedScene.load, Snow.load])
def test_files_with_a_repeated_key_are_refused(tmp_path, read):
    file = tmp_path / "a.json"
    text = json.dumps(tiny_scene().resolve().data["snow"])
    if read is Snow.load:
        file.write_text(text[:-1] + ',\n "density": 300}')
        position = "/density"
    else:
        scene = tiny_scene().resolve().json.replace(text, "")
        file.write_text(scene.replace('"density":', '"density": 1,\n "density":', 1))
        position = "/snow/density"
    with pytest.raises(InputError, match=rf"{position}: this key appears twice, .*line \d+"):
        read(file)


def test_texts_with_a_repeated_key_are_refused():
    with pytest.raises(InputError, match=r"run\.json: damaged: /a/b: this key appears twice"):
        parse_object('{"a": {"b": 1, "b": 1}}', "run.json")
    with pytest.raises(
        InputError, match=r"/panel: this key appears twice, the second time in line 2"
    ):
        _core.ParsedScene.parse('{"snowshed": 2, "panel": {},\n"panel": {}}')
    with pytest.raises(click.BadParameter, match=r"/tilt: this key appears twice"):
        json_object('{"tilt": 1, "tilt": 2}')
