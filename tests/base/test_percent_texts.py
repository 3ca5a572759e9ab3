"""Percentages are written by a function that never writes 1e+02 %."""

import re

import pytest
from helpers.paths import ROOT

FOLDERS = ("python", "validation", "reproductions")
FILES = [file for name in FOLDERS for file in (ROOT / name).rglob("*.py") if file.is_file()]
#: Formats of one or two significant digits, in which 100 becomes 1e+02.
ROUNDED = re.compile(r"\{[^{}]*:\.[12]g\}\s?%")


@pytest.mark.parametrize("folder", FOLDERS)
def test_no_percentage_is_rounded_to_powers_of_ten(folder):
    files = [file for file in FILES if file.is_relative_to(ROOT / folder)]
    assert files
    matches = {str(file): ROUNDED.findall(file.read_text(encoding="utf-8")) for file in files}
    assert {name: texts for name, texts in matches.items() if texts} == {}
