"""The guide describes every function of the vocabulary."""

import pytest
from helpers.paths import ROOT

from snowshed.scene.lua.limits import LuaLimits
from snowshed.scene.lua.vocabulary import SHAPES, SYMBOLS, WORDS

DOCS = (ROOT / "docs" / "guides" / "lua.md").read_text()


@pytest.mark.parametrize("word", WORDS)
def test_the_guide_has_every_word(word):
    assert any(f"`{word}{opening}" in DOCS for opening in (" ", "("))


@pytest.mark.parametrize("name", [*SHAPES, *SYMBOLS])
def test_the_guide_has_every_shape_and_symbol(name):
    assert any(f"`{name}{end}" in DOCS for end in ("`", " "))


def test_the_guide_has_the_limits():
    limits = LuaLimits()
    for text in (
        f"{limits.instructions // 10**6} million instructions",
        f"{limits.memory_bytes >> 20} MB of memory",
        f"{limits.calls // 1000} 000 calls",
        f"{limits.soft_seconds:g} s of processor time",
        f"{limits.hard_seconds:g} s of processor time, {limits.wall_seconds:g} s by the clock",
        f"{limits.script_bytes >> 20} MB of text a script, {limits.printed_lines} printed lines",
    ):
        assert text in DOCS
