"""Optional libraries: what is said where one is missing."""

import importlib

import pytest

from snowshed import InputError
from snowshed.extras import require


def test_an_installed_library_is_imported():
    assert require("math", "study", "adding") is importlib.import_module("math")


def test_a_missing_library_is_named_with_what_needs_it_and_what_brings_it():
    message = (
        r"^counting sheep needs no_such_library, which cannot be imported \(No module named "
        r"'no_such_library'\); install it with: pip install \"snowshed\[verify\]\"$"
    )
    with pytest.raises(InputError, match=message):
        require("no_such_library.meadow", "verify", "counting sheep")
