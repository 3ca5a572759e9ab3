"""What is handed to a worker, and what comes back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Optional


@dataclass(frozen=True)
class Task:
    """A run to be computed.

    Attributes
    ----------
    hash, scene
        The run.
    folder
        Where to work; an earlier attempt there is resumed.
    threads
        How many it may use.
    keep_particles
        Whether its outcome holds the particles after each event.
    """

    hash: str
    scene: str
    folder: str
    threads: int
    keep_particles: bool = False


@dataclass(frozen=True)
class Outcome:
    """What became of a run.

    Attributes
    ----------
    hash
        The run.
    status
        - done: all events are there;
        - failed: the simulation could not go on, nor could it if repeated;
        - interrupted: stopped on request, to be resumed;
        - lost: the worker died, or had not memory enough;
        - unable: the machine could not compute it, for example because its disk is full.
    events
        One row per completed event, as in events.csv.
    timing
        Facts about the computing, as in the table ``run_timing`` of the store.
    error
        Why it is not done.
    particles
        Those after each completed event, packed (see `snowshed.run.event_particles`), by events;
        empty unless the task asked for them.
    """

    hash: str
    status: str
    events: Sequence[Mapping[str, Any]] = ()
    timing: Mapping[str, Any] = field(default_factory=dict)
    error: Optional[str] = None
    particles: Mapping[int, bytes] = field(default_factory=dict)
