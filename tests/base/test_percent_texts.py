"""Shares are written in percent by one function, which never writes 1e+02 %."""

import re

import pytest
from helpers.paths import ROOT

FOLDERS = ("python", "validation", "reproductions")
FILES = [file for name in FOLDERS for file in (ROOT / name).rglob("*.py") if file.is_file()]
#: Few significant digits, of which 100 has one more than two.
ROUNDED = re.compile(r"\{[^{}]*:\.[12]g\}\s?%")


@pytest.mark.parametrize("folder", FOLDERS)
def test_no_percentage_is_rounded_to_powers_of_ten(folder):
    files = [file for file in FILES if file.is_relative_to(ROOT / folder)]
    assert files
    found = {str(file): ROUNDED.findall(file.read_text(encoding="utf-8")) for file in files}
    assert {name: texts for name, texts in found.items() if texts} == {}
