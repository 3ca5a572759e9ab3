"""Sintering: the strength of bonds between grains as a power of their age.

Both publications measured the growth from some minutes after contact to days, at one temperature.
The dependence of the factor before the power on temperature is too uncertain to be included.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from snowshed.base.arrays import Floats


@dataclass(frozen=True)
class SinteringLaw:
    """Strength in proportion to a power of the age of the bonds.

    Attributes
    ----------
    exponent
        Exponent of the age.
    source
        Measured quantity and its source.
    """

    exponent: float
    source: str

    def strengthen(self, strength: Floats, age: float) -> Floats:
        """Return the strengths of bonds after some more time.

        Parameters
        ----------
        strength : (n,)
            Strengths relative to bonds of age 1; strengths of 1 or more do not change.
        age
            Time that passes, in units of this age.

        Examples
        --------
        >>> law = SINTERING_LAWS["van-herwijnen-2013"]
        >>> law.strengthen(np.array([0.0, 0.5, 2.0]), 0.1).round(2)
        array([0.66, 0.68, 2.  ])
        """
        equivalent = np.clip(strength, 0.0, 1.0) ** (1.0 / self.exponent)
        grown = np.minimum((equivalent + age) ** self.exponent, 1.0)
        result: Floats = np.maximum(strength, grown)
        return result


SINTERING_LAWS: dict[str, SinteringLaw] = {
    "van-herwijnen-2013": SinteringLaw(
        0.18,
        "penetration resistance of homogeneous samples: van Herwijnen and Miller 2013, J. Glaciol. "
        "59 (214), 269-274",
    ),
    "podolskiy-2014": SinteringLaw(
        0.21,
        "shear strength of faces put together: Podolskiy et al. 2014, The Cryosphere 8, 1651-1659",
    ),
}
