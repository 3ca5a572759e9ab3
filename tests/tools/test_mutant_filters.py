"""The C++ tests that faults and their results name exist, so that a renamed test is not lost."""

import re
from fnmatch import fnmatchcase

import pytest
from helpers.paths import ROOT
from tools.mutants.faults import read_faults
from tools.mutants.results import Results

DEFINITION = re.compile(r"\b(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\s*\)")
INSTANCE = re.compile(r"\bINSTANTIATE_TEST_SUITE_P\(\s*(\w*),\s*(\w+),")
#: Parameters of tests stand for any that a filter or a result may name.
PARAMETER = re.compile(r"/(\w+)")


def names_of_tests() -> list[str]:
    """Return the full names of all C++ tests; ``#`` is a parameter."""
    text = "\n".join(path.read_text("utf-8") for path in (ROOT / "cpp/tests").rglob("*_test.cpp"))
    prefixes: dict[str, list[str]] = {}
    for prefix, suite in INSTANCE.findall(text):
        prefixes.setdefault(suite, []).append(f"{prefix}/" if prefix else "")
    names = []
    for suite, test in DEFINITION.findall(text):
        names += [f"{suite}.{test}", f"{suite}/#.{test}"]
        names += [f"{prefix}{suite}.{test}/#" for prefix in prefixes.get(suite, [])]
    return names


def matches(pattern: str, names: list[str]) -> bool:
    parameters = {"0", "2D_float_flip_quadratic", *PARAMETER.findall(pattern)}
    return any(
        fnmatchcase(name.replace("#", parameter), pattern)
        for name in names
        for parameter in parameters
    )


@pytest.fixture(scope="module")
def names() -> list[str]:
    return names_of_tests()


def test_every_filter_matches_a_test(names):
    filters = {test for fault in read_faults() for test in fault.tests if test.startswith("cpp:")}
    patterns = {pattern for test in filters for pattern in test[4:].split(":")}
    assert len(patterns) > 50
    assert [pattern for pattern in sorted(patterns) if not matches(pattern, names)] == []


def test_every_result_names_a_test(names):
    caught_by = {test.partition(" (")[0] for test in Results.read().caught_by.values()}
    tests = sorted(test[4:] for test in caught_by if test.startswith("cpp:"))
    assert len(tests) > 50
    assert [test for test in tests if not matches(test, names)] == []


def test_an_unknown_name_matches_nothing(names):
    assert not matches("MessageFormat.NumbersAreLong", names)
    assert matches("MessageFormat.Numbers*", names)
