"""Mean forces of a driven simulation, from the impulses on its obstacles."""

from __future__ import annotations

import numpy as np

from snowshed.base.arrays import Floats
from validation.framework.drive import TimedEventDriver


def impulse_on(drive: TimedEventDriver, name: str) -> Floats:
    """Return the impulse (3,) on an obstacle since the start, N s."""
    now = drive.core.obstacle_forces()
    impulse: Floats = np.asarray(now["impulse"])[now["obstacle"].index(name)]
    return impulse


def mean_force(drive: TimedEventDriver, name: str, until: float) -> Floats:
    """Run to a time, s, and return the mean force (3,) on an obstacle until then, N."""
    before, begin = impulse_on(drive, name), drive.core.time_s
    drive.run_to(until)
    return (impulse_on(drive, name) - before) / (drive.core.time_s - begin)
