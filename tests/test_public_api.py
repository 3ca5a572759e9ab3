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
    *(
        module.name
        for module in pkgutil.walk_packages(snowshed.__path__, "snowshed.")
        if module.ispkg
    ),
]
#: Modules with a source; the compiled core has none.
WRITTEN = {module.name for module in pkgutil.walk_packages(snowshed.__path__, "snowshed.")}
WRITTEN -= {"snowshed._core"}
API = (ROOT / "docs" / "reference" / "api.md").read_text(encoding="utf-8")
DOCUMENTED = re.findall(r"^\.\. auto\w+:: (snowshed\S*)\.(\w+)$", API, re.MULTILINE)
EXPORTED = [
    (package, name)
    for package in PACKAGES
    for name in getattr(importlib.import_module(package), "__all__", ())
]
#: Packages for internal use.
INTERNAL = ("snowshed.cli.self_test",)
PUBLIC = sorted({*DOCUMENTED, *EXPORTED})
#: The packages of `analysis`, each with the names of one question.
QUESTIONS = {f"snowshed.analysis.{name}" for name in snowshed.analysis.__all__}
QUESTIONS &= set(PACKAGES)


def visible_types(thing):
    """Return the names in an object's module, including those that are imported for types alone."""
    names = {}
    for base in reversed(getattr(thing, "__mro__", (thing,))):  # a class also has its bases' types
        if base.__module__ in WRITTEN or base is thing:
            names.update(module_names(sys.modules[base.__module__]))
    return names


def module_names(module):
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
    if typing.get_origin(kind) in (np.ndarray, np.dtype, np.typing.NDArray):
        return False
    arguments = typing.get_args(kind)
    nested = [argument for part in arguments if isinstance(part, list) for argument in part]
    return any(holds_any(argument) for argument in (*arguments, *nested))


@pytest.fixture(autouse=True)
def pandas_types(monkeypatch):
    """Let ``pd.Series[float]`` be evaluated, which only the stubs of pandas know."""
    for kind in (pd.Series, pd.Index):
        monkeypatch.setattr(kind, "__class_getitem__", classmethod(GenericAlias), raising=False)


@pytest.mark.parametrize(("package", "name"), PUBLIC)
def test_public_types_contain_no_any(package, name):
    vague = [
        f"{owner}({argument}): {kind}"
        for owner, thing in signatures(getattr(importlib.import_module(package), name))
        for argument, kind in typing.get_type_hints(thing, visible_types(thing)).items()
        if not argument.startswith("_") and holds_any(kind)
    ]
    assert vague == []


def test_the_page_documents_what_the_package_exports():
    documented = {name for _, name in DOCUMENTED}
    undocumented = [name for name in snowshed.__all__ if name not in {*documented, "__version__"}]
    assert [name for name in undocumented if not inspect.ismodule(getattr(snowshed, name))] == []


def test_the_page_lists_every_name_of_analysis():
    exported = {pair for pair in EXPORTED if pair[0].startswith("snowshed.analysis")}
    missing = {f"{package}.{name}" for package, name in exported - set(DOCUMENTED)}
    assert missing - QUESTIONS == set()


#: Files in which a reader sees imports: pages, tutorials and examples.
SHOWN = [
    ROOT / "README.md",
    *(path for ending in ("md", "ipynb") for path in sorted((ROOT / "docs").rglob(f"*.{ending}"))),
    *sorted((ROOT / "examples").glob("*.py")),
    ROOT / "tests" / "test_first_snippets.py",
]
DEEP = re.compile(r"(?:from|import) snowshed(?:\.\w+){2,}|`snowshed(?:\.\w+){3,}")


def deep_names(text):
    """Return the names in a text that lie deeper than a room, or a question of `analysis`."""
    questions = "|".join(map(re.escape, QUESTIONS))
    return DEEP.findall(re.sub(rf"\b(?:{questions})\b", "snowshed.analysis", text))


#: The page on adding a method shows internal modules.
@pytest.mark.parametrize(
    "file", [file for file in SHOWN if file.stem != "add-a-method"], ids=lambda file: file.stem
)
def test_readers_import_from_the_package_or_a_room(file):
    assert deep_names(file.read_text(encoding="utf-8")) == []


def test_documented_names_are_in_the_package_or_a_room():
    deep = {module for module, _ in DOCUMENTED if module.count(".") > 1}
    assert deep - QUESTIONS == set()
    assert len(DOCUMENTED) > 100
    assert deep_names("from snowshed.season.weather.season_record import SeasonRecord")
    assert deep_names("from snowshed.analysis.hazard.maps import hazard_maps")
    assert not deep_names("from snowshed.analysis.hazard import hazard_maps")


def test_packages_inside_a_room_export_nothing():
    """Only the questions of `analysis` do."""
    inside = {package for package, _ in EXPORTED if package.count(".") > 1}
    assert {name for name in inside if not name.startswith(INTERNAL)} == QUESTIONS


def test_analysis_exports_each_name_once():
    names = [name for package, name in EXPORTED if package.startswith("snowshed.analysis")]
    assert len(names) == len(set(names))


def test_no_exported_name_is_also_a_module():
    """The import of the module would replace the name in the package."""
    names = {f"{package}.{name}" for package, name in EXPORTED}
    rooms = {name for name in names & WRITTEN if name.count(".") == 1}
    assert names & WRITTEN == rooms | QUESTIONS and "snowshed.scene" in rooms


def test_any_is_detected_within_other_types():
    assert holds_any(typing.Callable[[typing.Dict[str, typing.Any]], int])
    assert not holds_any(typing.Dict[str, np.ndarray])
    assert len(PUBLIC) > 100


def test_rooms_are_imported_on_access():
    code = "import snowshed; print(snowshed.plot.scene_figure, snowshed.snow.stack_error)"
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
