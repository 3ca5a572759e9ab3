"""Every reproduction has a complete declaration, a name and an alias."""

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
    module.name
    for module in pkgutil.walk_packages(reproductions.__path__, "reproductions.")
    if not module.name.endswith("__main__")
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


def test_every_reproduction_is_a_command_and_has_an_alias():
    folders = {
        module.name for module in pkgutil.iter_modules(reproductions.__path__) if module.ispkg
    }
    assert folders - {"common"} == set(NAMES)
    for name, alias, _ in PUBLICATIONS:
        assert (declaration_of(name).name, declaration_of(name).alias) == (name, alias)
        assert {name, alias} <= set(reproduce.commands)
        assert [option.opts for option in command_of(name, alias).params] == [
            option.opts for option in command_of(name, name).params
        ]


@pytest.mark.parametrize("name", NAMES)
def test_sections_refer_to_stages_and_claims_are_unique(name, tmp_path):
    reproduction = declaration_of(name)
    texts = [(claim.source, claim.text, claim.rule) for claim in reproduction.claims]
    assert len(set(texts)) == len(texts) > 8
    settings = reproduction.sizes[-1].settings
    computation = reproduction.stages(tmp_path / "full", settings, **NO_OPTIONS.get(name, {}))
    stages = {stage.name for stage in computation.stages}
    assert {stage for section in reproduction.sections for stage in section.stages} <= stages
    assert len({section.name for section in reproduction.sections}) == len(reproduction.sections)


@pytest.mark.parametrize("name", NAMES)
def test_the_report_states_all_rules_before_any_run(name, tmp_path):
    reproduction = declaration_of(name)
    size = reproduction.sizes[0]
    settings = SMALLER.get(name, size.settings)
    computation = reproduction.stages(tmp_path, settings, **NO_OPTIONS.get(name, {}))
    judged = write_report(reproduction, size, tmp_path, computation)
    rules = {(claim.source, claim.text, claim.rule) for claim in reproduction.claims}
    assert {(claim.source, claim.text, claim.rule) for claim in judged} <= rules
    text = " ".join(Page(reproduction.report(tmp_path).read_text(encoding="utf-8")).text)
    assert all(claim.rule in text for claim in reproduction.claims)
    assert all(section.title in text for section in reproduction.sections)
