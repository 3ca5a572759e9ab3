"""The stress suite: small scenes at the extremes of every parameter.

Hundreds of scenes (thousands with ``full``) vary one parameter at a time, pairs, and all at random.
Each must come to rest or run to its limit with finite state, exact mass and
closed balances, or stop with an error that names its cause and leaves a checkpoint.
"""

from validation.stress.measure import run, run_trials
from validation.stress.tables import SummaryTable, summarise

__all__ = ["SummaryTable", "run", "run_trials", "summarise"]
