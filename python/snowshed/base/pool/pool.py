"""Local processes that compute tasks: studies, regressions, measurements and stress runs.

A plain command starts the processes instead of `multiprocessing`, so that scripts need no main
guard. Each process has its own socket: the death of one does not affect the others.
"""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from typing import Generic, Optional, TypeVar, cast

from snowshed.base.callers import is_called_from_shell
from snowshed.base.pool.messages import ForkDeath, Fraction, ProcessReady, TaskError, TaskResult

STOP_S = 60.0  # time for a process to write its checkpoint, s
END_S = 5.0  # time for a process to end after its socket is closed, s
STDERR_TAIL_BYTES = 4096  # bytes of a process's stderr whose last line is reported

Task = TypeVar("Task")
Result = TypeVar("Result")
#: Computes a task; may call its second argument with the finished share, 0 to 1.
Compute = Callable[[Task, Callable[[float], None]], Result]


@dataclass(frozen=True)
class Isolation:
    """Isolates the tasks of a `Pool` from each other, and ends those that hang.

    Attributes
    ----------
    forked
        Whether each task runs in a fork of its process, which itself never computes: a task then
        sees no memory of another, and the peak memory of its process is its own.
    limit_s
        Longest wall time of a task in s, from the moment when its process is ready. A longer task
        is killed with its process.
    environment
        Variables of the environment that are set for the processes.
    """

    forked: bool = False
    limit_s: float = float("inf")
    environment: Mapping[str, str] = field(default_factory=dict)


SHARED = Isolation()


@dataclass(frozen=True)
class TaskEnd(Generic[Task, Result]):
    """The end of a task: a result, an exception, or the death of its process.

    Attributes
    ----------
    task
        The task.
    result
        Result of the task, if it was computed.
    error
        Exception of the task, if it raised one.
    death
        Description of how its process ended, if it died.
    last_words
        Last line on stderr of a process that died; may be empty.
    hung
        Whether the process was killed because the task took too long.
    never_began
        Whether the process died before it was ready; other processes would fail, too.
    """

    task: Task
    result: Optional[Result] = None
    error: Optional[Exception] = None
    death: str = ""
    last_words: str = ""
    hung: bool = False
    never_began: bool = False


class Pool(Generic[Task, Result]):
    """Up to `processes` processes that compute one task after another; a context manager.

    A task runs in the main thread of its process, so that SIGTERM can ask it to stop at a safe
    point. Ctrl-C in a terminal does not reach the processes. They end with the pool, even if the
    parent process is killed.

    Parameters
    ----------
    processes
        Number of tasks to run in parallel.
    compute
        A function of a module, or a `functools.partial` of it; it is sent to each process once.
    isolation
        Isolation of the tasks; by default, tasks share a process with earlier ones.

    Examples
    --------
    >>> from snowshed.base.pool.process import echo
    >>> with Pool(2, echo) as pool:
    ...     pool.submit("snow")
    ...     [ended.result for ended in pool.collect(60.0)]
    ['snow']
    """

    def __init__(
        self, processes: int, compute: Compute[Task, Result], isolation: Isolation = SHARED
    ) -> None:
        self.capacity = processes
        self._compute = compute
        self._isolation = isolation
        self._processes: list[_Process[Task, Result]] = []

    def __enter__(self) -> Pool[Task, Result]:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    @property
    def process_ids(self) -> list[int]:
        """The ids of the processes that have been started and not ended yet."""
        return [process.id for process in self._processes]

    @property
    def fractions(self) -> list[tuple[Task, float]]:
        """Tasks under way, each with its finished share."""
        return [(busy.task, busy.done) for busy in self._processes if busy.task is not None]

    def submit(self, task: Task) -> None:
        """Start computing a task in an idle process, or a new one."""
        while True:
            idle = next((process for process in self._processes if process.task is None), None)
            if idle is None:
                idle = _Process(self._compute, self._isolation)
                self._processes.append(idle)
            if idle.start(task):
                return
            self._discard(idle)  # the process died while it was idle

    def collect(self, timeout: float) -> list[TaskEnd[Task, Result]]:
        """Wait until a task ends, at most `timeout` s; return the ended tasks."""
        give_up = time.monotonic() + timeout
        while True:
            ended = self._receive(max(0.0, give_up - time.monotonic()))
            if ended or not self._busy() or time.monotonic() >= give_up:
                return ended

    def stop(self) -> list[TaskEnd[Task, Result]]:
        """Ask all tasks to stop at a safe point; return the tasks that ended meanwhile."""
        for process in self._busy():
            process.interrupt()
        ended: list[TaskEnd[Task, Result]] = []
        give_up = time.monotonic() + STOP_S
        while self._busy() and time.monotonic() < give_up:
            ended += self.collect(0.1)
        self.close()
        return ended

    def close(self) -> None:
        """End all processes immediately."""
        for process in self._processes:
            process.connection.close()
        while self._processes:
            self._discard(self._processes[-1])

    def _receive(self, timeout: float) -> list[TaskEnd[Task, Result]]:
        """Receive messages that arrive within `timeout` s; end processes that hang."""
        busy = self._busy()
        left = min((process.left_s for process in busy), default=timeout)
        readable = wait([process.connection for process in busy], min(timeout, max(0.0, left)))
        messages = (process.receive() for process in busy if process.connection in readable)
        ended = [message for message in messages if message]
        ended += [process.give_up() for process in self._busy() if process.left_s <= 0.0]
        for process in [process for process in self._processes if process.dead]:
            self._discard(process)
        return ended

    def _busy(self) -> list[_Process[Task, Result]]:
        return [process for process in self._processes if process.task is not None]

    def _discard(self, process: _Process[Task, Result]) -> None:
        process.end()
        self._processes.remove(process)


class _Process(Generic[Task, Result]):
    """A process and its current task."""

    def __init__(self, compute: Compute[Task, Result], isolation: Isolation) -> None:
        self._limit_s = isolation.limit_s
        self._errors = tempfile.TemporaryFile("a+b")  # noqa: SIM115 - `end` closes it
        ours, theirs = socket.socketpair()
        with theirs:
            # In its own session it does not receive Ctrl-C; the owner of the pool stops it. The
            # current folder is not searched for modules.
            self._process = subprocess.Popen(
                [sys.executable, "-m", "snowshed.base.pool.process", str(theirs.fileno())]
                + ["forked"] * isolation.forked
                + ["shell"] * is_called_from_shell(),
                pass_fds=[theirs.fileno()],
                start_new_session=True,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=self._errors,
                cwd="/",
                env={
                    **os.environ,
                    **isolation.environment,
                    "PYTHONPATH": os.pathsep.join(_absolute(sys.path)),
                },
            )
        self.connection = Connection(ours.detach())
        self.task: Optional[Task] = None
        self.done = 0.0
        self.dead = False
        self._began = time.monotonic()
        self._ready = False
        with suppress(OSError):  # the process has ended; its first task will report it
            self.connection.send(compute)

    @property
    def id(self) -> int:
        return self._process.pid

    @property
    def left_s(self) -> float:
        """Remaining time of its task, s; a starting process has no limit."""
        return float("inf") if not self._ready else self._began + self._limit_s - time.monotonic()

    def start(self, task: Task) -> bool:
        """Hand over a task; return False if the process died while it was idle."""
        try:
            self.connection.send(task)
        except OSError:
            if self._ready:
                return False
        self.task, self.done, self._began = task, 0.0, time.monotonic()
        return True

    def receive(self) -> Optional[TaskEnd[Task, Result]]:
        """Receive a message; return the end of the task if it reports one."""
        assert self.task is not None
        try:
            message = self.connection.recv()
        except (EOFError, OSError):
            return self._death(self.task)
        if isinstance(message, Fraction):
            self.done = message.done
        if isinstance(message, ProcessReady):
            self._ready, self._began = True, time.monotonic()
        if not isinstance(message, (TaskResult, TaskError, ForkDeath)):
            return None
        task, self.task = self.task, None
        if isinstance(message, ForkDeath):
            return TaskEnd(task, death=_ending(message.code), last_words=self._last_error_line())
        if isinstance(message, TaskError):
            return TaskEnd(task, error=message.error)
        return TaskEnd(task, cast(Result, message.result))

    def interrupt(self) -> None:
        """Ask the task to stop."""
        self._signal(signal.SIGTERM)

    def give_up(self) -> TaskEnd[Task, Result]:
        """Kill the process after a timeout."""
        assert self.task is not None
        task, self.task, self.dead = self.task, None, True
        self._signal(signal.SIGKILL)
        return TaskEnd(task, death=f"took more than {self._limit_s:g} s", hung=True)

    def end(self) -> None:
        """Close the socket, which tells the process to end, and wait until it has ended."""
        self._wait()
        self._errors.close()

    def _wait(self) -> int:
        """Close the socket, kill a process that does not end, and return its exit code."""
        self.connection.close()
        try:
            return self._process.wait(END_S)
        except subprocess.TimeoutExpired:
            self._signal(signal.SIGKILL)
            return self._process.wait()

    def _death(self, task: Task) -> TaskEnd[Task, Result]:
        self.dead, self.task = True, None
        code = self._wait()
        never_began = code >= 0 and not self._ready
        return TaskEnd(
            task, death=_ending(code), last_words=self._last_error_line(), never_began=never_began
        )

    def _signal(self, number: signal.Signals) -> None:
        """Send a signal to the process and its fork."""
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, number)

    def _last_error_line(self) -> str:
        """Return the last line on stderr since the previous call; empty if there is none."""
        size = self._errors.seek(0, os.SEEK_END)
        self._errors.seek(max(0, size - STDERR_TAIL_BYTES))
        lines = self._errors.read().decode(errors="replace").strip().splitlines()
        self._errors.truncate(0)
        return lines[-1].strip() if lines else ""


def _ending(code: int) -> str:
    if code < 0:
        return f"was killed by signal {-code} ({signal.strsignal(-code)})"
    return f"ended with code {code}"


def _absolute(paths: Iterable[str]) -> list[str]:
    return [os.path.abspath(path) for path in paths]  # noqa: PTH100 - "" is the current folder
