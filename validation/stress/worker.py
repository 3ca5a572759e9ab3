"""Runs in a process of their own: a crash or a hang is an answer, not the end of the suite."""

from __future__ import annotations

import json
import os
import select
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import IO, Optional

from validation.stress.solve import Record
from validation.stress.space import Point

#: What answers trials with records, a line of JSON each.
COMMAND = (sys.executable, "-m", "validation.stress.worker_process")


class Worker:
    """A process that makes runs, replaced when it dies or takes too long; made by `worker`."""

    def __init__(self, budget_s: float, command: Sequence[str], complaints: IO[str]) -> None:
        self.budget_s = budget_s
        self._command = command
        self._complaints = complaints
        self._process: Optional[subprocess.Popen[str]] = None

    def solve(self, point: Point, steps: int) -> Record:
        """Return the record of a run, with ``ended`` "crashed", "hung" or "raised" where it is so.

        "raised" is an exception that is neither `InputError` nor `SimulationError`.
        """
        process = self._running()
        assert process.stdin is not None and process.stdout is not None
        try:
            process.stdin.write(json.dumps({"point": dict(point), "steps": steps}) + "\n")
            process.stdin.flush()
        except BrokenPipeError:
            return self._crashed(process)
        ready, _, _ = select.select([process.stdout], [], [], self.budget_s)
        if not ready:
            self.end()
            return {"ended": "hung", "message": f"took more than {self.budget_s:g} s"}
        line = process.stdout.readline()
        if not line:
            return self._crashed(process)
        record: Record = json.loads(line)
        return record

    def end(self) -> None:
        """End the process; another run starts a new one."""
        if self._process is None:
            return
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                pipe.close()
        self._process = None

    def _running(self) -> subprocess.Popen[str]:
        if self._process is None:
            self._process = subprocess.Popen(
                self._command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._complaints,
                text=True,
                env={**os.environ, "OMP_NUM_THREADS": "1"},
            )
        return self._process

    def _crashed(self, process: subprocess.Popen[str]) -> Record:
        code = process.wait()
        self._process = None
        self._complaints.seek(0)
        last = self._complaints.read().strip().splitlines()[-1:]
        return {"ended": "crashed", "message": " ".join([f"exit code {code}", *last])}


@contextmanager
def worker(budget_s: float = 60.0, command: Sequence[str] = COMMAND) -> Iterator[Worker]:
    """Provide a `Worker`, which ends with the context.

    Parameters
    ----------
    budget_s:
        Wall time that a run may take, and the start of the process with it, s.
    command:
        What to start as the process.

    Examples
    --------
    >>> from validation.stress.space import reference
    >>> with worker() as process:
    ...     process.solve(reference(), steps=20)["ended"]
    'time_limit'
    """
    with tempfile.TemporaryFile("w+") as complaints:
        process = Worker(budget_s, command, complaints)
        try:
            yield process
        finally:
            process.end()
