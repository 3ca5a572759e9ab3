"""Snow on photovoltaic modules: losses, coverage and blocked days, by a short name."""

from snowshed.analysis.photovoltaics import (
    blocked_days,
    coverage_nrel,
    loss_townsend,
    monthly_table,
    pile_angle,
    plane_irradiance,
)

__all__ = [
    "blocked_days",
    "coverage_nrel",
    "loss_townsend",
    "monthly_table",
    "pile_angle",
    "plane_irradiance",
]
