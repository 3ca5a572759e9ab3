"""Regression of stacks on panels, and predictions inside the data (chapter 5 of the thesis)."""

from typing import TYPE_CHECKING

from snowshed.analysis.regression.dataset import geometry_rows, geometry_table
from snowshed.analysis.regression.folds import CrossValidation
from snowshed.analysis.regression.geometry import geometry_study
from snowshed.analysis.regression.model_file import StackModel, load_model, save_model
from snowshed.analysis.regression.nested import RegressionInterrupted
from snowshed.analysis.regression.pipeline import TargetReport, regress
from snowshed.analysis.regression.predictor import OutsideDataError, Prediction, predict
from snowshed.analysis.regression.rows import StackRows, read_rows, rows_of

if TYPE_CHECKING:
    from snowshed.analysis.regression.svr import EpsilonSVR
else:

    def __getattr__(name):
        """Import modules that need scikit-learn, an extra, on first use."""
        if name == "EpsilonSVR":
            from snowshed.analysis.regression.svr import EpsilonSVR

            return EpsilonSVR
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = [
    "CrossValidation",
    "EpsilonSVR",
    "OutsideDataError",
    "Prediction",
    "RegressionInterrupted",
    "StackModel",
    "StackRows",
    "TargetReport",
    "geometry_rows",
    "geometry_study",
    "geometry_table",
    "load_model",
    "predict",
    "read_rows",
    "regress",
    "rows_of",
    "save_model",
]
