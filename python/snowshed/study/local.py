"""Local processes that compute the runs of a study."""

from __future__ import annotations

from typing import Optional

from snowshed.base.pool.pool import Pool, TaskEnd
from snowshed.study.compute import compute
from snowshed.study.outcome import RunOutcome, RunTask


class LocalWorkers:
    """Up to `processes` processes that share the cores; see `Workers` for the interface.

    Parameters
    ----------
    processes
        Runs at once.
    threads
        Threads of each run; None: as many as use all cores.
    cores
        Number of cores to use.
    """

    def __init__(self, processes: int, threads: Optional[int], cores: int) -> None:
        self.pool: Pool[RunTask, RunOutcome] = Pool(processes, compute)
        self._threads = threads
        self._cores = cores

    @property
    def capacity(self) -> int:
        """Number of tasks at once."""
        return self.pool.capacity

    def threads(self, unfinished: int) -> int:
        """Return the threads of a run: several for few runs, a single one for many."""
        return self._threads or max(1, self._cores // max(1, min(self.capacity, unfinished)))

    @property
    def fractions(self) -> dict[str, float]:
        """Fraction of the work of each submitted run that is done."""
        return {task.hash: done for task, done in self.pool.fractions}

    def submit(self, task: RunTask) -> None:
        """Start computing a task in an idle process, or a new one."""
        self.pool.submit(task)

    def collect(self, timeout: float) -> list[RunOutcome]:
        """Wait until a task ends, no longer than `timeout` in s; return what has ended."""
        return [_outcome(ended) for ended in self.pool.collect(timeout)]

    def stop(self) -> list[RunOutcome]:
        """Ask all tasks to stop at a checkpoint; return the tasks that ended meanwhile."""
        return [_outcome(ended) for ended in self.pool.stop()]

    def close(self) -> None:
        """End all processes."""
        self.pool.close()


def _outcome(ended: TaskEnd[RunTask, RunOutcome]) -> RunOutcome:
    if ended.result is not None:
        return ended.result
    if ended.error is not None:  # `compute` handles all errors of runs: this is a fault of ours
        kind = type(ended.error).__name__
        return RunOutcome(ended.task.hash, "unable", error=f"{kind}: {ended.error}")
    if ended.never_began:
        return RunOutcome(ended.task.hash, "unable", error=f"no worker can start: it {ended.death}")
    return RunOutcome(ended.task.hash, "lost", error=f"the worker {ended.death}")
