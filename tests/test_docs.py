"""What the documentation says exists, and its examples run (studies and structures: see there)."""

import json
import re
import shlex

import click
import pytest
from paths import ROOT
from thesis.command import thesis
from validation.command import validate

from snowshed import Scene
from snowshed.cli.deferred import Deferred
from snowshed.cli.main import cli

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
#: Programs that the documentation starts, and the command behind each.
PROGRAMS = {
    "snowshed": cli,
    ".venv/bin/snowshed": cli,
    "python -m validation": validate,
    "python -m thesis": thesis,
}
#: Pages that list all options of a command.
PAGE_OF = {
    "sensitivity": "sensitivity.md",
    "calibrate": "calibration.md",
    "geometry": "regression.md",
    "regress": "regression.md",
    "predict": "regression.md",
}
# So that an example takes a second.
SHORTER = {
    '"numerics.dx": 0.02,': '"numerics.dx": 0.02, "events.count": 1, "events.max_time": 0.1,',
    '"numerics.dx": 0.03}': '"numerics.dx": 0.03, "events.max_time": 0.1}',
}


def blocks(page, language):
    text = (ROOT / page).read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.M | re.S)


def documented():
    """Every command line in a shell block or a sentence: the program, and the words after it."""
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        lines = "\n".join(re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S))
        found = lines.replace("\\\n", " ").splitlines()
        found += re.findall(r"`((?:snowshed|python -m) [a-z][^`\n]*)`", text)
        for line in found:
            words = shlex.split(line, comments=True)
            length = 3 if words[:2] == ["python", "-m"] else 1
            program, rest = " ".join(words[:length]), words[length:]
            if program in PROGRAMS:
                yield pytest.param(program, rest, id=f"{page.stem}: {' '.join(words)}")


def command_of(program, words):
    """The command that words name, and the words after it."""
    command, rest = PROGRAMS[program], list(words)
    while isinstance(command, click.Group) and rest:
        command = command.commands[rest.pop(0)]
        while isinstance(command, Deferred):
            command = command.load()
    return command, rest


@pytest.mark.parametrize(("program", "words"), list(documented()))
def test_documented_commands_and_their_options_exist(program, words):
    if words and words[0].startswith("-") and PROGRAMS[program] is cli:
        return
    command, rest = command_of(program, [word for word in words if word != "..."])
    if command.name == "self-test":  # its former options say where they went
        assert not rest
    command.make_context("documented", rest, resilient_parsing=True)


@pytest.mark.parametrize("name", sorted(n for n, c in cli.commands.items() if not c.hidden))
def test_every_command_is_in_the_user_guide(name):
    guide = (ROOT / "docs" / "user-guide.md").read_text(encoding="utf-8")
    assert re.search(rf"(snowshed |`){name}\b", guide)


@pytest.mark.parametrize(("name", "page"), list(PAGE_OF.items()))
def test_every_option_is_on_the_page_of_its_command(name, page):
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    command, _ = command_of("snowshed", [name])
    options = [
        max(one.opts, key=len) for one in command.params if one.param_type_name == "option"
    ]
    assert [option for option in options if not re.search(rf"`{option}[ `]", text)] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_lead_to_files(page):
    for target in re.findall(r"\]\(([^)#]+)", page.read_text(encoding="utf-8")):
        if not target.startswith(("http", "mailto")):
            assert (page.parent / target).exists(), target


def test_make_targets_exist():
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M)
    for page in PAGES:
        for target in re.findall(r"^make ([a-z-]+)|`make ([a-z-]+)", page.read_text("utf-8"), re.M):
            assert "".join(target) in targets, (page.name, target)


SCRIPTS = [
    pytest.param(page, script, id=f"{page}-{number}")
    for page in ("README.md", "docs/user-guide.md", "docs/season.md", "docs/lua.md")
    for number, script in enumerate(blocks(page, "python"))
]


@pytest.mark.parametrize(("page", "script"), SCRIPTS)
def test_scripts_run(page, script, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    if page == "docs/season.md":
        (tmp_path / "winter.csv").write_text(blocks(page, "text")[0], encoding="utf-8")
    if page == "docs/lua.md":
        init, update, *_ = blocks(page, "lua")
        (tmp_path / "init.lua").write_text(init + "events { max_time = 0.1 }\n", encoding="utf-8")
        (tmp_path / "update.lua").write_text(update, encoding="utf-8")
    for slow, quick in SHORTER.items():
        script = script.replace(slow, quick)
    exec(script, {})


@pytest.mark.parametrize("page", ["docs/user-guide.md"])
def test_scenes_are_valid(page):
    for text in blocks(page, "json"):
        assert Scene.from_data(json.loads(text)).resolve().data["title"]
