"""The pool of processes: results, errors and deaths of tasks, and the end of the processes."""

import os
import signal
import sys
import time
from functools import partial
from pathlib import Path

import pytest

from snowshed.base.pool.pool import Isolation, Pool


def work(offset, task, report):
    """Add the offset to a task; or fail, die or wait, as the task's text says."""
    if task == "raise":
        raise ValueError("no such snow")
    if task == "raise strangely":
        raise StrangeError("one", "two")
    if task == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    if task == "wait":
        report(0.5)
        time.sleep(600)
    return task + offset


class StrangeError(Exception):
    """An exception that does not survive pickling."""

    def __init__(self, text, detail):
        super().__init__(text)


@pytest.fixture
def pool(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    with Pool(2, partial(work, 10)) as pool_of_two:
        yield pool_of_two


def ended_tasks(pool, count):
    ended = []
    while len(ended) < count:
        ended += pool.collect(120.0)
    return ended


def test_processes_are_reused_for_further_tasks(pool):
    for task in (1, 2):
        pool.submit(task)
    assert sorted(ended.result for ended in ended_tasks(pool, 2)) == [11, 12]
    processes = pool.process_ids
    pool.submit(3)
    assert [(ended.task, ended.result) for ended in ended_tasks(pool, 1)] == [(3, 13)]
    assert pool.process_ids == processes


@pytest.mark.parametrize(
    ("task", "kind", "message"),
    [("raise", ValueError, "no such snow"), ("raise strangely", RuntimeError, "StrangeError: one")],
)
def test_an_exception_of_a_task_is_returned_and_its_process_survives(pool, task, kind, message):
    pool.submit(task)
    (ended,) = ended_tasks(pool, 1)
    assert type(ended.error) is kind and str(ended.error) == message and ended.death == ""
    pool.submit(1)
    assert ended_tasks(pool, 1)[0].result == 11
    assert len(pool.process_ids) == 1


def test_a_killed_process_is_reported_and_other_tasks_continue(pool):
    pool.submit("wait")
    pool.submit("die")
    (ended,) = ended_tasks(pool, 1)
    assert (ended.task, ended.death) == ("die", "was killed by signal 9 (Killed)")
    assert not ended.never_began
    while pool.fractions != [("wait", 0.5)]:
        pool.collect(0.1)


def test_closing_the_pool_ends_busy_processes(pool):
    pool.submit("wait")
    while not pool.fractions or not pool.fractions[0][1]:
        pool.collect(0.1)
    (process,) = pool.process_ids
    pool.close()
    with pytest.raises(ProcessLookupError):
        os.kill(process, 0)


def test_a_task_that_is_asked_to_stop_ends(pool):
    pool.submit("wait")
    while not pool.fractions[0][1]:
        pool.collect(0.1)
    (ended,) = pool.stop()
    assert ended.death == "was killed by signal 15 (Terminated)"  # it handles no signals


def test_processes_that_cannot_start_are_reported(monkeypatch):
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with Pool(1, partial(work, 1)) as pool:
        pool.submit(1)
        (ended,) = ended_tasks(pool, 1)
    assert ended.never_began and ended.death == "ended with code 1"


REMEMBERED = []


def remember(task, report):
    """Return the tasks that this process has received; or crash or hang."""
    if task == "crash":
        os.write(2, b"early\nout of snow\n")
        os.abort()
    if task == "wait":
        report(0.5)
        time.sleep(600)
    REMEMBERED.append(task)
    return list(REMEMBERED), os.environ.get("SNOW"), os.getppid()


@pytest.fixture
def forks(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    with Pool(1, remember, Isolation(forked=True, environment={"SNOW": "dry"})) as forking_pool:
        yield forking_pool


def test_forked_tasks_share_a_parent_and_no_state(forks):
    forks.submit(1)
    (first,) = ended_tasks(forks, 1)
    forks.submit("crash")
    (crash,) = ended_tasks(forks, 1)
    forks.submit(2)
    (second,) = ended_tasks(forks, 1)
    assert first.result == ([1], "dry", forks.process_ids[0])
    assert (crash.death, crash.last_words) == ("was killed by signal 6 (Aborted)", "out of snow")
    assert second.result == ([2], "dry", forks.process_ids[0])


def test_a_fork_ends_when_it_is_asked_to_stop(forks):
    forks.submit("wait")
    while not forks.fractions[0][1]:
        forks.collect(0.1)
    (ended,) = forks.stop()
    assert ended.death == "was killed by signal 15 (Terminated)"


@pytest.mark.parametrize("forked", [False, True])
def test_a_task_beyond_the_time_limit_is_killed_and_the_next_is_computed(monkeypatch, forked):
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    with Pool(1, remember, Isolation(forked=forked, limit_s=5.0)) as pool:
        pool.submit("wait")
        (ended,) = ended_tasks(pool, 1)
        assert ended.hung and ended.death == "took more than 5 s"
        pool.submit(1)
        assert ended_tasks(pool, 1)[0].result[0] == [1]
