"""Names for the array types used throughout."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]
AnyIntegers = NDArray[np.integer[Any]]
Numbers = NDArray[np.number[Any]]
#: Numbers of grains on voxels; 0 is air.
Labels = NDArray[np.int32]
#: Fields on many voxels.
SingleFloats = NDArray[np.float32]
