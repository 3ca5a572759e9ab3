"""Workers that compute the runs of a study: the interface of local processes and clusters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from snowshed.study.outcome import RunOutcome, RunTask


class Workers(Protocol):
    """Computes tasks, several at once."""

    @property
    def capacity(self) -> int:
        """Number of tasks at once."""

    def threads(self, unfinished: int) -> int:
        """Return the number of threads of a run while `unfinished` runs are left."""

    def submit(self, task: RunTask) -> None:
        """Start computing a task; no more than `capacity` at once."""

    def collect(self, timeout: float) -> Sequence[RunOutcome]:
        """Wait until a task ends, no longer than `timeout` in s; return what has ended."""

    @property
    def fractions(self) -> Mapping[str, float]:
        """Finished fraction of each submitted run, if known."""

    def stop(self) -> Sequence[RunOutcome]:
        """Ask all tasks to stop at checkpoints; return the tasks that ended meanwhile."""

    def close(self) -> None:
        """End all work at once."""
