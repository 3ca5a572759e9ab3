"""Tensile strength of snow over its density.

This is the only published fit that could be compared with a second source. At a given density,
single measurements span an order of magnitude (Perla 1969), and faceted snow has about half the
strength of rounded snow (Jamieson and Johnston 1990).
"""

from __future__ import annotations

from snowshed.snow.relations.relation import ICE_DENSITY, Relation, by_name


def sigrist_2006(density: float) -> float:
    """Return the tensile strength, Pa.

    Examples
    --------
    >>> round(sigrist_2006(210.0) / 1e3, 1)
    6.6
    """
    return float(240e3 * (density / ICE_DENSITY) ** 2.44)


TENSILE_STRENGTH = by_name(
    Relation(
        "sigrist-2006",
        "tensile strength",
        "Pa",
        "240 kPa (rho / 917 kg/m3)^2.44",
        "Sigrist 2006, thesis 16736, ETH Zurich, as cited by Weissgraeber and Rosendahl 2023, "
        "The Cryosphere 17, 1475-1496, eq. 22",
        {"density": (100.0, 400.0)},
        "an order of magnitude between single measurements (Perla 1969)",
        sigrist_2006,
        range_verified=False,
    ),
)
