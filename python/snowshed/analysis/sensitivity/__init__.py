"""Sensitivity of the stack to the parameters of the snow (chapter 3 of the thesis)."""

from snowshed.analysis.sensitivity.designs import sensitivity_study
from snowshed.analysis.sensitivity.fixed_parameter import fixation
from snowshed.analysis.sensitivity.global_indices import morris_effects, sobol_indices
from snowshed.analysis.sensitivity.noise import seeding_noise
from snowshed.analysis.sensitivity.report import evaluate
from snowshed.analysis.sensitivity.single_parameter import local_index
from snowshed.analysis.sensitivity.stored import StoredRuns, read_stored

__all__ = [
    "StoredRuns",
    "evaluate",
    "fixation",
    "local_index",
    "morris_effects",
    "read_stored",
    "seeding_noise",
    "sensitivity_study",
    "sobol_indices",
]
