"""The task that a worker is given, and the outcome that it returns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Optional


@dataclass(frozen=True)
class RunTask:
    """A run for a worker.

    Attributes
    ----------
    hash, scene
        Content hash and scene of the run.
    folder
        Working folder; an earlier attempt there is resumed.
    threads
        Number of threads that the run may use.
    keep_particles
        Whether its outcome holds the particles after each event.
    build
        The build of snowshed that must compute it; empty: any.
    """

    hash: str
    scene: str
    folder: str
    threads: int
    keep_particles: bool = False
    build: str = ""


@dataclass(frozen=True)
class RunOutcome:
    """The outcome of a run.

    Attributes
    ----------
    hash
        Content hash of the run.
    status
        - done: all events are there;
        - failed: the simulation could not continue, and would fail again;
        - interrupted: stopped on request, and can be resumed;
        - lost: the worker died, or ran out of memory;
        - unable: the machine could not compute it, for example because its disk is full.
    events
        One row per completed event, as in events.csv.
    timing
        Facts about the computing, as in the table ``run_timing`` of the store.
    error
        Reason why the run is not done.
    particles
        Packed results of each completed event (see `MethodRun.stored_data`), by event; empty
        unless the task asked for them.
    notes
        Notes on the results, as in run.json.
    """

    hash: str
    status: str
    events: Sequence[Mapping[str, Any]] = ()
    timing: Mapping[str, Any] = field(default_factory=dict)
    error: Optional[str] = None
    particles: Mapping[int, bytes] = field(default_factory=dict)
    notes: Sequence[str] = ()
