"""Values of the snow's parameters in studies of sensitivity, SI units.

Sections and tables are those of Frischholz (2023), chapter 3.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

SLOPE = "snow.critical_state_slope"
PRESSURE = "snow.preconsolidation_pressure"
COHESION = "snow.cohesion"
HARDENING = "snow.hardening_factor"
MODULUS = "snow.youngs_modulus"

#: Values of each parameter: low, reference, high (Table 3.2.1).
VALUES: Mapping[str, Sequence[float]] = {
    SLOPE: (0.3, 0.5, 0.7),
    PRESSURE: (2e3, 5e3, 8e3),
    COHESION: (0.1, 0.2, 0.3),
    HARDENING: (0.1, 0.2, 1.0),
    MODULUS: (1e6, 2e6, 3e6),
}
#: Parameters that vary together, the others at their reference (section 3.4).
GROUPS: Mapping[str, Sequence[str]] = {
    "yield": (SLOPE, PRESSURE, COHESION),
    "hardening": (HARDENING, MODULUS),
}
#: Nominal and altered values (Table 3.3.1).
PAIRS: Mapping[str, tuple[float, float]] = {
    SLOPE: (0.3, 0.6),
    PRESSURE: (3e3, 6e3),
    COHESION: (0.15, 0.3),
    HARDENING: (0.1, 0.2),
    MODULUS: (1e6, 2e6),
}
