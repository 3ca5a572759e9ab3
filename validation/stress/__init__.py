"""Stress: stiff, soft, light, heavy, fast, thin, lonely snow, until it rests or says why not.

Hundreds of small scenes (thousands with ``full``) at the extremes of every parameter, singly, in
pairs and at random. Each must come to rest or run to its limit with finite state, exact mass and
closed balances, or stop with an error that names its cause and leaves a checkpoint.
"""

from validation.stress.measure import run, run_trials
from validation.stress.tables import SummaryTable, summarise

__all__ = ["SummaryTable", "run", "run_trials", "summarise"]
