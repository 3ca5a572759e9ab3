"""Settling of dry snow: the strain rate of a layer under the snow above it.

Both laws come from snow cover models, made for layers on the ground. Their accuracy for snow that
has slid, broken and piled up is unknown.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.snow.relations.relation import ICE_DENSITY

MAX_STEP = 3600.0  # s
MAX_STRAIN = 0.01  # in one step

# Density at which snow turns into firn and settling stops; none of the laws is made for firn.
MAX_SETTLED_DENSITY = 0.6 * ICE_DENSITY

#: Strain rate, 1/s, positive where snow compacts, of layers with given densities, kg/m3, stress
#: from the snow above, Pa, and temperature, degrees C.
SettlingLaw = Callable[[Floats, Floats, float], Floats]


def vionnet_2012(density: Floats, stress: Floats, temperature: float) -> Floats:
    """Return the strain rate, 1/s, in the snow model Crocus, for dry snow with rounded grains.

    Stress over the viscosity 7.62237e6 Pa s (rho / 250) exp(0.023 rho - 0.1 T) of Vionnet et al.
    2012, Geosci. Model Dev. 5, 773-791. With angular grains the viscosity is up to 4 times as high.

    Examples
    --------
    >>> day = 86400 * vionnet_2012(np.array([100.0]), np.array([250.0]), -5.0)
    >>> day.round(3)  # under 25 cm of new snow
    array([0.431])
    """
    cold = -min(temperature, 0.0)
    viscosity = 7.62237e6 * density / 250.0 * np.exp(0.1 * cold + 0.023 * density)
    rate: Floats = stress / viscosity
    return rate


def essery_2013(density: Floats, stress: Floats, temperature: float) -> Floats:
    """Return the strain rate, 1/s, of Anderson 1976 with the constants of Essery et al. 2013.

    Stress over the viscosity 3.7e7 Pa s exp(0.018 rho - 0.081 T), plus the metamorphism of new snow
    under no load, 2.8e-6/s exp(0.042 T - 0.046 max(rho - 150, 0)) (Adv. Water Resour. 55, 131-148).
    Published values of the viscosity's factor range from 3.6e6 to 3.7e7 Pa s.

    Examples
    --------
    >>> day = 86400 * essery_2013(np.array([100.0]), np.array([0.0, 250.0]), -5.0)
    >>> day.round(3)
    array([0.196, 0.26 ])
    """
    cold = -min(temperature, 0.0)
    viscosity = 3.7e7 * np.exp(0.081 * cold + 0.018 * density)
    metamorphism = 2.8e-6 * np.exp(-0.042 * cold - 0.046 * np.maximum(density - 150.0, 0.0))
    rate: Floats = stress / viscosity + metamorphism
    return rate


SETTLING_LAWS: dict[str, SettlingLaw] = {"vionnet-2012": vionnet_2012, "essery-2013": essery_2013}


def settled_densities(
    law: SettlingLaw, densities: Floats, stresses: Floats, seconds: float, temperature: float
) -> Floats:
    """Return the densities of snow after some time under constant stresses.

    Parameters
    ----------
    law
        Law of settling.
    densities
        Densities of the layers, kg/m3, of any shape; layers above `MAX_SETTLED_DENSITY` do not
        settle.
    stresses
        Stress from the snow above, Pa, of the same shape.
    seconds
        The time.
    temperature
        Temperature, degrees C.

    Examples
    --------
    >>> hour, day = (
    ...     settled_densities(vionnet_2012, np.array([100.0]), np.array([250.0]), t, -5.0)
    ...     for t in (3600.0, 86400.0)
    ... )
    >>> hour.round(1), day.round(1)  # ever more slowly
    (array([101.8]), array([130.3]))
    """
    left = seconds
    while left > 0.0 and densities.size:
        rate = law(densities, stresses, temperature)
        step = min(left, MAX_STEP, MAX_STRAIN / max(float(rate.max()), 1e-12))
        settled = densities * np.exp(rate * step)
        densities = np.maximum(densities, np.minimum(settled, MAX_SETTLED_DENSITY))
        left -= step
    return densities
