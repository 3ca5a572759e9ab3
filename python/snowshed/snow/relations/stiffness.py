"""Young's modulus of snow over its density.

The relations differ by an order of magnitude, because they mean different things: computed on the
microstructure (no creep at all), fitted to a bending slab, or measured slowly in a press. The
calibrated snow of the thesis has 1 MPa at 210 kg/m3, less than all relations give. Stacks hardly
depend on the modulus there, and the time step is inversely proportional to its square root.
"""

from __future__ import annotations

import math

from snowshed.snow.relations.relation import ICE_DENSITY, Relation, by_name


def scapozza_2004(density: float) -> float:
    """Return Young's modulus, Pa, from slow compression tests.

    Examples
    --------
    >>> round(scapozza_2004(210.0) / 1e6, 1)
    4.3
    """
    return 0.1873e6 * math.exp(0.0149 * density)


def sigrist_2006(density: float) -> float:
    """Return Young's modulus, Pa, from dynamic tests at 100 Hz.

    Examples
    --------
    >>> round(sigrist_2006(210.0) / 1e6, 1)
    12.7
    """
    return float(1.89 * density**2.94)


def koechle_schneebeli_2014(density: float) -> float:
    """Return Young's modulus, Pa, computed on X-ray images of the microstructure.

    Two fits meet at 250 kg/m3, with a step.

    Examples
    --------
    >>> [round(koechle_schneebeli_2014(rho) / 1e6, 1) for rho in (210.0, 249.9, 250.0)]
    [24.9, 121.1, 94.6]
    """
    if density < 250.0:
        return 0.0061e6 * math.exp(0.0396 * density)
    return 6.0457e6 * math.exp(0.011 * density)


def bergfeld_2023(density: float) -> float:
    """Return Young's modulus, Pa, fitted to the bending of slabs in propagation saw tests.

    Examples
    --------
    >>> round(bergfeld_2023(210.0) / 1e6, 1)
    9.9
    """
    return float(6.5e9 * (density / ICE_DENSITY) ** 4.4)


YOUNGS_MODULUS = by_name(
    Relation(
        "scapozza-2004",
        "Young's modulus",
        "Pa",
        "0.1873 MPa exp(0.0149 rho)",
        "Scapozza 2004, thesis, ETH Zurich; constants as in published collections",
        {"density": (180.0, 450.0)},
        "not verified",
        scapozza_2004,
        range_verified=False,
    ),
    Relation(
        "sigrist-2006",
        "Young's modulus",
        "Pa",
        "1.89 Pa (rho / (1 kg/m3))^2.94",
        "Sigrist 2006, thesis 16736, ETH Zurich; constants as in published collections",
        {"density": (210.0, 360.0)},
        "not verified",
        sigrist_2006,
        range_verified=False,
    ),
    Relation(
        "koechle-schneebeli-2014",
        "Young's modulus",
        "Pa",
        "0.0061 MPa exp(0.0396 rho) below 250 kg/m3; 6.0457 MPa exp(0.011 rho) from there",
        "Koechle and Schneebeli 2014, J. Glaciol. 60, 304-315, eqs. 11 and 12",
        {"density": (150.0, 450.0)},
        "R2 of log E: 0.68 below 250 kg/m3, 0.92 from there",
        koechle_schneebeli_2014,
    ),
    Relation(
        "bergfeld-2023",
        "Young's modulus",
        "Pa",
        "6.5 GPa (rho / 917 kg/m3)^4.4",
        "Bergfeld et al. 2023, Nat. Hazards Earth Syst. Sci. 23, 293-315, eq. 4 and appendix B",
        {"density": (110.0, 363.0)},
        "exponent 4.4 +- 0.18, that is a factor of 1.3 at 210 kg/m3",
        bergfeld_2023,
    ),
)
