"""Names that modules still give for one version after they were changed."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping


def renamed(
    module: str, classes: Mapping[str, type], *, stacklevel: int = 2
) -> Callable[[str], object]:
    """Return the ``__getattr__`` of a module that gives classes by their former names, and warns.

    Parameters
    ----------
    module
        The module's name.
    classes
        The classes, by their former names.
    stacklevel
        As of `warnings.warn`; one more where the module calls what is returned.

    Examples
    --------
    >>> find = renamed("shop", {"Cart": list})
    >>> with warnings.catch_warnings(record=True) as said:
    ...     warnings.simplefilter("always")
    ...     find("Cart")
    <class 'list'>
    >>> str(said[0].message)
    'shop.Cart is now list'
    """

    def find(name: str) -> object:
        if name not in classes:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        now = classes[name]
        warnings.warn(f"{module}.{name} is now {now.__name__}", DeprecationWarning, stacklevel)
        return now

    return find
