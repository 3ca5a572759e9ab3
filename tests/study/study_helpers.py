"""Studies that take a moment, and workers that return scripted outcomes."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest

from snowshed import Scene
from snowshed.results.folder import WORDS
from snowshed.study import Study, session
from snowshed.study.database import FILE, MEASURED_TYPES
from snowshed.study.outcome import RunOutcome

SEQUENTIAL = {"jobs": 1, "threads": 1}


def tiny_scene(max_time: float = 0.05, events: int = 2) -> Scene:
    """The lab's 50 degree scene in 2D on a coarse grid; by default events end in free fall."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    return scene.update({"events": {"count": events, "max_time": max_time}})


def tiny_study(name: str = "tiny", frictions: tuple[float, ...] = (0.1, 0.2, 0.3)) -> Study:
    return Study.product(tiny_scene(), {"panel.friction": frictions}, name=name)


def outcome(
    hash_: str, status: str = "done", events: int = 2, error: str | None = None
) -> RunOutcome:
    """A possible outcome of a run; each measure is a different small number."""
    rows = [
        {
            "event": event,
            "wall_s": 0.5,
            **{
                name: "rest" if name in WORDS else event * 10 + index
                for index, name in enumerate(MEASURED_TYPES)
            },
        }
        for event in range(1, events + 1)
    ]
    return RunOutcome(hash_, status, rows, {"run_wall_s": 1.0, "threads": 1}, error)


class ScriptedWorkers:
    """Workers that return `answer(task)` at once."""

    capacity = 2

    def __init__(self, answer=lambda task: outcome(task.hash)):
        self.answer = answer
        self.fractions = {}
        self.tasks = []
        self.open = []
        self.stopped = self.closed = False

    def threads(self, unfinished):
        return 1

    def submit(self, task):
        assert len(self.open) < self.capacity
        self.tasks.append(task)
        self.open.append(task)

    def collect(self, timeout):
        assert self.open
        return [self.answer(self.open.pop(0))]

    def stop(self):
        self.stopped = True
        ended = [self.answer(task) for task in self.open]
        self.open.clear()
        return ended

    def close(self):
        self.closed = True


def contents(folder: Path) -> dict[str, list[tuple]]:
    """The content of a store that is the same in every computation."""
    connection = sqlite3.connect(folder / FILE)
    try:
        return {
            table: connection.execute(f"SELECT * FROM {table} ORDER BY 1, 2").fetchall()
            for table in ("study", "study_run", "run", "event")
        }
    finally:
        connection.close()


@pytest.fixture(scope="session")
def computed_folder(tmp_path_factory):
    """The folder of the tiny study, computed without interruption, once for all test files."""
    folder = tmp_path_factory.getbasetemp() / "computed-tiny-study"
    if not folder.exists():
        tiny_study().run(folder, **SEQUENTIAL)
    return folder


@pytest.fixture
def scripted_workers(monkeypatch):
    """Scripted workers instead of processes."""
    workers = ScriptedWorkers()
    monkeypatch.setattr(session.Resources, "workers", lambda resources, scenes: (workers, 2))
    monkeypatch.setattr(session, "POLL_S", 0.01)
    monkeypatch.setattr(session, "ELSEWHERE_S", 0.0)
    return workers
