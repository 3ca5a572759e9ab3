"""Stresses for comparison: those of one sample that was compressed with Yade.

The paper's own tables are not available to us. These stresses were measured with Yade 2023.02a on
one synthetic sample of 87 grains (318 kg/m3, a cube of 2.4 mm, 4153 spheres), by the same contact
law.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Optional

from reproductions.hagenmuller2015.studies import HEAVY_SNOW, LIGHT_SNOW
from snowshed.analysis.grains.variants import BASE

#: Stresses by the names of variants, kPa: peak up to a strain of 5 %, and means from 5 to 10, 10 to
#: 15 and 25 to 30 %.
Line = tuple[Optional[float], Optional[float], Optional[float], Optional[float]]
YADE: Mapping[str, Line] = {
    BASE: (69.0, 26.0, 47.0, 2516.0),
    "elastic modulus 1e+08 Pa": (63.0, 54.0, 57.0, 439.0),
    "strength of bonds 2e+06 Pa": (131.0, 59.0, 14.0, None),
    "friction 0.5": (106.0, 46.0, 38.0, 4988.0),
    LIGHT_SNOW: (4.1, 1.4, 2.6, 7.3),
    HEAVY_SNOW: (2868.0, 4251.0, 7030.0, 19059.0),
}
