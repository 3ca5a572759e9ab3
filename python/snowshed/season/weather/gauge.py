"""New snow from the water of a precipitation gauge and the temperature of the air."""

from __future__ import annotations

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.season.weather.extremes import RECORD_DAY
from snowshed.snow.relations.new_snow import NEW_SNOW_DENSITY

# The share of snow falls linearly from all snow to all rain: U.S. Army Corps of Engineers 1956,
# Snow Hydrology, as in Wigmosta et al. 1994, Water Resour. Res. 30, 1665-1679.
ALL_SNOW = -1.1  # degrees C, below which all precipitation is snow
ALL_RAIN = 3.3  # degrees C, above which all precipitation is rain
DENSITY = "hedstrom-pomeroy-1998"
MIN_TEMPERATURE = -90.0  # degrees C, of the density
RULE = (
    "new snow follows from precipitation and temperature: all snow below "
    f"{ALL_SNOW:g} °C, all rain above {ALL_RAIN:g} °C (U.S. Army Corps of Engineers 1956), "
    f"with the density of {DENSITY}"
)


def snow_fraction(temperature: float) -> float:
    """Return the part of precipitation that falls as snow at an air temperature, degrees C.

    Examples
    --------
    >>> [round(snow_fraction(t), 2) for t in (-5.0, 1.1, 4.0)]
    [1.0, 0.5, 0.0]
    """
    return float(np.clip((ALL_RAIN - temperature) / (ALL_RAIN - ALL_SNOW), 0.0, 1.0))


def snow_of_gauge(water: Floats, temperature: Floats) -> Floats:
    """Return the new snow of every day, m; NaN where the precipitation is not known.

    The snow of a day is at most the record of 24 hours; a larger depth would only show that the
    assumed density is wrong.

    Parameters
    ----------
    water : (n,)
        Precipitation, mm; NaN: unknown.
    temperature : (n,)
        Temperature of the air, degrees C.

    Examples
    --------
    >>> snow_of_gauge(np.array([24.0, np.nan, 10.0]), np.array([-7.0, -7.0, 5.0])).round(3).tolist()
    [0.336, nan, 0.0]
    """
    density = NEW_SNOW_DENSITY[DENSITY]
    snow = [
        amount * snow_fraction(warm) / density(max(warm, MIN_TEMPERATURE))
        for amount, warm in zip(water, temperature)
    ]
    return np.asarray(np.minimum(np.round(snow, 4), RECORD_DAY), dtype=float)
