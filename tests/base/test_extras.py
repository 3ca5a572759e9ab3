"""Optional libraries: messages if one is missing."""

import ast
import importlib
from pathlib import Path

import pytest
from helpers.paths import ROOT
from helpers.requirements import MODULES_OF, required

from snowshed import InputError
from snowshed.base import extras
from snowshed.base.extras import require

SOURCE = Path(extras.__file__).parents[1]
SOURCES = sorted(SOURCE.rglob("*.py"))
OUTSIDE = sorted((ROOT / "validation").rglob("*.py"))  # of the installed package
OF_USERS = {MODULES_OF[name] for names in required()[1].values() for name in names}
#: Modules that need scikit-learn; the registry of models requires it before it imports them.
ESTIMATORS = {
    SOURCE / "analysis" / "regression" / f"{name}.py"
    for name in (
        "gaussian_process",
        "gradient_boosting",
        "grid_kinds",
        "path_search",
        "support_vectors",
        "svr",
    )
}


def test_an_installed_library_is_imported():
    assert require("math", "study", "adding") is importlib.import_module("math")


def test_a_missing_library_is_named_with_what_needs_it_and_what_brings_it():
    message = (
        r"^counting sheep needs no_such_library, which cannot be imported \(No module named "
        r"'no_such_library'\); install it with: pip install \"snowshed\[validation\]\"$"
    )
    with pytest.raises(InputError, match=message):
        require("no_such_library.meadow", "validation", "counting sheep")


def calls_of_require(source):
    """The required modules and extras, with constants replaced by their values."""
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "require":
            module, extra, _ = node.args
            if isinstance(extra, ast.Name):
                dotted = ".".join(
                    source.relative_to(SOURCE.parent if source in SOURCES else ROOT)
                    .with_suffix("")
                    .parts
                )
                yield module.value, getattr(importlib.import_module(dotted), extra.id)
            else:
                yield module.value, extra.value


def test_every_optional_library_is_asked_for_with_the_extra_that_brings_it():
    asked = {call for source in [*SOURCES, *OUTSIDE] for call in calls_of_require(source)}
    brought = {
        extra: {MODULES_OF[name] for name in names} for extra, names in required()[1].items()
    }
    assert {extra for _, extra in asked} == brought.keys()
    for module, extra in asked:
        assert module.partition(".")[0] in brought[extra]


def imported_when_running(node):
    """Yield the modules that code imports, except imports for type checkers."""
    if isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING":
        return
    yield from (one.name for one in node.names) if isinstance(node, ast.Import) else ()
    yield from [node.module or ""] if isinstance(node, ast.ImportFrom) else ()
    for inner in ast.iter_child_nodes(node):
        yield from imported_when_running(inner)


def test_no_optional_library_is_imported_without_asking():
    for source in SOURCES:
        of_users = OF_USERS - {"sklearn"} if source in ESTIMATORS else OF_USERS
        names = imported_when_running(ast.parse(source.read_text(encoding="utf-8")))
        assert not {name.partition(".")[0] for name in names} & of_users, source
