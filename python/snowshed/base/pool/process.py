"""A process of a `Pool`: ``python -m snowshed.base.pool.process SOCKET [forked] [shell]``.

It ends as soon as the other end of its socket is closed, so that it never outlives its parent, not
even a killed one.
"""

from __future__ import annotations

import os
import pickle
import queue
import select
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import nullcontext, suppress
from multiprocessing.connection import Connection

from snowshed.base.callers import called_from_shell
from snowshed.base.pool.messages import ForkDeath, Fraction, ProcessReady, TaskError, TaskResult

Compute = Callable[[object, Callable[[float], None]], object]


def main(handle: int, forked: bool) -> None:
    """Compute the tasks that arrive on a socket, one after another, each in a fork if `forked`."""
    connection = Connection(handle)
    with suppress(EOFError, OSError):  # the parent has closed the socket
        compute: Compute = connection.recv()
        (_serve_in_forks if forked else _serve)(compute, connection)


def _serve(compute: Compute, connection: Connection) -> None:
    tasks: queue.SimpleQueue[object] = queue.SimpleQueue()
    # The main thread must compute: only there a signal can ask a task to stop.
    threading.Thread(target=_listen, args=(connection, tasks), daemon=True).start()
    connection.send(ProcessReady())
    while True:
        connection.send(_compute_message(compute, tasks.get(), connection))


def _serve_in_forks(compute: Compute, connection: Connection) -> None:
    # A signal is meant for the fork that computes; without one there is nothing to stop.
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    connection.send(ProcessReady())
    while True:
        try:
            task = connection.recv()
        except (EOFError, OSError):
            return
        except Exception as error:  # the module that the task needs cannot be loaded
            connection.send(TaskError(_picklable_error(error)))
            continue
        child = os.fork()
        if child == 0:
            _compute_and_exit(compute, task, connection)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        if code != 0:
            connection.send(ForkDeath(code))


def _compute_and_exit(compute: Compute, task: object, connection: Connection) -> None:
    code = 1
    try:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        threading.Thread(target=_exit_on_hangup, args=(connection.fileno(),), daemon=True).start()
        connection.send(_compute_message(compute, task, connection))
        code = 0
    finally:
        sys.stderr.flush()
        os._exit(code)


def _exit_on_hangup(handle: int) -> None:
    """End this process when the other end of the socket is closed."""
    poll = select.poll()
    poll.register(handle, 0)  # no event is requested: a hang-up is always reported
    poll.poll()
    os._exit(1)


def echo(task: object, report: Callable[[float], None]) -> object:
    """Return the task itself: the smallest computation."""
    return task


def _compute_message(compute: Compute, task: object, connection: Connection) -> object:
    try:
        return TaskResult(compute(task, lambda done: connection.send(Fraction(done))))
    except Exception as error:  # the caller handles it
        return TaskError(_picklable_error(error))


def _picklable_error(error: Exception) -> Exception:
    """Return the error, or a RuntimeError with its text if it cannot be pickled."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _listen(connection: Connection, tasks: queue.SimpleQueue[object]) -> None:
    try:
        while True:
            tasks.put(connection.recv())
    finally:  # the other end is closed, or its message cannot be read here
        os._exit(1)


if __name__ == "__main__":
    with called_from_shell() if "shell" in sys.argv[2:] else nullcontext():
        main(int(sys.argv[1]), forked="forked" in sys.argv[2:])
