"""Numbers that describe the ice of an image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.analysis.tomography.crofton import LAYERS_AT_ONCE, surface_density
from snowshed.analysis.tomography.ice_image import ICE_DENSITY, IceImage, check_phases
from snowshed.base.arguments import checked
from snowshed.base.arrays import Booleans, Floats

MIN_GRAIN, MAX_GRAIN = _core.min_grain_diameter, _core.max_grain_diameter  # m


@dataclass(frozen=True)
class Microstructure:
    """Numbers of the ice in an image.

    Attributes
    ----------
    source
        The image.
    synthetic
        Whether a generator made it.
    voxels
        Along x, y and z.
    voxel_size_m
        Edge of a voxel.
    ice_fraction
        Volume of the ice over that of the sample.
    density_kg_m3
        Density of the sample, with ice of 917 kg/m3.
    specific_surface_m2_kg
        Surface of the ice over its mass, by Crofton's formula in 13 directions: within 1 % for
        spheres 10 voxels wide, 7 % too small for layers along the voxels.
    optical_diameter_m
        Diameter of spheres with this specific surface, 6 / (917 kg/m3 times it).
    correlation_length_x_m, correlation_length_y_m, correlation_length_z_m
        Distance at which the two-point correlation has fallen to 1/e of its initial value; nan if
        this is beyond half the sample.
    ice_chord_x_m, ice_chord_y_m, ice_chord_z_m
        Mean length of the ice on lines.
    pore_chord_x_m, pore_chord_y_m, pore_chord_z_m
        Mean length of the air on lines.
    """

    source: str
    synthetic: bool
    voxels: tuple[int, int, int]
    voxel_size_m: float
    ice_fraction: float
    density_kg_m3: float
    specific_surface_m2_kg: float
    optical_diameter_m: float
    correlation_length_x_m: float
    correlation_length_y_m: float
    correlation_length_z_m: float
    ice_chord_x_m: float
    ice_chord_y_m: float
    ice_chord_z_m: float
    pore_chord_x_m: float
    pore_chord_y_m: float
    pore_chord_z_m: float


@checked
def measure_microstructure(image: IceImage) -> Microstructure:
    """Return the numbers of an image.

    Raises
    ------
    InputError
        If there is no ice or no air, or the grains are larger or smaller than in any snow, which
        points to a voxel size in another unit than metres.

    Examples
    --------
    >>> from snowshed.analysis.tomography.gaussian_field import gaussian_snow
    >>> snow = gaussian_snow((48, 48, 48), 5e-5, density=300, specific_surface=15, seed=1)
    >>> abs(measure_microstructure(snow).specific_surface_m2_kg - 15) < 0.2
    True
    """
    check_phases(image)
    size, fraction = image.voxel_size, image.ice_fraction
    surface = surface_density(image.ice, size) / (ICE_DENSITY * fraction)
    if not surface > 0:
        raise InputError(f"{image.source}: its ice has no surface")
    diameter = 6 / (ICE_DENSITY * surface)
    _check_scale(image, diameter)
    nz, ny, nx = image.ice.shape
    lengths = [correlation_length(image.ice, axis) * size for axis in (2, 1, 0)]
    chords = [mean_chords(image.ice, axis) for axis in (2, 1, 0)]
    return Microstructure(
        image.source, image.synthetic, (nx, ny, nz), size, fraction, image.density,
        surface, diameter, *lengths,
        *(size * ice for ice, _ in chords), *(size * pore for _, pore in chords),
    )  # fmt: skip


def two_point_correlation(ice: Booleans, axis: int, distance: int) -> float:
    """Return the probability that two voxels a distance apart along an axis are both ice."""
    rows = np.moveaxis(ice, axis, 0)
    first, second = rows[: len(rows) - distance], rows[distance:]
    both = sum(
        int(
            np.count_nonzero(first[low : low + LAYERS_AT_ONCE] & second[low : low + LAYERS_AT_ONCE])
        )
        for low in range(0, len(first), LAYERS_AT_ONCE)
    )
    return both / first.size


def covariances(ice: Booleans, axis: int) -> Floats:
    """Return the normalised covariance of the ice at 0, 1, ... voxels apart along an axis.

    It ends after it has fallen below 1/e, or at half the sample.
    """
    fraction = float(np.count_nonzero(ice) / ice.size)
    values = [1.0]
    while values[-1] > np.exp(-1.0) and len(values) <= ice.shape[axis] // 2:
        both = two_point_correlation(ice, axis, len(values))
        values.append((both - fraction**2) / (fraction * (1 - fraction)))
    return np.array(values)


def correlation_length(ice: Booleans, axis: int) -> float:
    """Return the distance in voxels at which the covariance along an axis has fallen to 1/e.

    Examples
    --------
    >>> random = np.random.default_rng(1).random((30, 30, 30)) < 0.5
    >>> 0.5 < correlation_length(random, 0) < 0.7
    True
    """
    values = covariances(ice, axis)
    level = np.exp(-1.0)
    if values[-1] > level:
        return float("nan")
    last = len(values) - 1
    return last - 1 + float((values[-2] - level) / (values[-2] - values[-1]))


def mean_chords(ice: Booleans, axis: int) -> tuple[float, float]:
    """Return the mean length of the ice and of the air on lines along an axis, in voxels.

    It follows from how often lines cross the surface, so chords that the sides cut count as they
    should (Underwood 1970, Quantitative Stereology).
    """
    rows = np.moveaxis(ice, axis, 0)
    crossings = sum(int(np.count_nonzero(low != high)) for low, high in zip(rows, rows[1:]))
    if not crossings:
        return float("inf"), float("inf")
    length = 2 * (ice.size - rows[0].size) / crossings
    fraction = float(np.count_nonzero(ice) / ice.size)
    return length * fraction, length * (1 - fraction)


def _check_scale(image: IceImage, diameter: float) -> None:
    if MIN_GRAIN <= diameter <= MAX_GRAIN:
        return
    hint = ""
    for unit, factor in (("mm", 1e-3), ("um", 1e-6)):
        if MIN_GRAIN <= diameter * factor <= MAX_GRAIN:
            hint = f"; is it in {unit}? Then it is {image.voxel_size * factor:g} m"
    raise InputError(
        f"{image.source}: wrongly scaled: with voxels of {image.voxel_size:g} m its grains measure "
        f"some {diameter:.3g} m; those of snow measure {MIN_GRAIN:g} to {MAX_GRAIN:g} m"
        f"{hint}"
    )
