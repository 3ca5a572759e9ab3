"""A Dask cluster that computes runs (extra ``snowshed[cluster]``)."""

from __future__ import annotations

import asyncio
import os
import uuid
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from snowshed._core import InputError
from snowshed.base.extras import require
from snowshed.study.compute import compute
from snowshed.study.errors import StudyError
from snowshed.study.outcome import RunOutcome, RunTask

CONNECT_S = 30  # s to wait for the scheduler
MAX_SUBMITTED = 1000  # tasks handed over at once: enough for a cluster that grows with its work


class DaskWorkers:
    """The workers of a Dask scheduler; see `Workers` for the interface.

    A worker computes as many runs at once as it has threads, each run with one thread. If a worker
    dies, Dask gives its runs to others. They resume these runs if they share the study's folder.

    Parameters
    ----------
    scheduler
        The address of the scheduler, the path of its .json file, a Dask cluster, or a client, which
        stays open.

    Raises
    ------
    InputError
        If Dask is not installed, or there is no scheduler.
    """

    capacity = MAX_SUBMITTED

    def __init__(self, scheduler: object) -> None:
        self._dask = require("distributed", "cluster", "computing on a cluster")
        self._owned = not isinstance(scheduler, self._dask.Client)
        self._client: Any = self._connect(scheduler) if self._owned else scheduler
        self._futures: dict[str, Any] = {}

    def threads(self, unfinished: int) -> int:
        """Return 1: the workers' own threads fill their cores."""
        return 1

    @property
    def cores(self) -> int:
        """Number of runs that the present workers compute at once."""
        return max(1, sum(int(count) for count in self._client.nthreads().values()))

    @property
    def fractions(self) -> Mapping[str, float]:
        """Always empty, because only the end of runs in other processes is known."""
        return {}

    def submit(self, task: RunTask) -> None:
        """Hand a task to the scheduler."""
        # A unique name, so that Dask never confuses this attempt with an earlier one.
        key = f"snowshed-{task.hash}-{uuid.uuid4().hex[:8]}"
        self._futures[task.hash] = self._client.submit(compute, task, key=key, pure=False)

    def collect(self, timeout: float) -> list[RunOutcome]:
        """Wait until a task ends, no longer than `timeout` in s; return what has ended."""
        try:
            self._dask.wait(
                list(self._futures.values()), timeout=timeout, return_when="FIRST_COMPLETED"
            )
        except (TimeoutError, asyncio.TimeoutError):
            return []
        ended = [hash_ for hash_, future in self._futures.items() if future.done()]
        return [_outcome(hash_, self._futures.pop(hash_)) for hash_ in ended]

    def stop(self) -> list[RunOutcome]:
        """Cancel the runs that have not begun; the others continue, but their ends are ignored."""
        self._client.cancel(list(self._futures.values()))
        self.close()
        return []

    def close(self) -> None:
        """Disconnect from the scheduler."""
        self._futures.clear()
        if self._owned:
            self._client.close()

    def _connect(self, scheduler: object) -> Any:
        where = {"address": scheduler}
        if isinstance(scheduler, (str, os.PathLike)) and os.fspath(scheduler).endswith(".json"):
            if not Path(scheduler).exists():  # Dask would wait for it forever
                raise InputError(f"no Dask scheduler at {scheduler}: no such file")
            where = {"scheduler_file": os.fspath(scheduler)}
        try:
            return self._dask.Client(**where, timeout=CONNECT_S)
        except (OSError, ValueError, TimeoutError, asyncio.TimeoutError) as error:
            raise InputError(f"no Dask scheduler at {scheduler}: {error}") from None


def _outcome(hash_: str, future: Any) -> RunOutcome:
    if future.status == "finished":
        outcome: RunOutcome = future.result()
        return outcome
    if future.status == "error":
        error = future.exception()
        if type(error).__name__ == "KilledWorker":
            return RunOutcome(hash_, "failed", error="every worker that computed the run died")
        return RunOutcome(hash_, "unable", error=f"{type(error).__name__}: {error}")
    raise StudyError("the connection to the Dask scheduler is lost")
