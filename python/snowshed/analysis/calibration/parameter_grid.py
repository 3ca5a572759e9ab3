"""Values of the snow's parameters in the grid of a calibration, SI units.

Sections and tables are those of Frischholz (2023), chapter 4.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

SLOPE = "snow.critical_state_slope"
PRESSURE = "snow.preconsolidation_pressure"
COHESION = "snow.cohesion"

#: Values whose triplets are the grid (Table 4.1.1).
GRID: Mapping[str, Sequence[float]] = {
    SLOPE: (0.4, 0.5, 0.6, 0.7),
    PRESSURE: (4e3, 5e3, 6e3, 7e3),
    COHESION: (0.05, 0.1, 0.2),
}
#: The corners of the grid, for a trial.
CORNERS: Mapping[str, Sequence[float]] = {
    SLOPE: (min(GRID[SLOPE]), max(GRID[SLOPE])),
    PRESSURE: (min(GRID[PRESSURE]), max(GRID[PRESSURE])),
    COHESION: GRID[COHESION],
}
