"""The list of cases: every module in `validation.cases` brings one or several."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Sequence

from snowshed._core import InputError
from validation import cases
from validation.case import Case


def case_modules() -> list[str]:
    """Return the names of the modules with cases, without importing them."""
    return sorted(module.name for module in pkgutil.iter_modules(cases.__path__))


def cases_of(module: str) -> list[Case]:
    """Return the cases of a module: its ``CASE``, or all of its ``CASES``."""
    content = importlib.import_module(f"{cases.__name__}.{module}")
    return list(getattr(content, "CASES", None) or [content.CASE])


def load_cases(names: Sequence[str] = ()) -> list[Case]:
    """Return all cases, or those with these names, in the order of their modules.

    Parameters
    ----------
    names
        Of cases, or of modules, which stand for all cases in them.

    Raises
    ------
    InputError
        If there is nothing of a name.

    Examples
    --------
    >>> [case.name for case in load_cases(["panel_edge"])]
    ['panel_edge']
    """
    modules = case_modules()
    if names and set(names) <= set(modules):
        return [case for module in modules if module in names for case in cases_of(module)]
    found = [(module, case) for module in modules for case in cases_of(module)]
    known = {name: None for module, case in found for name in (module, case.name)}
    if unknown := [name for name in names if name not in known]:
        raise InputError(f"--case {unknown[0]}: no such case; there are {', '.join(known)}")
    return [case for module, case in found if not names or module in names or case.name in names]
