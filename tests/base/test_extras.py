"""Optional libraries: messages if one is missing."""

import ast
import importlib
from pathlib import Path

import pytest
from helpers.paths import ROOT
from helpers.requirements import MODULE_BY_PACKAGE, required

from snowshed import InputError
from snowshed.base import extras
from snowshed.base.extras import require

SOURCE = Path(extras.__file__).parents[1]
SOURCES = sorted(SOURCE.rglob("*.py"))
OUTSIDE = sorted((ROOT / "validation").rglob("*.py"))  # of the installed package
OPTIONAL_MODULES = {MODULE_BY_PACKAGE[name] for names in required()[1].values() for name in names}
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


def test_a_missing_library_is_named_with_its_use_and_its_extra():
    message = (
        r"^counting sheep needs no_such_library, which cannot be imported \(No module named "
        r"'no_such_library'\); install it with: pip install \"snowshed\[validation\]\"$"
    )
    with pytest.raises(InputError, match=message):
        require("no_such_library.meadow", "validation", "counting sheep")


def require_calls(source):
    """Yield the required modules and extras, with constants replaced by their values."""
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


def test_every_optional_library_is_required_with_its_extra():
    required_modules = {call for source in [*SOURCES, *OUTSIDE] for call in require_calls(source)}
    modules_by_extra = {
        extra: {MODULE_BY_PACKAGE[name] for name in names} for extra, names in required()[1].items()
    }
    assert {extra for _, extra in required_modules} == modules_by_extra.keys()
    for module, extra in required_modules:
        assert module.partition(".")[0] in modules_by_extra[extra]


def imported_when_running(node):
    """Yield the modules that code imports, except imports for type checkers."""
    if isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING":
        return
    yield from (alias.name for alias in node.names) if isinstance(node, ast.Import) else ()
    yield from [node.module or ""] if isinstance(node, ast.ImportFrom) else ()
    for inner in ast.iter_child_nodes(node):
        yield from imported_when_running(inner)


def test_no_optional_library_is_imported_without_require():
    for source in SOURCES:
        forbidden = OPTIONAL_MODULES - {"sklearn"} if source in ESTIMATORS else OPTIONAL_MODULES
        names = imported_when_running(ast.parse(source.read_text(encoding="utf-8")))
        assert not {name.partition(".")[0] for name in names} & forbidden, source
