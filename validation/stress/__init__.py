"""The stress suite: small scenes at the extremes of every parameter.

Hundreds of scenes (thousands with ``full``) vary single parameters, pairs of parameters, or all
parameters at random. Each run must come to rest or reach its limit with a finite state, exact mass
and closed balances; or it must stop with an error that names its cause, and leave a checkpoint.
"""

from validation.stress.measure import run, run_trials
from validation.stress.tables import SummaryTable, summarise

__all__ = ["SummaryTable", "run", "run_trials", "summarise"]
