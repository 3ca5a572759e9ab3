import doctest
import importlib
import pkgutil

import pytest
import validation as verify

MODULES = [m.name for m in pkgutil.walk_packages(verify.__path__, f"{verify.__name__}.")]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings(name):
    assert doctest.testmod(importlib.import_module(name)).failed == 0
