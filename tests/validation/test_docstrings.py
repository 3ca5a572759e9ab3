import doctest
import importlib
import pkgutil

import pytest
import validation

MODULES = [module.name for module in pkgutil.walk_packages(validation.__path__, "validation.")]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings(name):
    assert doctest.testmod(importlib.import_module(name)).failed == 0
