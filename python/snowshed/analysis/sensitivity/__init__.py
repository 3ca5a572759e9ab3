"""Sensitivity of the stack to the parameters of the snow (chapter 3 of the thesis).

The names below are imported when they are used, since the command line passes through here.
"""

import importlib
from typing import Any

_WHERE = {
    "StoredRuns": "stored",
    "evaluate": "report",
    "fixation": "fixed_parameter",
    "local_index": "single_parameter",
    "morris_effects": "global_indices",
    "read_stored": "stored",
    "seeding_noise": "noise",
    "sensitivity_study": "designs",
    "sobol_indices": "global_indices",
}
__all__ = list(_WHERE)


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_WHERE[name]}"), name)
