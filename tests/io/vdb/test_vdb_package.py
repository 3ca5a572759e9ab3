import doctest
import importlib
import pkgutil

import pytest

import snowshed.io.vdb

MODULES = sorted(
    f"snowshed.io.vdb.{m.name}" for m in pkgutil.iter_modules(snowshed.io.vdb.__path__)
)


@pytest.mark.parametrize("name", ["snowshed.io.vdb", *MODULES])
def test_examples_in_docstrings(name):
    assert doctest.testmod(importlib.import_module(name)).failed == 0
