"""Scripts that require others beside them, and the number of threads."""

import pytest

from snowshed import InputError, ResolvedScene
from snowshed.cli.main import main
from snowshed.scene.lua.loading import load_lua

pytest.importorskip("lupa")


def test_scripts_require_others_beside_them(tmp_path):
    text = "count = (count or 0) + 1 return { rho = 250, times = count }"
    (tmp_path / "snow.lua").write_text(text)
    (tmp_path / "init.lua").write_text(
        'preset "lab-50" dimension(2) local snow = require "snow"\n'
        'material { rho = require("snow").rho } title("read " .. snow.times)'
    )
    (run,) = load_lua(tmp_path / "init.lua")
    assert run.scene.data["snow"]["density"] == 250 and run.scene.data["title"] == "read 1"


@pytest.mark.parametrize(
    ("text", "place"), [("x = = 1", "snow.lua:1"), ("\nerror('no')", "snow.lua:2")]
)
def test_errors_in_required_scripts_name_them(tmp_path, text, place):
    (tmp_path / "snow.lua").write_text(text)
    (tmp_path / "init.lua").write_text('preset "lab-50" require "snow"')
    with pytest.raises(InputError, match=place):
        load_lua(tmp_path / "init.lua")


@pytest.mark.parametrize("name", ["'../secret'", "'/etc/passwd'", "5", "nil"])
def test_nothing_beyond_the_folder_is_required(tmp_path, name):
    (tmp_path / "folder").mkdir()
    (tmp_path / "secret.lua").write_text("return 1")
    (tmp_path / "folder/init.lua").write_text(f'preset "lab-50" require({name})')
    with pytest.raises(InputError, match="require: there is no"):
        load_lua(tmp_path / "folder/init.lua")


def test_the_number_of_threads_is_an_option(tmp_path):
    (tmp_path / "init.lua").write_text('preset "lab-50"')
    assert main(["lua", str(tmp_path / "init.lua"), "--threads", "1", "--to-json",
                 str(tmp_path / "scene.json")]) == 0  # fmt: skip
    assert ResolvedScene.load(tmp_path / "scene.json").data["numerics"]["threads"] == 1
