import doctest
import importlib
import pkgutil

import pytest

import snowshed.vdb

MODULES = sorted(f"snowshed.vdb.{m.name}" for m in pkgutil.iter_modules(snowshed.vdb.__path__))


@pytest.mark.parametrize("name", ["snowshed.vdb", *MODULES])
def test_examples_in_docstrings(name):
    assert doctest.testmod(importlib.import_module(name)).failed == 0
