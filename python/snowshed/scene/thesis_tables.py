"""The numbers of the thesis's tables that designs, checks and reports share, in SI units.

Presets of whole scenes (``snowshed.Scene.preset``) are the core's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

SLOPE = "snow.critical_state_slope"
PRESSURE = "snow.preconsolidation_pressure"
COHESION = "snow.cohesion"
HARDENING = "snow.hardening_factor"
MODULUS = "snow.youngs_modulus"

#: Table 3.2.1: the values of the snow's parameters in the sensitivity analysis.
SENSITIVITY: Mapping[str, Sequence[float]] = {
    SLOPE: (0.3, 0.5, 0.7),
    PRESSURE: (2e3, 5e3, 8e3),
    COHESION: (0.1, 0.2, 0.3),
    HARDENING: (0.1, 0.2, 1.0),
    MODULUS: (1e6, 2e6, 3e6),
}
#: Section 3.4: the parameters that vary together, the others at their reference.
GROUPS: Mapping[str, Sequence[str]] = {
    "yield": (SLOPE, PRESSURE, COHESION),
    "hardening": (HARDENING, MODULUS),
}
#: Table 3.3.1: nominal and altered values.
PAIRS: Mapping[str, tuple[float, float]] = {
    SLOPE: (0.3, 0.6),
    PRESSURE: (3e3, 6e3),
    COHESION: (0.15, 0.3),
    HARDENING: (0.1, 0.2),
    MODULUS: (1e6, 2e6),
}
#: Table 4.1.1: the triplets of the calibration.
CALIBRATION: Mapping[str, Sequence[float]] = {
    SLOPE: (0.4, 0.5, 0.6, 0.7),
    PRESSURE: (4e3, 5e3, 6e3, 7e3),
    COHESION: (0.05, 0.1, 0.2),
}
#: Table 4.3.1: the calibrated triplet.
CALIBRATED: Mapping[str, float] = {SLOPE: 0.5, PRESSURE: 7e3, COHESION: 0.2}
#: Tilts of the laboratory's panel from which snow slid in chapters 2 and 4, degrees.
LABORATORY_TILTS = (40.0, 50.0)
LABORATORY_EVENTS = 5

#: Tables 5.1.1 and 5.2.1: heights and lengths of the panels at 40 degrees, m.
PANEL_HEIGHTS = (1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)
PANEL_LENGTHS = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 6.0, 8.0, 10.0)
#: And at steeper tilts.
STEEP_TILTS = (50.0, 60.0, 70.0)
STEEP_HEIGHTS = (2.0, 3.0, 4.0)
STEEP_LENGTHS = (0.5, 1.5, 2.0, 4.0, 8.0)
