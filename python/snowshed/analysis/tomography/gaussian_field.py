"""Synthetic snow: a Gaussian random field, cut at a level.

The field is a sum of plane waves of random phase whose wave numbers lie in a shell around 2π/L.
Where it is above the cut there is ice (Berk 1987, doi:10.1103/PhysRevLett.58.2718). If a field of
unit variance has a derivative of variance m along a direction, the surface of its level u per
volume is 2/π √m exp(-u²/2) (Adler and Taylor 2007, Random Fields and Geometry, chapter 12). The
search for L begins there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np
import scipy.fft
from scipy.special import ndtri

from snowshed._core import InputError
from snowshed.analysis.tomography.crofton import surface_density
from snowshed.analysis.tomography.ice_image import ICE_DENSITY, IceImage
from snowshed.analysis.tomography.parts import largest_part
from snowshed.analysis.tomography.request import asked_fraction, check_shape, one_of
from snowshed.base.arguments import checked
from snowshed.base.arrays import Booleans, SingleFloats, positive

SHELL_WIDTH = 0.15  # standard deviation of the wave numbers over their mean
SURFACE_TOLERANCE = 0.005  # relative, of the specific surface
ICE_TOLERANCE = 1e-4  # relative, of the number of ice voxels
MAX_TRIES = 12  # fields of the search for the surface, and cuts of each field
MAX_SURFACE_ERROR = 0.03  # of the best try


@checked
def gaussian_snow(
    shape: tuple[int, int, int],
    voxel_size: float,
    *,
    ice_fraction: Optional[float] = None,
    density: Optional[float] = None,
    correlation_length: Optional[float] = None,
    specific_surface: Optional[float] = None,
    anisotropy: float = 1.0,
    connected: bool = True,
    seed: int = 0,
) -> IceImage:
    """Return synthetic snow: a Gaussian random field, cut where the ice fraction is as asked.

    Parameters
    ----------
    shape
        Voxels (nz, ny, nx).
    voxel_size
        Edge of a voxel, m.
    ice_fraction, density
        Amount of ice; give one of the two. 0 < fraction < 1, or kg/m3.
    correlation_length, specific_surface
        Fineness of the ice; give one of the two: the mean wavelength of the field in m, or the
        surface of the ice per mass in m2/kg, from which the wavelength is found.
    anisotropy
        Wavelength along z over the wavelength along x and y; the geometric mean of all stays.
    connected
        Whether to keep only the largest connected part of the ice. The ice fraction is that of this
        part.
    seed
        Random seed; the same seed gives the same snow.

    Raises
    ------
    InputError
        If a value is out of range, too little ice is asked for to be connected, or the field
        cannot have the asked surface on such voxels.

    Examples
    --------
    >>> snow = gaussian_snow((48, 48, 48), 5e-5, density=300, specific_surface=15, seed=1)
    >>> round(snow.density), snow.synthetic
    (300, True)
    """
    check_shape(shape)
    positive("voxel size", voxel_size)
    positive("anisotropy", anisotropy)
    fraction = asked_fraction(ice_fraction, density)
    noise = _Noise(shape, anisotropy, seed)
    if correlation_length is not None and specific_surface is None:
        wavelength = positive("correlation_length", correlation_length) / voxel_size
        ice = _cut(
            noise.field(_checked_wavelength(wavelength, voxel_size, shape)), fraction, connected
        )
    else:
        surface = one_of(
            "specific_surface", specific_surface, "correlation_length", correlation_length
        )
        ice, wavelength = _search(noise, fraction, surface, voxel_size, connected)
    source = (
        f"synthetic: Gaussian random field of wavelength {wavelength * voxel_size * 1e6:.4g} um, "
        f"cut at ice fraction {fraction:.4g}, anisotropy {anisotropy:g}, seed {seed}"
    )
    return IceImage(ice, voxel_size, source, synthetic=True)


@dataclass(frozen=True)
class _Noise:
    """White noise that becomes fields of any wavelength."""

    shape: tuple[int, int, int]
    anisotropy: float
    seed: int

    def field(self, wavelength: float) -> SingleFloats:
        """Return the field of a wavelength in voxels; it has no unit and any variance."""
        random = np.random.default_rng(self.seed)
        noise = random.standard_normal(self.shape, dtype=np.float32)
        waves = scipy.fft.rfftn(noise, overwrite_x=True, workers=-1)
        del noise
        stretch = self.anisotropy ** (1 / 3)
        nz, ny, nx = self.shape
        kz, ky, kx = (
            np.float32(wavelength * factor) * frequencies.astype(np.float32)
            for factor, frequencies in (
                (stretch**2, np.fft.fftfreq(nz)),
                (1 / stretch, np.fft.fftfreq(ny)),
                (1 / stretch, np.fft.rfftfreq(nx)),
            )
        )
        plane = ky[:, None] ** 2 + kx[None, :] ** 2
        for layer, at in zip(waves, kz):
            number = np.sqrt(plane + at**2)
            layer *= np.exp(-0.25 * ((number - 1) / np.float32(SHELL_WIDTH)) ** 2)
        field = scipy.fft.irfftn(waves, s=self.shape, overwrite_x=True, workers=-1)
        return np.asarray(field, dtype=np.float32)


def _search(
    noise: _Noise, fraction: float, surface: float, voxel_size: float, connected: bool
) -> tuple[Booleans, float]:
    """Return ice of a specific surface, and the wavelength of its field in voxels."""
    # Mean square of the wave numbers in the shell (their density grows as k^2), relative to
    # (2 pi/L)^2.
    spread = (1 + 6 * SHELL_WIDTH**2 + 3 * SHELL_WIDTH**4) / (1 + SHELL_WIDTH**2)
    per_length = 2 / np.pi * np.sqrt(spread / 3) * np.exp(-0.5 * ndtri(fraction) ** 2)
    target = surface * ICE_DENSITY * fraction * voxel_size  # per volume, in voxels
    wavelength = float(2 * np.pi * per_length / target)
    best: Optional[tuple[Booleans, float]] = None
    least = MAX_SURFACE_ERROR
    for attempt in range(MAX_TRIES):
        field = noise.field(_checked_wavelength(wavelength, voxel_size, noise.shape))
        ice = _cut(field, fraction, connected)
        density = surface_density(ice) * ice.size * fraction / np.count_nonzero(ice)
        if abs(density / target - 1) < least:
            best, least = (ice, wavelength), abs(density / target - 1)
        if least < SURFACE_TOLERANCE:
            break
        # The surface jumps where parts of the ice disconnect; smaller steps then come nearer.
        wavelength *= float(density / target) ** (1.0 if attempt < MAX_TRIES // 3 else 0.4)
    if best is not None:
        return best
    raise InputError(
        f"specific surface {surface:g} m2/kg: no field of {noise.shape} voxels of "
        f"{voxel_size * 1e6:g} um has it; choose smaller voxels or a larger sample"
    )


def _checked_wavelength(wavelength: float, voxel_size: float, shape: tuple[int, int, int]) -> float:
    """Return a wavelength in voxels if voxels resolve it and the sample holds it."""
    longest = max(shape)
    if not 4 <= wavelength <= longest:
        raise InputError(
            f"wavelength {wavelength * voxel_size:.4g} m: {wavelength:.3g} voxels; from 4 voxels "
            f"to the length of the sample ({longest} voxels) are allowed, so that the voxels "
            "resolve the ice and the sample is larger than a grain"
        )
    return wavelength


def _cut(field: SingleFloats, fraction: float, connected: bool) -> Booleans:
    """Return where the field is highest, so that this is `fraction` of all voxels."""
    target = round(fraction * field.size)
    if not connected:
        return _highest(field, target)
    count, best, least = target, None, field.size
    for _ in range(MAX_TRIES):
        ice = largest_part(_highest(field, count))
        missing = target - int(np.count_nonzero(ice))
        if abs(missing) < least:
            best, least = ice, abs(missing)
        if least <= max(1, ICE_TOLERANCE * target) or missing > target / 2:
            break
        count = min(max(count + missing, 1), field.size - 1)
    if best is None or least > 0.02 * target:
        raise InputError(
            f"ice fraction {fraction:.3g}: the largest connected part has {1 - least / target:.0%} "
            "of it; there is too little ice for a connected part"
        )
    return best


def _highest(field: SingleFloats, count: int) -> Booleans:
    """Return the `count` highest voxels of a field."""
    level = np.partition(field, field.size - count, axis=None)[field.size - count]
    return np.asarray(field >= level)
