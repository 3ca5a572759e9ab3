"""What the packages export says its types."""

import importlib
import inspect
import pkgutil
import re

import pytest

import snowshed

PACKAGES = [
    "snowshed",
    *(one.name for one in pkgutil.walk_packages(snowshed.__path__, "snowshed.") if one.ispkg),
]


def annotations(thing):
    """Yield where and as what a function, or the public part of a class, annotates."""
    if inspect.isfunction(thing):
        yield from thing.__annotations__.items()
    elif inspect.isclass(thing):
        yield from vars(thing).get("__annotations__", {}).items()
        for name, member in vars(thing).items():
            if name.startswith("_") and name != "__init__":
                continue
            if isinstance(member, (classmethod, staticmethod)):
                member = member.__func__
            if isinstance(member, property):
                member = member.fget
            if inspect.isfunction(member):
                for argument, kind in member.__annotations__.items():
                    yield f"{name}({argument})", kind


@pytest.mark.parametrize("name", PACKAGES)
def test_nothing_public_is_any(name):
    package = importlib.import_module(name)
    vague = [
        f"{exported}.{place}: {kind}"
        for exported in getattr(package, "__all__", ())
        for place, kind in annotations(getattr(package, exported))
        if re.search(r"\bAny\b", str(kind))
    ]
    assert vague == []
