"""Progress of long work, in one form for runs, studies and regressions."""

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
        Finished share of the work, 0 to 1.
    done, count
        Finished units of work, and their total number.
    unit
        Name of the units: events of a run, runs of a study, folds of a regression.
    doing
        Current step; may be empty.
    failed
        Failed units; they are not among the finished ones.
    running, elsewhere
        Units that this process's workers compute now, and those of other processes.
    at_once
        Units that are computed in parallel.
    expected_s
        Expected time of the work that was left at the start, s, if known.
    left_s
        Expected remaining time, s, if known.
    event, time
        Current event of a run, from 1, and its simulated time, s.
    updates_per_s
        Particle updates per second of a run; 0: not known yet.

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
        """The counts and the current step, in one line."""
        parts = [f"{self.done}/{self.count} {self.unit}"]
        parts += [f"{self.failed} failed"] if self.failed else []
        parts += [f"{self.running} running"] if self.running else []
        parts += [f"{self.elsewhere} in other processes"] if self.elsewhere else []
        parts += [self.doing] if self.doing else []
        return ", ".join(parts)


#: Function that receives each `Progress`, a few times a second.
Reporter = Callable[[Progress], None]
