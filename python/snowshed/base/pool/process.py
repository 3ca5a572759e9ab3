"""A process of a `Pool`: ``python -m snowshed.base.pool.process SOCKET [forked]``.

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
from contextlib import suppress
from multiprocessing.connection import Connection

from snowshed.base.pool.messages import Died, Done, Fraction, Raised, Ready

Compute = Callable[[object, Callable[[float], None]], object]


def main(handle: int, forked: bool) -> None:
    """Compute the tasks that arrive on a socket, one after another, each in a fork if so asked."""
    connection = Connection(handle)
    with suppress(EOFError, OSError):  # the parent has closed the socket
        compute: Compute = connection.recv()
        (_serve_in_forks if forked else _serve)(compute, connection)


def _serve(compute: Compute, connection: Connection) -> None:
    tasks: queue.SimpleQueue[object] = queue.SimpleQueue()
    # The main thread must compute: only there a signal can ask a task to stop.
    threading.Thread(target=_listen, args=(connection, tasks), daemon=True).start()
    connection.send(Ready())
    while True:
        connection.send(_computed(compute, tasks.get(), connection))


def _serve_in_forks(compute: Compute, connection: Connection) -> None:
    # A signal is meant for the fork that computes; without one there is nothing to stop.
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    connection.send(Ready())
    while True:
        try:
            task = connection.recv()
        except (EOFError, OSError):
            return
        except Exception as error:  # the module that the task needs does not load
            connection.send(Raised(_portable(error)))
            continue
        child = os.fork()
        if child == 0:
            _compute_and_exit(compute, task, connection)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        if code != 0:
            connection.send(Died(code))


def _compute_and_exit(compute: Compute, task: object, connection: Connection) -> None:
    code = 1
    try:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        threading.Thread(target=_end_with, args=(connection.fileno(),), daemon=True).start()
        connection.send(_computed(compute, task, connection))
        code = 0
    finally:
        sys.stderr.flush()
        os._exit(code)


def _end_with(handle: int) -> None:
    """End this process when the other end of the socket is closed."""
    poll = select.poll()
    poll.register(handle, 0)  # a hang-up is reported without being asked for
    poll.poll()
    os._exit(1)


def echo(task: object, report: Callable[[float], None]) -> object:
    """Return the task itself: the smallest computation."""
    return task


def _computed(compute: Compute, task: object, connection: Connection) -> object:
    try:
        return Done(compute(task, lambda done: connection.send(Fraction(done))))
    except Exception as error:  # it is the caller's to judge
        return Raised(_portable(error))


def _portable(error: Exception) -> Exception:
    """Return the error, or its text where it cannot be sent to another process."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _listen(connection: Connection, tasks: queue.SimpleQueue[object]) -> None:
    try:
        while True:
            tasks.put(connection.recv())
    finally:  # the other end is closed, or sends what cannot be read here
        os._exit(1)


if __name__ == "__main__":
    main(int(sys.argv[1]), forked=sys.argv[2:] == ["forked"])
