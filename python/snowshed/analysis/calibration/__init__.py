"""Calibration of the snow on measured stacks (chapter 4 of the thesis).

The names below are imported when they are used, since the command line passes through here.
"""

import importlib
from typing import Any

_WHERE = {
    "Calibration": "report",
    "Measurement": "measurements",
    "Posterior": "posterior",
    "Simulated": "comparison",
    "Surrogate": "surrogate",
    "calibrate": "report",
    "calibration_study": "design",
    "compare": "comparison",
    "evaluate": "report",
    "rank": "misfit",
    "read_measurements": "measurements",
    "read_simulated": "comparison",
    "sample_posterior": "posterior",
    "template": "measurements",
}
__all__ = list(_WHERE)


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_WHERE[name]}"), name)
