"""The score that chooses and compares models."""

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
