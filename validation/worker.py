"""A process that measures, each time in a fork of itself.

A measurement must not see what another left behind, least of all its memory, yet starting Python
and importing libraries takes longer than many a measurement. So one server process imports what is
to be measured, and what measurements before it imported, and forks for each request. It never runs
a solver itself: OpenMP's threads do not survive a fork, so they must not exist before it.
"""

from __future__ import annotations

import importlib
import os
import pickle
import signal
import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Optional

from snowshed._core import SimulationError

from snowshed.analysis.verification.measurements import Settings
from snowshed.run.machine import peak_memory_mb
from validation.case import Outcome

Measure = Callable[[Settings], Outcome]


@dataclass(frozen=True)
class Answer:
    """The result of a measurement: an outcome, or else the reason why there is none.

    ``imported`` names the modules that it imported.
    """

    outcome: Optional[Outcome]
    failure: str = ""
    peak_memory_mb: float = 0.0
    elapsed_s: float = 0.0
    imported: Sequence[str] = ()


class Worker:
    """Measures in processes of their own, one after another; a context manager.

    What measures must be a function of a module, which the other process imports.

    Examples
    --------
    >>> from validation.suite import load_cases
    >>> case = load_cases(["material_paths"])[0]
    >>> with Worker() as worker:
    ...     worker.measure(case.measure, case.matrix(False)[0]).failure
    ''
    """

    def __enter__(self) -> Worker:
        # In a session of its own, Ctrl-C does not reach it: the parent decides what ends.
        self._server = subprocess.Popen(
            [sys.executable, "-m", "validation.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            start_new_session=True,
        )
        self._to_import: Sequence[str] = ()
        return self

    def __exit__(
        self,
        kind: Optional[type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        if error is not None and self._server.poll() is None:
            os.killpg(self._server.pid, signal.SIGKILL)
        self._server.communicate()

    def measure(self, measure: Measure, settings: Settings) -> Answer:
        """Solve once and return the outcome, or what went wrong.

        Raises
        ------
        SimulationError
            If the other process has ended, which no measurement should bring about.
        """
        assert self._server.stdin is not None
        assert self._server.stdout is not None
        # Pickled twice: what cannot be imported over there is still read to its end.
        request = pickle.dumps((self._to_import, measure, dict(settings)))
        self._server.stdin.write(pickle.dumps(request))
        self._server.stdin.flush()
        try:
            answer: Answer = pickle.load(self._server.stdout)
        except EOFError:
            raise SimulationError(
                "the process that measures has ended; go on with --resume"
            ) from None
        self._to_import = answer.imported
        return answer


def serve() -> None:
    """Answer the requests on stdin until it ends; what a measurement prints goes to stderr."""
    with os.fdopen(os.dup(1), "wb", buffering=0) as answers:
        os.dup2(2, 1)
        while True:
            try:
                request = pickle.load(sys.stdin.buffer)
            except EOFError:
                return
            try:
                modules, measure, settings = pickle.loads(request)
            except (ImportError, AttributeError) as error:
                answers.write(pickle.dumps(Answer(None, _reason(error))))
                continue
            for name in modules:
                with suppress(Exception):  # what needs it will say so
                    importlib.import_module(name)
            _answer_in_a_fork(measure, settings, answers)


def _answer_in_a_fork(measure: Measure, settings: Settings, answers: BinaryIO) -> None:
    child = os.fork()
    if child == 0:
        answers.write(pickle.dumps(_answer(measure, settings)))
        sys.stdout.flush()
        os._exit(0)
    _, status = os.waitpid(child, 0)
    if status != 0:
        answers.write(pickle.dumps(Answer(None, f"the process ended {_ending(status)}")))


def _answer(measure: Measure, settings: Settings) -> Answer:
    started, known = time.perf_counter(), set(sys.modules)
    outcome, failure = None, ""
    try:
        outcome = measure(settings)
        if not isinstance(outcome, Outcome):
            raise TypeError(f"measure returned {type(outcome).__name__}, not Outcome")
    except Exception as error:
        outcome, failure = None, _reason(error)
    imported = [name for name in sys.modules if name not in known]
    return Answer(outcome, failure, peak_memory_mb(), time.perf_counter() - started, imported)


def _reason(error: Exception) -> str:
    """Return what went wrong and where, in a line."""
    message = " ".join(str(error).split())
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {message} ({Path(frame.filename).name}:{frame.lineno})"


def _ending(status: int) -> str:
    if os.WIFSIGNALED(status):
        return f"by {signal.Signals(os.WTERMSIG(status)).name}"
    return f"with exit code {os.WEXITSTATUS(status)}"


if __name__ == "__main__":
    # What is pickled must belong to the module under its own name, not to "__main__".
    from validation import worker

    worker.serve()
