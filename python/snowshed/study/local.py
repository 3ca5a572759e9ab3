"""Local processes that compute runs.

The processes are started by a plain command instead of by `multiprocessing`, so that scripts need
no main guard, and each has a socket of its own: if one dies, nobody else notices.
"""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterable
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from typing import Optional

from snowshed.study.outcome import Fraction, Outcome, Ready, Task

STOP_S = 60.0  # s a process has to write its checkpoint
END_S = 5.0  # s a process has to end once its socket is closed


class LocalWorkers:
    """Up to `processes` processes that share the cores; see `Workers` for the interface.

    Parameters
    ----------
    processes
        Runs at once.
    threads
        Threads of each run; None: so many that the cores are full.
    cores
        Cores to fill.
    """

    def __init__(self, processes: int, threads: Optional[int], cores: int) -> None:
        self.capacity = processes
        self._threads = threads
        self._cores = cores
        self._processes: list[_Process] = []

    def threads(self, unfinished: int) -> int:
        """Return the threads of a run: few runs have several each, many have one."""
        return self._threads or max(1, self._cores // max(1, min(self.capacity, unfinished)))

    @property
    def fractions(self) -> dict[str, float]:
        """How much of the work of each submitted run is done."""
        return {process.task.hash: process.done for process in self._processes if process.task}

    def submit(self, task: Task) -> None:
        """Start computing a task in an idle process, or a new one."""
        while True:
            idle = next((process for process in self._processes if not process.task), None)
            if idle is None:
                idle = _Process()
                self._processes.append(idle)
            if idle.start(task):
                return
            self._discard(idle)  # it died while it was idle

    def collect(self, timeout: float) -> list[Outcome]:
        """Wait until a task ends, no longer than `timeout` in s; return what has ended."""
        ready = wait([process.connection for process in self._busy()], timeout)
        outcomes = (process.receive() for process in self._busy() if process.connection in ready)
        ended = [outcome for outcome in outcomes if outcome]
        for process in [process for process in self._processes if process.dead]:
            self._discard(process)
        return ended

    def stop(self) -> list[Outcome]:
        """Ask all tasks to stop at a checkpoint; return what ended meanwhile."""
        for process in self._busy():
            process.interrupt()
        ended: list[Outcome] = []
        give_up = time.monotonic() + STOP_S
        while self._busy() and time.monotonic() < give_up:
            ended += self.collect(0.1)
        self.close()
        return ended

    def close(self) -> None:
        """End all processes."""
        for process in self._processes:
            process.connection.close()
        while self._processes:
            self._discard(self._processes[-1])

    def _busy(self) -> list[_Process]:
        return [process for process in self._processes if process.task]

    def _discard(self, process: _Process) -> None:
        process.end()
        self._processes.remove(process)


class _Process:
    """One process, and what it is doing."""

    def __init__(self) -> None:
        ours, theirs = socket.socketpair()
        with theirs:
            # In a session of its own a Ctrl-C does not reach it: the study stops it once, in order.
            # The current folder is not to be searched for modules, and scenes have absolute paths.
            self._process = subprocess.Popen(
                [sys.executable, "-m", "snowshed.study.worker", str(theirs.fileno())],
                pass_fds=[theirs.fileno()],
                start_new_session=True,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                cwd="/",
                env={**os.environ, "PYTHONPATH": os.pathsep.join(_absolute(sys.path))},
            )
        self.connection = Connection(ours.detach())
        self.task: Optional[Task] = None
        self.done = 0.0
        self.ready = False
        self.dead = False

    def start(self, task: Task) -> bool:
        """Hand over a task; return whether the process lives."""
        try:
            self.connection.send(task)
        except OSError:
            return False
        self.task, self.done = task, 0.0
        return True

    def receive(self) -> Optional[Outcome]:
        """Take one message; return the outcome if it is one."""
        assert self.task is not None
        try:
            message = self.connection.recv()
        except (EOFError, OSError):
            message = self._death(self.task)
        if isinstance(message, Outcome):
            self.task = None
            return message
        if isinstance(message, Fraction):
            self.done = message.done
        self.ready = self.ready or isinstance(message, Ready)
        return None

    def interrupt(self) -> None:
        """Ask the task to stop at a checkpoint."""
        with suppress(ProcessLookupError):
            self._process.send_signal(signal.SIGTERM)

    def end(self) -> None:
        """End the process, which its closed socket has told to end."""
        self.connection.close()
        try:
            self._process.wait(END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _death(self, task: Task) -> Outcome:
        self.dead = True
        self.end()
        code = self._process.returncode
        if code < 0:
            how = f"was killed by signal {-code} ({signal.strsignal(-code)})"
            return Outcome(task.hash, "lost", error=f"the worker {how}")
        if not self.ready:  # then no other would start either
            return Outcome(task.hash, "unable", error=f"no worker starts (exit code {code})")
        return Outcome(task.hash, "lost", error=f"the worker ended with code {code}")


def _absolute(paths: Iterable[str]) -> list[str]:
    return [os.path.abspath(path) for path in paths]  # noqa: PTH100 - "" is the current folder
