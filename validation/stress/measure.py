"""The suite: a table of all trials of the design, computed and judged."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional

import pandas as pd

from snowshed.base.progress import Progress, Reporter
from validation.stress.design import Trial, trials
from validation.stress.judge import judge
from validation.stress.process import ProcessRun, record, stress_pool


def run(full: bool, seed: int = 1, progress: Optional[Reporter] = None) -> pd.DataFrame:
    """Make all runs of the quick or the full stress suite.

    Parameters
    ----------
    full:
        Whether to make the full suite (thousands of runs, about ten minutes on one core); otherwise
        the quick suite (seconds).
    seed:
        Seed of the random combinations.
    progress:
        Called after every run.

    Returns
    -------
    pandas.DataFrame
        One row per run: ``design``, ``varied``, a column for each parameter of `space.PARAMETERS`,
        ``outcome`` (one of `judge.OUTCOMES`), ``reason`` (of a failure), and the measures of
        `solve.solve`.

    Raises
    ------
    InputError
        If `allpairspy` is not installed.
    """
    return run_trials(trials(full, seed), progress)


def run_trials(plan: Sequence[Trial], progress: Optional[Reporter] = None) -> pd.DataFrame:
    """Make the given runs, and return a table like that of `run`."""
    rows: list[dict[str, Any]] = []
    failed = 0
    with stress_pool() as pool:
        for trial in plan:
            row = {**trial.point, **record(pool, ProcessRun(trial.point, trial.steps))}
            outcome, reason = judge(row)
            failed += outcome == "failed"
            rows.append(
                {
                    "design": trial.design,
                    "varied": trial.varied,
                    "outcome": outcome,
                    "reason": reason,
                    **row,
                }
            )
            if progress is not None:
                done, count = len(rows), len(plan)
                progress(Progress(done / count, done, count, "stress runs", failed=failed))
    return pd.DataFrame(rows)
