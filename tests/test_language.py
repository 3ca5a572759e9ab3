"""Words and names: texts are read once, and one concept has one word."""

import ast
import inspect
import io
import re
import tokenize

import click
import pytest
from helpers.paths import DOCS, ROOT

from snowshed.cli.deferred import Deferred
from snowshed.cli.main import cli

PACKAGE = ROOT / "python" / "snowshed"
#: Rooms outside the package.
OUTSIDE = ("reproductions", "validation", "benchmarks", "examples", "tools", "tests")
#: Rooms whose names and texts follow the rules.
CLEAN = ("base", "io", "methods", "scene", "snow", "plot", "results", "running", "season", "study")
CLEAN += ("analysis", "cli", *OUTSIDE)
#: Sources that quote forbidden texts: the rules, and tests of former spellings.
QUOTING = ("tests/test_language.py", "tests/test_cpp_language.py", "tests/test_docs.py")
QUOTING += ("tests/cli/test_cli.py", "cli/options/common.py", "cli/main.py")
#: Names that say nothing about their values.
EMPTY_NAMES = {"found", "one", "way", "kept", "places"}
EMPTY_NAMES |= {"ready", "told", "said", "lies", "whole", "made"}

#: Names of limits that are not `max_` or `min_`.
SUPERLATIVES = re.compile(
    r"_?(MOST|LEAST|LARGEST|LONGEST|SMALLEST|SHORTEST|HIGHEST|LOWEST|DEEPEST|WIDEST|FEWEST)(_|$)"
    r"|_?(most|least)_"
)
#: Names of columns in stored tables.
STORED_NAMES = {"most_seeds"}

#: First words of descriptions that begin with their object or a relative clause.
OPENINGS = re.compile(r"(Of|What|By|That|How|Which|Whose|Where to) ")
#: Constructions that need a second reading.
CONSTRUCTIONS = re.compile(
    "|".join(
        (
            r"\bfor want of\b",
            r"\bnobody knows\b",
            r"\bnobody (listens|reads|writes|entered|can guess)\b",
            r"\bso-manieth\b",
            r"\blets? go\b",
            r"\bwhoever\b",
            r"\b(is|are) to be\b",
            r"\bif it likes\b",
            r"\bat hand\b",
            r"\bnone (of|that)\b.*\bis read\b",
            r"\bare (?-i:none)\b",
            r"\ball but\b",
            r"\bbut for\b",
            r"\bby what\b",
            r"\bwhat (is|are|was|were|has|have) (known|asked|wanted|left|there)\b",
            r"\bwhat stands\b",
            r"\bone more of\b",
            r"\bis no (list|number|table|archive)\b",
            r"\bas far as (it|they) (is|are)\b",
            r"\bin words\b",
            r"\bhangs? on\b",
            r"\btells? nobody\b",
            r"\bit says so\b",
            r"\b(?-i:Compared|Printed|Measured|Shown|Told|Read) (are|is)\b",
            r", for (there|it|they|we)\b",
            r"\botherwise than\b",
            r"\bas far as .* tells?\b",
            r"\ball this if\b",
            r"\bstays? what (it|they) (was|is|were|are)\b",
            r"\ba(fresh|new)\b",
        )
    ),
    re.IGNORECASE,
)
#: The same for pages, most of which describe methods.
IN_PAGES = re.compile(
    r"\bfor want of\b|\bnobody knows\b|\bso-manieth\b|\blets? go\b|\bwhoever\b|\bif it likes\b"
    r"|\b(is|are) to be\b|\b(Compared|Printed|Measured|Shown|Told|Read) are\b|\bby what\b"
    r"|\bstays? what (it|they) (was|is|were|are)\b|\botherwise than\b|\ba(fresh|new)\b"
)
SECTION = re.compile(r"^(Parameters|Attributes|Returns|Yields|Raises|Examples|Notes)\n-+$", re.M)


def sources(rooms=CLEAN):
    folders = [ROOT if room in OUTSIDE else PACKAGE for room in rooms]
    return [
        path
        for folder, room in zip(folders, rooms)
        for path in sorted((folder / room).rglob("*.py"))
    ]


def name_of(path):
    return path.relative_to(PACKAGE if path.is_relative_to(PACKAGE) else ROOT).as_posix()


def bound_names(tree):
    """Yield line and name of all assignments, loop variables, parameters and functions."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg
        elif isinstance(node, ast.FunctionDef):
            yield node.lineno, node.name.strip("_")


@pytest.mark.parametrize("room", CLEAN)
def test_limits_are_named_max_and_min(room):
    wrong = [
        f"{name_of(path)}:{line}: {name}"
        for path in sources([room])
        for line, name in bound_names(ast.parse(path.read_text(encoding="utf-8")))
        if SUPERLATIVES.match(name) and name not in STORED_NAMES
    ]
    assert wrong == []


@pytest.mark.parametrize("room", CLEAN)
def test_names_say_what_they_hold(room):
    wrong = [
        f"{name_of(path)}:{line}: {name}"
        for path in sources([room])
        for line, name in bound_names(ast.parse(path.read_text(encoding="utf-8")))
        if name in EMPTY_NAMES
    ]
    assert wrong == []


def paragraphs(doc):
    """Yield the summary and the descriptions of a numpydoc docstring, a paragraph each."""
    parts = SECTION.split(inspect.cleandoc(doc))
    yield from re.split(r"\n\s*\n", parts[0])
    for section, body in zip(parts[1::2], parts[2::2]):
        if section != "Examples":
            yield from re.findall(r"(?:^ {4}.*\n?)+", body, re.MULTILINE)


def docstrings(path, tree):
    """Yield line and text of every paragraph in docstrings."""
    for node in ast.walk(tree):
        kinds = (ast.Module, ast.ClassDef, ast.FunctionDef)
        doc = ast.get_docstring(node, clean=False) if isinstance(node, kinds) else None
        if doc:
            for text in paragraphs(doc):
                yield getattr(node, "lineno", 1), " ".join(text.split())


def literals(tree):
    """Yield line and text of every string with several words, docstrings and f-strings, too."""
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            pieces = (str(v.value) if isinstance(v, ast.Constant) else "…" for v in node.values)
            yield node.lineno, "".join(pieces)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, " ".join(node.value.split())


def comments(source):
    """Yield line and text of every comment; adjacent lines are one text."""
    text, begin, last = "", 0, -1
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            line, words = token.start[0], token.string.lstrip("#:").strip()
            if line == last + 1:
                text = f"{text} {words}"
            else:
                if text:
                    yield begin, text
                text, begin = words, line
            last = line
    if text:
        yield begin, text


def test_adjacent_comments_are_one_text():
    source = "#: The stack is seeded\n#: anew.\na = 1\nb = 2  # m\n"
    assert list(comments(source)) == [(1, "The stack is seeded anew."), (4, "m")]


def help_texts(command, name):
    """Yield the name and the help of every option and command that is listed."""
    command = command.load() if isinstance(command, Deferred) else command
    yield name, command.help or ""
    for option in command.params:
        if isinstance(option, click.Option) and not option.hidden:
            yield f"{name} {option.opts[0]}", option.help or ""
    if isinstance(command, click.Group):
        for child_name, child in command.commands.items():
            if not child.hidden and child_name != "reproduce":
                yield from help_texts(child, f"{name} {child_name}")


@pytest.mark.parametrize("room", CLEAN)
def test_docstrings_begin_with_their_subject(room):
    wrong = [
        f"{name_of(path)}:{line}: {text[:80]}"
        for path in sources([room])
        for line, text in docstrings(path, ast.parse(path.read_text(encoding="utf-8")))
        if OPENINGS.match(text)
    ]
    assert wrong == []


@pytest.mark.parametrize("room", CLEAN)
def test_texts_need_no_second_reading(room):
    wrong = [
        f"{name_of(path)}:{line}: …{match[0]}…"
        for path in sources([room])
        if name_of(path) not in QUOTING
        for line, text in [
            *literals(ast.parse(path.read_text(encoding="utf-8"))),
            *comments(path.read_text(encoding="utf-8")),
        ]
        if (match := CONSTRUCTIONS.search(text)) and " " in text
    ]
    assert wrong == []


def test_the_help_begins_with_its_subject_and_needs_no_second_reading():
    wrong = [
        f"{name}: {text}"
        for name, text in help_texts(cli, "snowshed")
        if CONSTRUCTIONS.search(text) or OPENINGS.match(text)
    ]
    assert wrong == []


def test_units_in_the_help_are_in_brackets():
    unit = re.compile(r"(,|\bin) (m|cm|mm|s|h|Pa|kPa|degrees|kg/m3|m/s|pixels)(?=[.;:,)]|$)")
    assert [item for item in help_texts(cli, "snowshed") if unit.search(item[1])] == []


def prose(page):
    """Return the paragraphs of a page without code, by line."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    return [re.sub(r"`[^`]*`", "`…`", part) for part in re.split(r"\n\s*\n", text)]


PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md")), *sorted(ROOT.glob("lua_compat/*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_pages_need_no_second_reading(page):
    wrong = [match[0] for part in prose(page) for match in IN_PAGES.finditer(part)]
    assert wrong == []


def former_words():
    """Return the former words of the glossary, by the term that replaces them."""
    (page,) = DOCS.rglob("glossary.md")
    rows = re.findall(r"^\| ([^|]+) \| [^|]+ \| ([^|]*)\|$", page.read_text("utf-8"), re.MULTILINE)
    return {word: term for term, cell in rows for word in re.findall(r"`([^`]+)`", cell)}


def in_former_words(texts):
    """Return the former words in texts, each with the name of its text and the present term."""
    former = former_words()
    longest_first = sorted(map(re.escape, former), key=len, reverse=True)
    any_word = re.compile(rf"(?<![\w-])(?:{'|'.join(longest_first)})(?![\w-])")
    return [
        f"{name}: {match[0]} (write: {former[match[0]]})"
        for name, text in texts
        if any(word in text for word in former)  # faster than the expression
        for match in any_word.finditer(text)
    ]


def test_one_concept_has_one_word():
    former = former_words()
    assert former["snowshed verify"] == "self-test" and former["--plan"] == "dry run"
    assert in_former_words([("page", "Then\nthe stack is seeded anew.")])
    texts = [(name, text) for name, text in help_texts(cli, "snowshed")]
    texts += [
        (f"{name_of(path)}:{line}", text)
        for path in sources()
        if name_of(path) not in QUOTING
        for line, text in [
            *literals(ast.parse(path.read_text(encoding="utf-8"))),
            *comments(path.read_text(encoding="utf-8")),
        ]
    ]
    assert in_former_words(texts) == []


def test_pages_use_the_words_of_the_glossary():
    pages = [page for page in PAGES if page.name not in ("glossary.md", "renamed.md")]
    pages += sorted(ROOT.glob("lua_compat/*/*.lua"))
    texts = [(page.name, " ".join(page.read_text(encoding="utf-8").split())) for page in pages]
    assert in_former_words(texts) == []
