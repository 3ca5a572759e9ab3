"""All cases, from the modules of `validation` whose names begin with ``case``."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from snowshed._core import InputError
from validation.framework.case import Case

ROOT = Path(__file__).parents[1]


def case_modules(root: Path = ROOT) -> dict[str, str]:
    """Return the modules with cases by their names, without importing them.

    Parameters
    ----------
    root
        Folder of the package `validation`.

    Examples
    --------
    >>> modules = case_modules()
    >>> modules["mps_water"], modules["incline"]
    ('validation.mps.case_water', 'validation.incline.case')
    """
    names = {}
    for file in sorted(root.glob("*/case*.py")):
        folder, module = file.parent.name, file.stem
        own = module.partition("_")[2]
        if folder != "framework":
            names[f"{folder}_{own}" if own else folder] = f"{root.name}.{folder}.{module}"
    return names


def cases_of(module: str) -> list[Case]:
    """Return the cases of a module: its ``CASE``, or all of its ``CASES``."""
    content = importlib.import_module(module)
    return list(getattr(content, "CASES", None) or [content.CASE])


def load_cases(names: Sequence[str] = ()) -> list[Case]:
    """Return all cases, or the cases with these names, in the order of their modules.

    Parameters
    ----------
    names
        Names of cases, of modules with or without their folder, or of folders. A module and a
        folder stand for all cases in them.

    Raises
    ------
    InputError
        If a name stands for no case.

    Examples
    --------
    >>> [case.name for case in load_cases(["panel_edge"])]
    ['panel_edge']
    >>> [case.name for case in load_cases(["vibration"])]
    ['bar', 'cantilever']
    """
    modules = case_modules()
    groups = {name: _group_names(name, module) for name, module in modules.items()}
    if names and set(names) <= set().union(*groups.values()):  # no other module is imported
        chosen = [name for name in modules if groups[name] & set(names)]
        return [case for name in chosen for case in cases_of(modules[name])]
    all_cases = [(name, case) for name, module in modules.items() for case in cases_of(module)]
    _check_names(names, groups, all_cases)
    return [
        case
        for name, case in all_cases
        if not names or case.name in names or groups[name] & set(names)
    ]


def _group_names(name: str, module: str) -> set[str]:
    """Return the names that stand for all cases of a module."""
    _, folder, last = module.split(".")
    return {name, folder, last.partition("_")[2] or folder}


def _check_names(
    names: Sequence[str], groups: Mapping[str, set[str]], all_cases: Sequence[tuple[str, Case]]
) -> None:
    known = {
        name: None for module, case in all_cases for name in (*sorted(groups[module]), case.name)
    }
    if unknown := [name for name in names if name not in known]:
        raise InputError(f"--case {unknown[0]}: no such case; there are {', '.join(known)}")
