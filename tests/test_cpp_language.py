"""Comments, texts and names of the C++ sources follow the rules of the Python package."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from helpers.paths import ROOT
from test_language import CONSTRUCTIONS, OPENINGS

FOLDERS = ("snowshed", "bindings", "apps", "vdb")
#: Sources of which the strings are free: tests quote messages and damaged files.
TOOLS = ("tests", "bench", "fuzz")
#: Locals, members and functions with these names say nothing about their values.
EMPTY_NAMES = {"found", "kept", "whole", "there", "way"}
#: The same in tests, which compare an actual value with an expected one.
EMPTY_NAMES_IN_TESTS = {"told", "said", "seen", "story", "place", "places"}
EMPTY_NAMES_IN_TESTS |= {"got", "wanted", "worst"}
#: A test is read after its suite: `Forces.ABentBondBreaksFirstAtItsOuterPairs`.
TEST = re.compile(r"\b(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\s*\)")
#: Names of tests that are no sentences, or that need a second reading.
RIDDLES = re.compile(
    r"^(Of|That|What|Which|Whose|How)[A-Z]"
    r"|(Is|Are)(Told|That|Those)(?![a-z])|(And|Or)Told|(Goes|Go)On(?![a-z])"
    r"|What(It|They|Is|Are)[A-Z]|As(ItWas|TheyWere|TheyAre)|Whoever|However[A-Z]|ThereIs(None)?$"
)
#: Constants that limit something are called max_… and min_….
LIMITS = re.compile(
    r"\bconstexpr\b[^=;(){}]*"
    r"\b((?:most|least|largest|longest|smallest|shortest|deepest|highest)(?:_\w+)?)\b"
)
#: Trailing comments are fragments, and begin in lower case.
FRAGMENTS = re.compile(r"(of|what|that|how|which|whose|where to) ")
TOKEN = re.compile(
    r'R"(?P<mark>[^(\s]*)\((?P<raw>.*?)\)(?P=mark)"'
    r'|"(?P<text>(?:\\.|[^"\\\n])*)"'
    r"|'(?:\\.|[^'\\\n])+'"
    r"|//+<?(?P<line>[^\n]*)"
    r"|/\*(?P<block>.*?)\*/",
    re.DOTALL,
)
SENTENCE_END = re.compile(r"(?<=[.;:]) (?=[A-Z])")


class Text(NamedTuple):
    """A comment or a string, with adjacent lines joined."""

    line: int
    text: str
    is_comment: bool


def texts(source: str) -> Iterator[Text]:
    """Yield the comments and strings of a source; adjacent ones are one text."""
    last, end, column = None, 0, 0
    for token in TOKEN.finditer(source):
        comment = token["line"] if token["line"] is not None else token["block"]
        text = comment if comment is not None else token["raw"] or token["text"]
        if text is None:
            continue
        between = source[end : token.start()]
        above, column = column, token.start() - source.rfind("\n", 0, token.start())
        joins = last and last.is_comment == (comment is not None) and not between.strip()
        if joins and comment is None:
            last = last._replace(text=last.text + text)
        elif (
            joins and between.count("\n") == 1 and column == above and last.text and comment.strip()
        ):
            last = last._replace(text=f"{last.text} {' '.join(comment.split())}")
        else:
            if last and last.text:
                yield last
            words = text if comment is None else " ".join(comment.split())
            last = Text(source.count("\n", 0, token.start()) + 1, words, comment is not None)
        end = token.end()
    if last:
        yield last


def sentences(text: Text) -> list[str]:
    """Return the sentences of a comment, or a string as a whole."""
    return SENTENCE_END.split(text.text) if text.is_comment else [text.text]


def sources(folder: str) -> list[Path]:
    return [
        path for end in ("hpp", "cpp") for path in sorted((ROOT / "cpp" / folder).rglob(f"*.{end}"))
    ]


def all_texts(folder: str) -> Iterator[tuple[str, Text]]:
    for path in sources(folder):
        for text in texts(path.read_text(encoding="utf-8")):
            yield f"{path.relative_to(ROOT)}:{text.line}", text


def test_adjacent_lines_are_one_text():
    source = '// What is\n// here.\n//\n// Of it.\nint a;  // of b\nf("let "\n  "go");'
    assert [text for _, text, _ in texts(source)] == ["What is here.", "Of it.", "of b", "let go"]


@pytest.mark.parametrize("folder", FOLDERS + TOOLS)
def test_comments_begin_with_their_subject(folder):
    wrong = [
        f"{position}: {sentence[:80]}"
        for position, text in all_texts(folder)
        if text.is_comment
        for sentence in sentences(text)
        if OPENINGS.match(sentence) or FRAGMENTS.match(sentence)
    ]
    assert wrong == []


@pytest.mark.parametrize("folder", FOLDERS)
def test_texts_begin_with_their_subject(folder):
    wrong = [
        f"{position}: {text.text[:80]}"
        for position, text in all_texts(folder)
        if not text.is_comment and OPENINGS.match(text.text)
    ]
    assert wrong == []


@pytest.mark.parametrize("folder", FOLDERS + TOOLS)
def test_comments_and_texts_need_no_second_reading(folder):
    wrong = [
        f"{position}: …{match[0]}…"
        for position, text in all_texts(folder)
        if " " in text.text and (text.is_comment or folder in FOLDERS)
        for sentence in sentences(text)
        if (match := CONSTRUCTIONS.search(sentence))
    ]
    assert wrong == []


@pytest.mark.parametrize("folder", FOLDERS + TOOLS)
def test_names_say_what_they_hold(folder):
    empty = EMPTY_NAMES | (EMPTY_NAMES_IN_TESTS if folder in TOOLS else set())
    wrong = [
        f"{path.relative_to(ROOT)}: {name}"
        for path in sources(folder)
        for name in sorted(
            set(re.findall(r"\w+", TOKEN.sub(" ", path.read_text(encoding="utf-8"))))
        )
        if name.strip("_") in empty
    ]
    assert wrong == []


def test_names_of_tests_are_sentences():
    wrong = [
        f"{path.relative_to(ROOT)}: {suite}.{name}"
        for path in sources("tests")
        for suite, name in TEST.findall(path.read_text(encoding="utf-8"))
        if RIDDLES.search(name) or len(re.findall("[A-Z]", name)) < 2
    ]
    assert wrong == []


@pytest.mark.parametrize("folder", FOLDERS + TOOLS)
def test_limits_are_called_max_and_min(folder):
    wrong = [
        f"{path.relative_to(ROOT)}: {name}"
        for path in sources(folder)
        for name in LIMITS.findall(TOKEN.sub(" ", path.read_text(encoding="utf-8")))
    ]
    assert wrong == []
