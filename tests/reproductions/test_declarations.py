"""Every reproduction is declared in full, under its name and under its former one."""

import doctest
import importlib
import pkgutil

import pytest
import reproductions
from helpers.pages import Page
from reproductions.common.command import command_of
from reproductions.common.report import write_report
from reproductions.hagenmuller2015.snows import Samples

from snowshed.cli.commands.reproduce import PUBLICATIONS, reproduce

MODULES = [
    one.name
    for one in pkgutil.walk_packages(reproductions.__path__, "reproductions.")
    if not one.name.endswith("__main__")
]
NAMES = [name for name, _, _ in PUBLICATIONS]
NO_OPTIONS = {
    "frischholz2023": {"table": None, "condition": "separate", "scheme": "thesis"},
}
#: Settings that take less time than those of the smallest size.
SMALLER = {"hagenmuller2015": Samples(40, 1)}


def declaration_of(name):
    return importlib.import_module(f"reproductions.{name}.publication").REPRODUCTION


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings(name):
    assert doctest.testmod(importlib.import_module(name)).failed == 0


def test_every_package_is_a_command_with_a_former_name():
    folders = {one.name for one in pkgutil.iter_modules(reproductions.__path__) if one.ispkg}
    assert folders - {"common"} == set(NAMES)
    for name, former, _ in PUBLICATIONS:
        assert (declaration_of(name).name, declaration_of(name).alias) == (name, former)
        assert {name, former} <= set(reproduce.commands)
        assert [one.opts for one in command_of(name, former).params] == [
            one.opts for one in command_of(name, name).params
        ]


@pytest.mark.parametrize("name", NAMES)
def test_sections_are_of_stages_and_every_claim_is_declared_once(name, tmp_path):
    one = declaration_of(name)
    texts = [(claim.source, claim.text, claim.rule) for claim in one.claims]
    assert len(set(texts)) == len(texts) > 8
    settings = one.sizes[-1].settings
    work = one.stages(tmp_path / "full", settings, **NO_OPTIONS.get(name, {}))
    stages = {stage.name for stage in work.stages}
    assert {stage for section in one.sections for stage in section.stages} <= stages
    assert len({section.name for section in one.sections}) == len(one.sections)


@pytest.mark.parametrize("name", NAMES)
def test_rules_stand_in_the_report_before_anything_is_computed(name, tmp_path):
    one = declaration_of(name)
    size = one.sizes[0]
    settings = SMALLER.get(name, size.settings)
    work = one.stages(tmp_path, settings, **NO_OPTIONS.get(name, {}))
    judged = write_report(one, size, tmp_path, work)
    rules = {(claim.source, claim.text, claim.rule) for claim in one.claims}
    assert {(claim.source, claim.text, claim.rule) for claim in judged} <= rules
    text = " ".join(Page(one.report(tmp_path).read_text(encoding="utf-8")).text)
    assert all(claim.rule in text for claim in one.claims)
    assert all(section.title in text for section in one.sections)
