"""Targets for synthetic snow (density, surface area)."""

from __future__ import annotations

from math import prod
from typing import Optional

from snowshed._core import InputError
from snowshed.analysis.tomography.ice_image import ICE_DENSITY
from snowshed.base.arrays import positive

MAX_VOXELS = 1 << 30


def check_shape(shape: tuple[int, int, int]) -> None:
    """Raise InputError for an invalid shape of synthetic snow.

    Examples
    --------
    >>> check_shape((40, 40, 4))  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    snowshed._core.InputError: shape (40, 40, 4): not three whole numbers ...
    """
    if len(shape) != 3 or any(int(count) != count or count < 8 for count in shape):
        raise InputError(f"shape {shape}: not three whole numbers (nz, ny, nx), each 8 or more")
    if prod(map(int, shape)) > MAX_VOXELS:
        raise InputError(f"shape {shape}: more than {MAX_VOXELS:,} voxels")


def asked_fraction(ice_fraction: Optional[float], density: Optional[float]) -> float:
    """Return the ice fraction, from the fraction or from a density in kg/m3.

    Examples
    --------
    >>> asked_fraction(None, 458.5)
    0.5
    """
    fraction = one_of("ice_fraction", ice_fraction, "density", density, 1 / ICE_DENSITY)
    if fraction >= 1:
        raise InputError(f"ice fraction {fraction:g}: it must be below 1 ({ICE_DENSITY:g} kg/m3)")
    return fraction


def one_of(
    name: str, value: Optional[float], other: str, instead: Optional[float], factor: float = 1.0
) -> float:
    """Return the given value of two alternatives, both positive; the second times `factor`.

    Examples
    --------
    >>> one_of("length", None, "length_mm", 5.0, 0.001)
    0.005
    """
    if (value is None) == (instead is None):
        raise InputError(f"{name}, {other}: give one of the two")
    if value is not None:
        return positive(name, value)
    return positive(other, instead or 0.0) * factor
