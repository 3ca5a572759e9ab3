"""The option --quiet: every command that writes files has it."""

import json
from collections.abc import Iterator

import click
import pytest
from helpers.slide_files import plane

from snowshed.cli.deferred import Deferred
from snowshed.cli.main import cli, main
from snowshed.io.raster.raster import write_ascii_grid


def commands(command: click.Command, name: str) -> Iterator[tuple[str, click.Command]]:
    if isinstance(command, Deferred):
        command = command.load()
    if isinstance(command, click.Group):
        for child_name, child in command.commands.items():
            yield from commands(child, f"{name} {child_name}")
    else:
        yield name, command


COMMANDS = dict(commands(cli, "snowshed"))


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_that_writes_can_be_quiet(name):
    options = {option for parameter in COMMANDS[name].params for option in parameter.opts}
    if "--output" in options:
        assert {"-q", "--quiet"} <= options


def test_quiet_commands_print_nothing(tmp_path, capsys):
    scene, raster = tmp_path / "scene.json", tmp_path / "hill.asc"
    write_ascii_grid(raster, plane())
    panel = ["--preset", "lab-50", "--dim", "2"]
    terrain = ["--origin", "40", "40", "--azimuth", "90", "--x", "-1", "2"]
    for arguments in (
        ["scene", *panel, "--accuracy", "20%", "-q", "-o", scene],
        ["structure", "shed-roof", "--eaves", "2.5", "--length", "4", "--tilt", "30", "--snow",
         "0.3", "--dx", "0.05", "-q", "-o", tmp_path / "roof.json"],
        ["structure", "terrain", scene, raster, *terrain, "-q", "-o", tmp_path / "t.json"],
        ["study", "template", "-q", "-o", tmp_path / "study.toml"],
        ["geometry", "--trial", "-q", "-o", tmp_path / "geometry.toml"],
    ):  # fmt: skip
        assert main([str(argument) for argument in arguments]) == 0, capsys.readouterr().err
        assert capsys.readouterr() == ("", "")
    assert json.loads(scene.read_text())["snowshed"] == 2
