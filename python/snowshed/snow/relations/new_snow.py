"""Density of snow as it falls, from the temperature of the air and the wind.

None of these is good: in the Sierra Nevada, temperature explained 27 % of the variance of 403
densities and left a standard error of 38 kg/m3 (McGurk, Azuma and Kattelmann 1988); in Colorado the
correlation was 0.52 and densities ranged from 10 to 257 kg/m3 (Judson and Doesken 2000). Against
hourly alpine measurements (68 kg/m3 on average, standard deviation 9) most parametrisations come
out too high (Helfricht et al. 2018). A measured density is always better.
"""

from __future__ import annotations

import math

from snowshed.snow.relations.relation import Relation, by_name

SCATTER = "about 40 kg/m3 (standard error of a fit over temperature, McGurk et al. 1988)"


def hedstrom_pomeroy_1998(temperature: float) -> float:
    """Return the density of new snow, kg/m3, at an air temperature in degrees C.

    Examples
    --------
    >>> round(hedstrom_pomeroy_1998(-5.0), 1)
    75.4
    """
    return 67.92 + 51.25 * math.exp(min(temperature, 0.0) / 2.59)


def jordan_1999(temperature: float, wind: float = 0.0) -> float:
    """Return the density of new snow, kg/m3, at an air temperature in degrees C and a wind in m/s.

    Examples
    --------
    >>> [round(jordan_1999(-20.0, wind)) for wind in (0, 5, 10)]
    [48, 100, 197]
    """
    kelvin = min(temperature + 273.15, 275.65)
    if kelvin <= 260.15:
        return 500.0 * (1.0 - 0.904 * math.exp(-0.008 * wind**1.7))
    exponent = -1.4 * (278.15 - kelvin) ** -1.15 - 0.008 * wind**1.7
    return 500.0 * (1.0 - 0.951 * math.exp(exponent))


def vionnet_2012(temperature: float, wind: float = 0.0) -> float:
    """Return the density of new snow, kg/m3, at an air temperature in degrees C and a wind in m/s.

    Examples
    --------
    >>> vionnet_2012(0.0), vionnet_2012(-30.0)
    (109.0, 50.0)
    """
    return max(50.0, 109.0 + 6.0 * min(temperature, 0.0) + 26.0 * math.sqrt(wind))


NEW_SNOW_DENSITY = by_name(
    Relation(
        "hedstrom-pomeroy-1998",
        "density of new snow",
        "kg/m3",
        "67.92 + 51.25 exp(T / 2.59)",
        "Hedstrom and Pomeroy 1998, Hydrol. Process. 12, 1611-1625; constants as in Noah-MP",
        {"temperature": (-20.0, 0.0)},
        SCATTER,
        hedstrom_pomeroy_1998,
        range_verified=False,
    ),
    Relation(
        "jordan-1999",
        "density of new snow",
        "kg/m3",
        "500 (1 - 0.951 exp(-1.4 (278.15 - T)^-1.15 - 0.008 u^1.7)), T in K; "
        "500 (1 - 0.904 exp(-0.008 u^1.7)) below 260.15 K",
        "Jordan, Andreas and Makshtas 1999, J. Geophys. Res. 104, 7785-7806; constants as in two "
        "published codes",
        {"temperature": (-40.0, 2.5), "wind": (0.0, 15.0)},
        SCATTER,
        jordan_1999,
        range_verified=False,
    ),
    Relation(
        "vionnet-2012",
        "density of new snow",
        "kg/m3",
        "109 + 6 T + 26 sqrt(u), at least 50",
        "Vionnet et al. 2012, Geosci. Model Dev. 5, 773-791 (Crocus); constants as in FSM2",
        {"temperature": (-20.0, 0.0), "wind": (0.0, 15.0)},
        SCATTER,
        vionnet_2012,
        range_verified=False,
    ),
)
