"""Progress of long work: one form for runs, studies, regressions and all that shows them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Optional


@dataclass(frozen=True)
class Progress:
    """The progress of long work.

    Attributes
    ----------
    fraction
        Part of the work that is done, 0 to 1.
    done, count
        Units of work that are done, and how many there are in all.
    unit
        What the units are called: events of a run, runs of a study, folds of a regression.
    doing
        What is being done now, in words; may be empty.
    failed
        Units that have failed; they are not among those that are done.
    running, elsewhere
        Units that this process's workers compute now, and that other processes compute.
    at_once
        Units that are computed at once.
    expected_s
        Time that the work left at the start was expected to take, s; None: not known.
    left_s
        Time that is expected to be left, s; None: not known.
    event, time
        Of a run: the event that is running, from 1, and the simulated time in it, s.
    updates_per_s
        Of a run: particle updates per second; 0: not known yet.

    Examples
    --------
    >>> Progress(0.5, 3, 9, "runs", failed=1, running=2).description
    '3/9 runs, 1 failed, 2 running'
    """

    fraction: float
    done: int
    count: int
    unit: str
    doing: str = ""
    failed: int = 0
    running: int = 0
    elsewhere: int = 0
    at_once: int = 1
    expected_s: Optional[float] = None
    left_s: Optional[float] = None
    event: int = 0
    time: float = 0.0
    updates_per_s: float = 0.0

    @property
    def description(self) -> str:
        """The counts and what is being done, in one line."""
        parts = [f"{self.done}/{self.count} {self.unit}"]
        parts += [f"{self.failed} failed"] if self.failed else []
        parts += [f"{self.running} running"] if self.running else []
        parts += [f"{self.elsewhere} in other processes"] if self.elsewhere else []
        parts += [self.doing] if self.doing else []
        return ", ".join(parts)


#: Takes each `Progress`, a few times a second.
Reporter = Callable[[Progress], None]
