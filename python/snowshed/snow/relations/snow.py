"""Parameters of the simulated snow from its density."""

from __future__ import annotations

from typing import Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.scene.components import Snow
from snowshed.snow.relations.relation import choose
from snowshed.snow.relations.stiffness import YOUNGS_MODULUS
from snowshed.snow.relations.strength import TENSILE_STRENGTH


@checked
def snow_from_density(
    density: float,
    *,
    youngs_modulus: Optional[str] = None,
    tensile_strength: Optional[str] = None,
    strength_factor: float = 1.0,
    base: str = "calibrated",
) -> Snow:
    """Return snow of a density, with parameters from published relations.

    Parameters
    ----------
    density
        Density, kg/m3.
    youngs_modulus
        A name in `YOUNGS_MODULUS`; None keeps that of the base.
    tensile_strength
        A name in `TENSILE_STRENGTH`. Then the preconsolidation pressure is the strength over the
        cohesion, p0 = sigma / beta, as in the thesis (3.2). None keeps that of the base.
    strength_factor
        Factor on the strength. The thesis took the smallest measured values for its loose, sieved
        snow; the calibrated snow has 0.21 times the strength of sigrist-2006.
    base
        The snow with all other parameters: "calibrated" or "reference".

    Raises
    ------
    InputError
        If a relation is unknown or the density is not one of snow.

    Examples
    --------
    >>> snow = snow_from_density(210.0, tensile_strength="sigrist-2006", strength_factor=0.21)
    >>> round(snow.preconsolidation_pressure), snow.youngs_modulus
    (6909, 1000000.0)
    """
    snow = Snow.preset(base)
    snow.density = density
    if youngs_modulus is not None:
        snow.youngs_modulus = choose(youngs_modulus, YOUNGS_MODULUS, "Young's modulus")(density)
    if tensile_strength is not None:
        if not snow.cohesion:
            raise InputError(f"the snow {base!r} has no cohesion for a tensile strength to act on")
        strength = choose(tensile_strength, TENSILE_STRENGTH, "tensile strength")(density)
        snow.preconsolidation_pressure = strength_factor * strength / snow.cohesion
    return snow
