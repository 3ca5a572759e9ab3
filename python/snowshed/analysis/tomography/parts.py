"""Connected parts of the ice."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from snowshed.base.arrays import Booleans


def largest_part(ice: Booleans) -> Booleans:
    """Return the largest part of the ice whose voxels are connected by faces.

    Examples
    --------
    >>> largest_part(np.array([[[True, True, False, True]]])).tolist()
    [[[True, True, False, False]]]
    """
    parts, count = ndimage.label(ice, output=np.int32)
    if count < 2:
        return ice.copy()
    sizes = np.bincount(parts.ravel(), minlength=count + 1)
    sizes[0] = 0
    return np.asarray(parts == sizes.argmax())
