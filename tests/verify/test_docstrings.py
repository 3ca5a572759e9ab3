import doctest
import importlib
import pkgutil

import pytest

from snowshed import verify


@pytest.mark.parametrize("name", [module.name for module in pkgutil.iter_modules(verify.__path__)])
def test_examples_in_docstrings(name):
    module = importlib.import_module(f"{verify.__name__}.{name}")
    assert doctest.testmod(module).failed == 0
