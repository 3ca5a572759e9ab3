"""The constants of the thesis's calibrated snow, for laws at a point."""

from __future__ import annotations

from typing import Any, NamedTuple

from snowshed.scene.components import Snow


class Constants(NamedTuple):
    """The constants of modified cohesive Cam-Clay."""

    youngs_modulus: float
    poissons_ratio: float
    critical_state_slope: float
    cohesion: float
    hardening_factor: float


def calibrated_snow() -> tuple[Constants, float]:
    """Return the thesis's calibrated snow, and its initial p0, Pa."""
    snow: dict[str, Any] = Snow.preset("calibrated").to_data()
    return Constants(*(snow[name] for name in Constants._fields)), snow["preconsolidation_pressure"]
