"""Regression of stacks on panels, and predictions inside the data (chapter 5 of the thesis).

The names below are imported when they are used, since the command line passes through here.
"""

import importlib
from typing import Any

_WHERE = {
    "CrossValidation": "folds",
    "EpsilonSVR": "svr",
    "OutsideDataError": "predictor",
    "Prediction": "predictor",
    "RegressionInterrupted": "nested",
    "StackModel": "model_file",
    "StackRows": "rows",
    "TargetReport": "pipeline",
    "geometry_rows": "dataset",
    "geometry_study": "geometry",
    "geometry_table": "dataset",
    "load_model": "model_file",
    "predict": "predictor",
    "read_rows": "rows",
    "regress": "pipeline",
    "rows_of": "rows",
    "save_model": "model_file",
}
__all__ = list(_WHERE)


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_WHERE[name]}"), name)
