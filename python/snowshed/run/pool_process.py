"""A process of a `Pool`: ``python -m snowshed.run.pool_process SOCKET``.

It ends as soon as the other end of its socket is closed, so it never outlives who started it, not
even one that was killed.
"""

from __future__ import annotations

import os
import pickle
import queue
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection

from snowshed.run.pool_messages import Done, Fraction, Raised, Ready

Compute = Callable[[object, Callable[[float], None]], object]


def main(handle: int) -> None:
    """Compute the tasks that arrive on a socket, one after another."""
    connection = Connection(handle)
    with suppress(EOFError, OSError):  # nobody listens any more
        compute: Compute = connection.recv()
        tasks: queue.SimpleQueue[object] = queue.SimpleQueue()
        # The main thread must compute: only there a signal can ask a task to stop.
        threading.Thread(target=_listen, args=(connection, tasks), daemon=True).start()
        connection.send(Ready())
        while True:
            connection.send(_computed(compute, tasks.get(), connection))


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
    main(int(sys.argv[1]))
