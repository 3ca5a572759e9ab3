"""The score by which models are chosen and compared."""

from __future__ import annotations

import numpy as np

from snowshed.base.arrays import Floats


def median_absolute_error(errors: Floats) -> float:
    """Return the score of section 5.2.4; smaller is better.

    Examples
    --------
    >>> median_absolute_error(np.array([-4.0, 1.0, 2.0]))
    2.0
    """
    return float(np.median(np.abs(errors)))
