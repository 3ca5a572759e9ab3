"""Forms that newer versions of Python and of click accept, and the oldest ones do not."""

import ast

from helpers.paths import ROOT

SOURCES = sorted((ROOT / "python" / "snowshed").rglob("*.py"))


def test_class_variables_state_their_type():
    """Python 3.9 cannot resolve a bare ``ClassVar``."""
    bare = [
        f"{path.name}, line {node.lineno}"
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.AnnAssign) and ast.unparse(node.annotation) == "ClassVar"
    ]
    assert bare == []


def test_types_of_click_have_no_parameters():
    """The types of click 8.1, the last for Python 3.9, are not generic."""
    generic = [
        f"{path.name}, line {node.lineno}"
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ClassDef)
        for base in node.bases
        if isinstance(base, ast.Subscript) and ast.unparse(base.value).startswith("click.")
    ]
    assert generic == []
