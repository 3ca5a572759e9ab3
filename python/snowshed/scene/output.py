"""The output of a run besides its tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

from snowshed.base.record import Record, default


@dataclass
class Output(Record):
    """Files that a run writes besides its tables.

    Attributes
    ----------
    snapshot_interval : float
        Simulated time between particle snapshots; 0: only at the end of an event [s]. 0 <= value
        <= 1e+09; default 0.
    film : bool
        Record the particles over time, for snowshed view. Default True.
    film_interval : float
        Simulated time between frames of the film; 0: chosen by the expected duration of an event
        [s]. 0 <= value <= 1e+09; default 0.
    energy : bool
        Keep the energy balance. Default False.
    forces : bool
        Record the forces between the snow and what it meets. Default False.
    force_interval : float
        Simulated time between rows of forces.csv, each the mean since the row before [s]. 0.0001
        <= value <= 1e+09; default 0.01.
    checkpoint_interval : float
        Wall time between checkpoints; 0: none [s]. 0 <= value <= 1e+09; default 60.
    """

    snapshot_interval: Optional[float] = default(0.0)
    film: Optional[bool] = default(True)
    film_interval: Optional[float] = default(0.0)
    energy: Optional[bool] = default(False)
    forces: Optional[bool] = default(False)
    force_interval: Optional[float] = default(0.01)
    checkpoint_interval: Optional[float] = default(60.0)
