import builtins
import doctest
import importlib
import pkgutil
import re
import subprocess
import sys

import pytest
from helpers.paths import ROOT
from helpers.processes import modules_after
from helpers.requirements import MODULE_BY_PACKAGE, required

import snowshed

MODULES = sorted(
    module.name
    for module in pkgutil.walk_packages(snowshed.__path__, "snowshed.")
    if module.name not in ("snowshed._core", "snowshed.__main__")
)


@pytest.mark.parametrize("name", ["snowshed", *MODULES])
def test_examples_in_docstrings(name):
    module = importlib.import_module(name)
    assert doctest.testmod(module).failed == 0


@pytest.mark.skipif(sys.version_info < (3, 10), reason="lists no modules of the standard library")
def test_no_exported_name_is_that_of_a_standard_module():
    packages = [m.name for m in pkgutil.walk_packages(snowshed.__path__, "snowshed.") if m.ispkg]
    for package in ["snowshed", *packages]:
        exported = getattr(importlib.import_module(package), "__all__", ())
        assert not set(exported) & {*sys.stdlib_module_names, *dir(builtins)}, package
    assert snowshed.io.__name__ == "snowshed.io"


def test_every_requirement_has_a_module():
    own, extras = required()
    assert own.union(*extras.values()) == MODULE_BY_PACKAGE.keys() | {"numpy"}


def test_classifiers_name_every_python_from_the_oldest_to_3_14():
    text = (ROOT / "pyproject.toml").read_text()
    (oldest,) = re.findall(r'requires-python = ">=3\.(\d+)"', text)
    named = re.findall(r"Programming Language :: Python :: 3\.(\d+)", text)
    assert [int(minor) for minor in named] == list(range(int(oldest), 15))


def test_running_a_scene_does_not_import_image_libraries():
    modules = modules_after("import snowshed.cli.commands.run, snowshed.running.run")
    assert not [m for m in modules if m.startswith(("scipy.ndimage", "skimage", "rasterio"))]


@pytest.mark.parametrize(
    ("module", "allowed"),
    [("snowshed", {"lazy_loader"}), ("snowshed.cli.main", {"click", "lazy_loader"})],
)
def test_import_is_quick_and_loads_no_other_libraries(module, allowed):
    code = (
        "import sys, time; clock = [time.process_time()]; import numpy; "
        f"clock.append(time.process_time()); import {module}; clock.append(time.process_time()); "
        "print((clock[2] - clock[1]) / (clock[1] - clock[0]), "
        "*{name.partition('.')[0] for name in sys.modules})"
    )
    runs = [
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        for _ in range(4)
    ]
    relative_time, *imported = min(
        (run.stdout.split() for run in runs), key=lambda words: float(words[0])
    )
    assert set(imported) & set(MODULE_BY_PACKAGE.values()) == allowed
    assert float(relative_time) < 1.5  # in units of NumPy's processor time, on any machine
