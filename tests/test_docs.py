"""The pages: their names and files exist, their examples run, and they begin with their purpose.

Studies, structures and predictions have their own tests.
"""

import json
import pkgutil
import re
import shlex
from pathlib import Path

import click
import pytest
from helpers.paths import DOCS, ROOT
from validation.framework.command import validate

from snowshed import Scene
from snowshed.cli.commands.reproduce import reproduce
from snowshed.cli.deferred import Deferred
from snowshed.cli.main import cli

PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]
#: Pages that a program writes, which may be long; their content is tested with the program.
GENERATED = {
    *("trust/thesis-claims.md", "trust/thesis-schemes.md", "trust/thesis-gap.md"),
    "develop/list-of-faults.md",
    "reference/api.md",
}
WRITTEN = [page for page in PAGES if page.relative_to(ROOT).as_posix()[5:] not in GENERATED]
MAX_LINES, MAX_LINES_README = 250, 120
#: Programs that the documentation starts, and the command behind each.
PROGRAMS = {
    "snowshed": cli,
    ".venv/bin/snowshed": cli,
    "python -m validation": validate,
    "python -m reproductions": reproduce,
}
#: Pages that list all options of a command.
PAGE_BY_COMMAND = {
    "sensitivity": "guides/sensitivity.md",
    "calibrate": "guides/calibration.md",
    "geometry": "guides/prediction.md",
    "regress": "guides/prediction.md",
    "predict": "guides/prediction.md",
}
# These settings let an example take a second.
SHORTER = {
    '"numerics.dx": 0.02,': '"numerics.dx": 0.02, "events.count": 1, "events.max_time": 0.1,',
    '"numerics.dx": 0.03}': '"numerics.dx": 0.03, "events.max_time": 0.1}',
}


def page_name(page):
    return page.relative_to(ROOT).as_posix()


def blocks(page, language):
    text = (ROOT / page).read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.M | re.S)


def documented():
    """Yield the program and the arguments of each command line in shell blocks and sentences."""
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        scripts = "\n".join(re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S))
        lines = scripts.replace("\\\n", " ").splitlines()
        lines += re.findall(r"`((?:snowshed|python -m) [a-z][^`\n]*)`", text)
        for line in lines:
            words = shlex.split(line, comments=True)
            length = 3 if words[:2] == ["python", "-m"] else 1
            program, arguments = " ".join(words[:length]), words[length:]
            if program in PROGRAMS:
                yield pytest.param(program, arguments, id=f"{page.stem}: {' '.join(words)}")


def resolve_command(program, words):
    """Return the command that words name, and its arguments."""
    command, arguments = PROGRAMS[program], list(words)
    while isinstance(command, click.Group) and arguments:
        command = command.commands[arguments.pop(0)]
        while isinstance(command, Deferred):
            command = command.load()
    return command, arguments


@pytest.mark.parametrize(("program", "words"), list(documented()))
def test_documented_commands_and_their_options_exist(program, words):
    if words and words[0].startswith("-") and PROGRAMS[program] is cli:
        return
    command, arguments = resolve_command(program, [word for word in words if word != "..."])
    if command.name == "self-test":  # its former options name their replacements
        assert not arguments
    command.make_context("documented", arguments, resilient_parsing=True)


@pytest.mark.parametrize(
    "name", sorted(name for name, command in cli.commands.items() if not command.hidden)
)
def test_every_command_is_on_the_page_of_commands(name):
    page = (DOCS / "reference" / "commands.md").read_text(encoding="utf-8")
    assert re.search(rf"(snowshed |`){name}\b", page)


@pytest.mark.parametrize(("name", "page"), list(PAGE_BY_COMMAND.items()))
def test_every_option_is_on_the_page_of_its_command(name, page):
    text = (DOCS / page).read_text(encoding="utf-8")
    command, _ = resolve_command("snowshed", [name])
    options = [
        max(parameter.opts, key=len)
        for parameter in command.params
        if parameter.param_type_name == "option"
    ]
    assert [option for option in options if not re.search(rf"`{option}[ `]", text)] == []


@pytest.mark.parametrize("page", PAGES, ids=page_name)
def test_links_lead_to_files(page):
    for target in re.findall(r"\]\(([^)#]+)", page.read_text(encoding="utf-8")):
        if not target.startswith(("http", "mailto")):
            assert (page.parent / target).exists(), target


def test_every_page_is_in_the_table_of_contents():
    contents = (DOCS / "index.md").read_text(encoding="utf-8")
    names = {page.relative_to(DOCS).with_suffix("").as_posix() for page in DOCS.rglob("*.md")}
    assert {name for name in names - {"index"} if f"\n{name}\n" not in contents} == set()


@pytest.mark.parametrize("page", WRITTEN, ids=page_name)
def test_no_written_page_is_long(page):
    lines = len(page.read_text(encoding="utf-8").splitlines())
    assert lines <= (MAX_LINES_README if page.name == "README.md" else MAX_LINES)


@pytest.mark.parametrize("page", PAGES, ids=page_name)
def test_a_page_begins_with_a_paragraph(page):
    """A paragraph follows the title: no list, picture, table, code or further heading."""
    title, empty, first, *_ = page.read_text(encoding="utf-8").splitlines()
    assert title.startswith("# ") and not empty
    assert re.match(r"[A-Z*`\[s]", first) and len(first) > 40, first


#: Constructions that need a second reading, and their replacements.
UNCLEAR = {
    r"(^|(?<=\. )|(?<=- ))(What|That|How|Of|By(?! default)) [^?.|]*\.": "begin with the subject",
    r"\bRead are\b|\bTold are\b": "begin with the subject",
    r"\bfor want of\b": "because ... is missing",
    r"\bwhat nobody knows\b": "uncertain",
    r"\bso-manieth\b": "every n-th",
    r"\bgo(es)? on\b": "continue",
    r"\b(none is|is none)\b": "there is no",
    r"\bbut for\b|\bnothing but\b": "except for, only",
    r", for (it|they|the) ": "because",
    r"\b(is|are) told\b": "a note says",
    r"\bin (its|their) stead\b": "instead",
}


#: The glossary lists former words.
@pytest.mark.parametrize(
    "page", [page for page in WRITTEN if page.name != "glossary.md"], ids=page_name
)
def test_sentences_need_no_second_reading(page):
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    text = re.sub(r"(?<=[^\n|]) *\n *(?=[^\s|#*`-])", " ", text)  # a paragraph is one line
    matches = [
        f"{match[0]!r}: {replacement}"
        for construction, replacement in UNCLEAR.items()
        for match in re.finditer(construction, text, re.M)
    ]
    assert matches == []


@pytest.mark.parametrize("page", WRITTEN, ids=page_name)
def test_numbered_formulas_break_lines_with_cr(page):
    """Sphinx puts a formula with a double backslash into an environment that takes no number."""
    formulas = re.findall(r"\$\$.+?\$\$", page.read_text(encoding="utf-8"), re.S)
    assert [formula for formula in formulas if r"\\" in formula and r"\tag" in formula] == []


def test_make_targets_exist():
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M)
    for page in PAGES:
        for target in re.findall(r"^make ([a-z-]+)|`make ([a-z-]+)", page.read_text("utf-8"), re.M):
            assert "".join(target) in targets, (page.name, target)


SCRIPTS = [
    pytest.param(page, script, id=f"{page}-{number}")
    for page in (
        "README.md",
        "docs/guides/python.md",
        "docs/guides/season.md",
        "docs/guides/lua.md",
    )
    for number, script in enumerate(blocks(page, "python"))
]


@pytest.mark.parametrize(("page", "script"), SCRIPTS)
def test_scripts_run(page, script, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    if page == "docs/guides/season.md":
        (tmp_path / "winter.csv").write_text(blocks(page, "text")[0], encoding="utf-8")
    if page == "docs/guides/lua.md":
        init, update, *_ = blocks(page, "lua")
        (tmp_path / "init.lua").write_text(init + "events { max_time = 0.1 }\n", encoding="utf-8")
        (tmp_path / "update.lua").write_text(update, encoding="utf-8")
    for slow, quick in SHORTER.items():
        script = script.replace(slow, quick)
    exec(script, {})


def test_scenes_are_valid():
    for text in blocks("docs/reference/scenes.md", "json"):
        assert Scene.from_data(json.loads(text)).resolve().data["title"]


#: Folders to which the paths in pages are relative.
ABOVE = ("", "python/snowshed/", "cpp/snowshed/", "cpp/snowshed/methods/*/", "reproductions/")
TOP_FOLDERS = {path.name for path in ROOT.iterdir() if path.is_dir()} - {"build"}


def named_files(text):
    """Return the files and folders of the source that a page names."""
    paths = re.findall(r"`([\w.*-]+/[\w./*-]*)`", text)
    suffixes = {".py", ".pyi", ".cpp", ".hpp", ".md"}
    return [p for p in paths if p.split("/")[0] in TOP_FOLDERS or Path(p).suffix in suffixes]


def is_file(path):
    """Return whether the source has a file or folder, or what CMake makes a file from.

    NAME stands for any name.
    """
    pattern = re.sub(r"\bNAME\b", "*", path.rstrip("/"))
    return any(
        True for above in ABOVE for end in ("", ".in") for _ in ROOT.glob(above + pattern + end)
    )


def is_name(name):
    """Return whether a dotted name belongs to a module or to a name in a module."""
    try:
        pkgutil.resolve_name(name)
    except (ImportError, AttributeError):
        return False
    return True


@pytest.mark.parametrize("page", PAGES, ids=page_name)
def test_the_source_has_the_files_and_names_of_a_page(page):
    text = page.read_text(encoding="utf-8")
    names = re.findall(r"`((?:snowshed|validation|reproductions)(?:\.(?!html)[A-Za-z_]\w*)+)", text)
    names += re.findall(r":: (snowshed(?:\.\w+)+)", text)
    assert [path for path in named_files(text) if not is_file(path)] == []
    assert [name for name in names if not is_name(name)] == []
