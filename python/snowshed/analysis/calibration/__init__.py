"""Calibration of the snow on measured stacks (chapter 4 of the thesis)."""

from snowshed.analysis.calibration.comparison import Simulated, compare, read_simulated
from snowshed.analysis.calibration.design import calibration_study
from snowshed.analysis.calibration.measurements import Measurement, read_measurements, template
from snowshed.analysis.calibration.misfit import rank
from snowshed.analysis.calibration.posterior import Posterior, sample_posterior
from snowshed.analysis.calibration.report import Calibration, calibrate, evaluate
from snowshed.analysis.calibration.surrogate import Surrogate

__all__ = [
    "Calibration",
    "Measurement",
    "Posterior",
    "Simulated",
    "Surrogate",
    "calibrate",
    "calibration_study",
    "compare",
    "evaluate",
    "rank",
    "read_measurements",
    "read_simulated",
    "sample_posterior",
    "template",
]
