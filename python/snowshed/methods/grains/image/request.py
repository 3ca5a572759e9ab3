"""What is asked of synthetic snow."""

from __future__ import annotations

from math import prod
from typing import Optional

from snowshed._core import InputError
from snowshed.io.array_arguments import positive
from snowshed.methods.grains.image.ice_image import ICE_DENSITY

MOST_VOXELS = 1 << 30
