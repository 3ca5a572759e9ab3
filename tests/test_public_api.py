"""Everything that the packages export and the page of the API documents has types."""

import ast
import importlib
import inspect
import pkgutil
import re
import subprocess
import sys
import typing
from types import GenericAlias

import numpy as np
import pandas as pd
import pytest
from helpers.paths import ROOT

import snowshed

PACKAGES = [
    "snowshed",
    *(one.name for one in pkgutil.walk_packages(snowshed.__path__, "snowshed.") if one.ispkg),
]
#: Modules with a source; the compiled core has none.
WRITTEN = {one.name for one in pkgutil.walk_packages(snowshed.__path__, "snowshed.")}
WRITTEN -= {"snowshed._core"}
API = (ROOT / "docs" / "reference" / "api.md").read_text(encoding="utf-8")
DOCUMENTED = re.findall(r"^\.\. auto\w+:: (snowshed\S*)\.(\w+)$", API, re.MULTILINE)
EXPORTED = [
    (package, name)
    for package in PACKAGES
    for name in getattr(importlib.import_module(package), "__all__", ())
]
#: Packages for the package itself.
INTERNAL = ("snowshed.cli.self_test",)
PUBLIC = sorted({*DOCUMENTED, *EXPORTED})


def types_seen_by(thing):
    """Return the names in an object's module, including those that are imported for types alone."""
    names = {}
    for base in reversed(getattr(thing, "__mro__", (thing,))):  # a class also has its bases' types
        if base.__module__ in WRITTEN or base is thing:
            names.update(names_of_module(sys.modules[base.__module__]))
    return names


def names_of_module(module):
    names = dict(vars(module))
    for node in ast.parse(inspect.getsource(module)).body:
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            exec(ast.unparse(node.body), names)
    return names


def signatures(thing):
    """Yield a function, or the public methods of a class and the class itself."""
    if inspect.isfunction(thing):
        yield thing.__name__, thing
    elif inspect.isclass(thing) and thing.__module__ in WRITTEN:
        yield thing.__name__, thing
        for name, member in vars(thing).items():
            if name.startswith("_") and name != "__init__":
                continue
            member = getattr(member, "__func__", getattr(member, "fget", member))
            if inspect.isfunction(member):
                yield f"{thing.__name__}.{name}", member


def holds_any(kind):
    """Return whether a type contains Any, except in arrays, where NumPy itself uses it for a
    shape."""
    if kind is typing.Any:
        return True
    if typing.get_origin(kind) in (np.ndarray, np.dtype):
        return False
    arguments = typing.get_args(kind)
    nested = [one for part in arguments if isinstance(part, list) for one in part]
    return any(holds_any(one) for one in (*arguments, *nested))


@pytest.fixture(autouse=True)
def pandas_types(monkeypatch):
    """Let ``pd.Series[float]`` be evaluated, which only the stubs of pandas know."""
    for kind in (pd.Series, pd.Index):
        monkeypatch.setattr(kind, "__class_getitem__", classmethod(GenericAlias), raising=False)


@pytest.mark.parametrize(("package", "name"), PUBLIC)
def test_nothing_public_is_any(package, name):
    vague = [
        f"{place}({argument}): {kind}"
        for place, thing in signatures(getattr(importlib.import_module(package), name))
        for argument, kind in typing.get_type_hints(thing, types_seen_by(thing)).items()
        if not argument.startswith("_") and holds_any(kind)
    ]
    assert vague == []


def test_the_page_documents_what_the_package_exports():
    documented = {name for _, name in DOCUMENTED}
    undocumented = [name for name in snowshed.__all__ if name not in {*documented, "__version__"}]
    assert [name for name in undocumented if not inspect.ismodule(getattr(snowshed, name))] == []


def test_the_page_lists_every_name_of_the_room_of_questions():
    documented = {name for module, name in DOCUMENTED if module == "snowshed.analysis"}
    assert set(snowshed.analysis.__all__) - documented == set()


#: Files in which a reader sees imports: pages, tutorials and examples.
SHOWN = [
    ROOT / "README.md",
    *(path for ending in ("md", "ipynb") for path in sorted((ROOT / "docs").rglob(f"*.{ending}"))),
    *sorted((ROOT / "examples").glob("*.py")),
    ROOT / "tests" / "test_first_snippets.py",
]
#: The page on adding a method shows internal modules.
DEEP = re.compile(r"(?:from|import) snowshed(?:\.\w+){2,}|`snowshed(?:\.\w+){3,}")


@pytest.mark.parametrize(
    "file", [file for file in SHOWN if file.stem != "add-a-method"], ids=lambda file: file.stem
)
def test_readers_import_from_the_package_or_a_room(file):
    assert DEEP.findall(file.read_text(encoding="utf-8")) == []


def test_what_the_page_documents_stands_in_the_package_or_a_room():
    assert [f"{module}.{name}" for module, name in DOCUMENTED if module.count(".") > 1] == []
    assert len(DOCUMENTED) > 100
    assert DEEP.search("from snowshed.season.season_record import SeasonRecord")


def test_a_name_is_exported_once_in_a_room():
    """Packages inside a room export nothing; only the stub of a room exports names."""
    inside = [f"{package}.{name}" for package, name in EXPORTED if package.count(".") > 1]
    assert [name for name in inside if not name.startswith(INTERNAL)] == []


def test_no_exported_name_is_that_of_a_module_beside_it():
    """The import of the module would replace the name in the package."""
    names = {f"{package}.{name}" for package, name in EXPORTED}
    modules = {name for name in names & WRITTEN if name.count(".") == 1}
    assert names & WRITTEN == modules and "snowshed.scene" in modules


def test_any_is_found_within_other_types():
    assert holds_any(typing.Callable[[typing.Dict[str, typing.Any]], int])
    assert not holds_any(typing.Dict[str, np.ndarray])
    assert len(PUBLIC) > 100


def test_rooms_need_no_import_of_their_own():
    code = "import snowshed; print(snowshed.plot.scene_figure, snowshed.analysis.stack_error)"
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
