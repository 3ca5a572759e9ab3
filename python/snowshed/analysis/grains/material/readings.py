"""Parameters of the cohesive Cam-Clay law from loading tests.

Stresses are positive in compression. p is the mean stress and q the Mises stress. The law hardens
with p0 = K sinh(xi e), where K = E/(3 - 6 nu) and e is the plastic volumetric compaction (thesis
1.2.7). Its yield surface is fitted in `snowshed.analysis.grains.material.yield_surface`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.grains.material.law import Elasticity
from snowshed.base.arrays import Floats
from snowshed.methods.grains.curve import LoadingCurve, no_contact_text
from snowshed.methods.grains.phases import MAX_PEAK_STRAIN, MIN_ROWS

#: Strain from which a peak counts: earlier peaks come from the plate's impact.
PEAK_FROM_STRAIN = 5e-4
#: Width of the intervals of plastic compaction over which stresses are averaged before hardening is
#: fitted.
HARDENING_BIN = 0.02
MAX_POISSON = 0.49  # largest Poisson's ratio in scenes (`snowshed.Snow`)
MAX_HARDENING = 1000.0  # largest hardening factor in scenes


@dataclass(frozen=True)
class Hardening:
    """The hardening law.

    Attributes
    ----------
    factor
        xi.
    residual
        Root mean square of the residual, relative to that of the stresses.
    excess
        Largest ratio of the law's stress to that of the grains. Between the brittle peak and
        hardening, grains are weaker than the law, because the law cannot soften while it compacts.
    """

    factor: float
    residual: float
    excess: float


def axial_stress(curve: LoadingCurve) -> Floats:
    """Return the mean stress of both plates along z, Pa; elastic waves make the two differ."""
    return np.asarray(0.5 * (curve["top_stress_pa"] + curve["bottom_stress_pa"]))


def invariants(curve: LoadingCurve, *, isotropic: bool = False) -> tuple[Floats, Floats]:
    """Return p and q of the law, Pa, row by row; the sides give the stresses along x and y.

    The law's are Kirchhoff stresses: forces over initial areas, as curves have them, times the
    stretch along the force.

    Parameters
    ----------
    curve
        Curve of a test.
    isotropic
        Whether the sides move inward as the plate does; else they stand still.
    """
    stretch = 1.0 - curve["axial_strain"]
    along = stretch * axial_stress(curve)
    side = (stretch if isotropic else 1.0) * curve["side_stress_pa"]
    shear = math.sqrt(3.0) * curve["shear_stress_pa"]
    return np.asarray((along + 2.0 * side) / 3.0), np.hypot(along - side, shear)


def elasticity(curve: LoadingCurve) -> tuple[Elasticity, float]:
    """Return E and nu, and R2 of the line, from confined compression before the first bond breaks.

    The stress has the slope E (1 - nu) / ((1 + nu)(1 - 2 nu)) over the strain. The stress on the
    sides is nu/(1 - nu) times that on the plate. Lines are fitted by least squares through the
    origin, so that waves at the beginning hardly matter.

    Raises
    ------
    InputError
        If the elastic phase has too few rows, or no stiffness.

    Examples
    --------
    >>> from snowshed.methods.grains.curve import COLUMNS
    >>> columns = {name: np.zeros(9) for name in COLUMNS}
    >>> strain = np.linspace(0, 1e-4, 9)
    >>> columns.update(axial_strain=strain, top_stress_pa=1.35e6 * strain)
    >>> columns.update(bottom_stress_pa=1.35e6 * strain, side_stress_pa=0.578e6 * strain)
    >>> found, linearity = elasticity(LoadingCurve(columns))
    >>> round(found.youngs_modulus, -4), round(found.poissons_ratio, 2)
    (1000000.0, 0.3)
    """
    broken = np.flatnonzero(curve.broken > curve.broken[0])
    rows = slice(0, int(broken[0]) if broken.size else len(curve))
    strain, along = curve["axial_strain"][rows], axial_stress(curve)[rows]
    if len(strain) < MIN_ROWS:
        raise InputError(
            f"{len(strain)} rows before the first bond breaks; the elastic phase needs {MIN_ROWS}"
        )
    slope = float(strain @ along / (strain @ strain))
    spread = np.sum((along - along.mean()) ** 2)
    linearity = 1.0 - np.sum((along - slope * strain) ** 2) / spread if spread > 0 else 0.0
    if not slope > 0:
        what = "the stress does not grow in the elastic phase"
        raise InputError(_unknown(curve, "compress", what))
    ratio = max(float(strain @ curve["side_stress_pa"][rows] / (strain @ along)), 0.0)
    nu = min(ratio / (1 + ratio), MAX_POISSON)
    modulus = float(slope) * (1 + nu) * (1 - 2 * nu) / (1 - nu)
    return Elasticity(modulus, nu), float(linearity)


def _unknown(curve: LoadingCurve, kind: str, what: str) -> str:
    """Return the message that a reading is impossible, with the reason if known."""
    return f"{what}: {no_contact_text(curve, kind) or 'nothing to be read'}"


def isotropic_yield(curve: LoadingCurve) -> float:
    """Return p0, Pa: the largest mean stress of isotropic compression up to a strain of 5 %.

    Raises
    ------
    InputError
        If there is no pressure.
    """
    peak = 0.0
    for rows in (curve, curve.peaks):
        strain = rows["axial_strain"]
        counted = (strain >= PEAK_FROM_STRAIN) & (strain <= MAX_PEAK_STRAIN)
        pressure = invariants(rows, isotropic=True)[0][counted]
        peak = max(peak, float(pressure.max(initial=0.0)))
    if not peak > 0:
        raise InputError(_unknown(curve, "isotropic", "no pressure in isotropic compression"))
    return peak


def confined_peak(curve: LoadingCurve) -> float:
    """Return the largest stress of confined compression without impacts, Pa.

    Raises
    ------
    InputError
        If there is no stress.
    """
    peak = 0.0
    for rows in (curve, curve.peaks):
        counted = rows["axial_strain"] >= PEAK_FROM_STRAIN
        peak = max(peak, float(axial_stress(rows)[counted].max(initial=0.0)))
    if not peak > 0:
        raise InputError(_unknown(curve, "compress", "no stress in confined compression"))
    return peak


def shear_strength(curve: LoadingCurve) -> tuple[float, float]:
    """Return p and q, Pa, at the largest shear stress under a normal stress.

    Until then, bonds hold the snow together, as in the other strengths. Afterwards a sheared layer
    is loose, and its strength is not that of the surrounding snow.

    Raises
    ------
    InputError
        If there is no shear stress.
    """
    curve = curve.peaks
    shear = np.where(curve["shear_strain"] >= PEAK_FROM_STRAIN, curve["shear_stress_pa"], -np.inf)
    row = int(np.argmax(shear))
    if not shear[row] > 0:
        raise InputError("no shear stress: is the snow frozen to the plates (bonded_plates)?")
    pressure, deviator = invariants(curve)
    return float(pressure[row]), float(deviator[row])


def tension(curve: LoadingCurve) -> tuple[float, float]:
    """Return p and q, Pa, at the largest tension of a sample that is stretched.

    Raises
    ------
    InputError
        If there is no tension.
    """
    curve = curve.peaks
    along = np.where(curve["axial_strain"] <= -PEAK_FROM_STRAIN, axial_stress(curve), np.inf)
    row = int(np.argmin(along))
    if not along[row] < 0:
        raise InputError("no tension: is the snow frozen to the plates (bonded_plates)?")
    pressure, deviator = invariants(curve)
    return float(pressure[row]), float(deviator[row])


def hardening(curve: LoadingCurve, elastic: Elasticity, p0: float) -> Hardening:
    """Return xi from isotropic compression, fitted to the pressures by least squares.

    Pressures are averaged over plastic compactions of 2 %, so that each interval counts once. The
    largest pressures, those of hardening, dominate.

    Parameters
    ----------
    curve
        Curve of isotropic compression, with the same strain rate along all axes.
    elastic
        Elastic constants. If E is not that of the grains, xi compensates.
    p0
        Pressure at which hardening begins, Pa.

    Raises
    ------
    InputError
        If the sample is compacted too little for a fit, or E is too soft for its pressure.
    """
    from scipy.optimize import least_squares

    pressure = invariants(curve, isotropic=True)[0]
    compaction = -3.0 * np.log1p(-np.abs(curve["axial_strain"]))
    plastic = compaction - pressure / elastic.bulk_modulus
    if plastic[-1] < 0.5 * compaction[-1]:
        raise InputError(
            f"E {elastic.youngs_modulus:.3g} Pa is too soft for the hardening: more than half of "
            "the compaction would be elastic"
        )
    bins = np.floor(plastic / HARDENING_BIN).astype(int)
    used = np.unique(bins[bins >= 0])
    if len(used) < MIN_ROWS:
        raise InputError(
            f"compacted by {compaction[-1]:.1%}: too little for a hardening factor; "
            f"{MIN_ROWS * HARDENING_BIN:.0%} of plastic compaction at least"
        )
    means = [[values[bins == index].mean() for index in used] for values in (plastic, pressure)]
    x, y = np.array(means)

    def law(factor: float) -> Floats:
        return elastic.hardened(p0, factor, np.maximum(x, 0.0))

    # The factor is fitted as a logarithm, because factors of all sizes are possible. The search
    # begins at the factor that meets the last stress.
    last = math.asinh(max(y[-1], 1.01 * p0) / elastic.bulk_modulus)
    guess = math.log(max((last - math.asinh(p0 / elastic.bulk_modulus)) / x[-1], 1e-6))
    ends = (math.log(1e-9), math.log(MAX_HARDENING))
    optimum = least_squares(lambda log: (law(math.exp(log[0])) - y) / y.max(), [guess], bounds=ends)
    factor = math.exp(float(optimum.x[0]))
    fitted = law(factor)
    residual = float(np.sqrt(np.sum((fitted - y) ** 2) / np.sum(y**2)))
    if residual > 1.0:
        raise InputError(
            f"the hardening law misses the stresses by {residual:.2g} of their size: after its "
            f"peak of {p0:.3g} Pa the snow stays weaker, which the law cannot describe"
        )
    positive = y > 0
    return Hardening(factor, residual, float((fitted[positive] / y[positive]).max()))
