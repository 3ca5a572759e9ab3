"""A process that computes runs for `LocalWorkers`: ``python -m snowshed.study.worker SOCKET``.

It ends as soon as the other end of its socket is closed, so it never outlives who started it, not
even one that was killed.
"""

from __future__ import annotations

import os
import queue
import sys
import threading
from contextlib import suppress
from multiprocessing.connection import Connection

from snowshed.study.compute import compute
from snowshed.study.outcome import Fraction, Outcome, Ready, Task


def main(handle: int) -> None:
    """Compute the tasks that arrive on a socket, one after another."""
    connection = Connection(handle)
    tasks: queue.SimpleQueue[Task] = queue.SimpleQueue()
    # The main thread must compute: only there a signal can ask a run to stop at a checkpoint.
    threading.Thread(target=_listen, args=(connection, tasks), daemon=True).start()
    with suppress(OSError):  # nobody listens any more
        connection.send(Ready())
        while True:
            connection.send(_computed(tasks.get(), connection))


def _computed(task: Task, connection: Connection) -> Outcome:
    return compute(task, lambda done: connection.send(Fraction(task.hash, done)))


def _listen(connection: Connection, tasks: queue.SimpleQueue[Task]) -> None:
    try:
        while True:
            tasks.put(connection.recv())
    except (EOFError, OSError):
        os._exit(1)


if __name__ == "__main__":
    main(int(sys.argv[1]))
