"""The phases of a loading: elastic, brittle and frictional, hardening.

Hagenmuller, Chambon and Naaim (2015, doi:10.5194/tc-9-1969-2015) describe them: stress first grows
linearly and reversibly, without a broken bond; then bonds break and grains rearrange; at last,
dense snow hardens, and the stress grows like an exponential. The numerical criteria for the phases
are our own choice; each function states its own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.methods.grains.curve import (
    LoadingCurve,
    carried_stress,
    no_contact_text,
    stage_strain,
    stage_stress,
)

STRAIN_BIN = 0.01  # strain over which stresses are averaged to find hardening
#: Smallest rise of the logarithm of the stress that counts as hardening.
MIN_HARDENING = math.log(2.0)
#: Smallest share of the logarithm's variance that hardening must explain.
MIN_EXPLAINED_VARIANCE = 0.5
#: Smallest number of rows in the elastic phase for a modulus.
MIN_ROWS = 4
#: R2 of the line through the elastic phase, below which the phase does not count as linear.
MIN_LINEARITY = 0.95
MAX_PEAK_STRAIN = 0.05  # strain below which the peak of the brittle phase lies
#: Strains between which the stress is averaged.
MEAN_STRAIN_RANGES = ((0.05, 0.10), (0.10, 0.15), (0.25, 0.30))


@dataclass(frozen=True)
class Phases:
    """The phases of a stage; a quantity is None if the stage does not show it.

    Attributes
    ----------
    elastic_limit
        Strain of the last row before the first bond breaks.
    tangent_modulus
        Slope of the least-squares line through the rows of the elastic phase, Pa.
    linearity
        Coefficient of determination R2 of this line.
    hardening_onset
        Strain at which the stress begins to grow exponentially.
    hardening_rate
        Rate of this growth: stress ~ exp(rate * strain).
    strength
        Largest stress of all time steps that the sample carries from plate to plate, Pa; in
        compression, the largest below a strain of 5 %.
    contact_strain
        Strain at the first contact of a plate with the snow.
    unknown
        Reason why no quantity is known; else empty.
    """

    elastic_limit: Optional[float]
    tangent_modulus: Optional[float]
    linearity: Optional[float]
    hardening_onset: Optional[float]
    hardening_rate: Optional[float]
    strength: Optional[float]
    contact_strain: float = 0.0
    unknown: str = ""


@checked
def find_phases(curve: LoadingCurve, kind: str = "compress") -> Phases:
    """Return the phases of a stage.

    Parameters
    ----------
    curve
        The rows of the stage (`LoadingCurve.of_stage`).
    kind
        Kind of the stage, as in scenes.

    Examples
    --------
    >>> from snowshed.methods.grains.curve import COLUMNS
    >>> strain = np.linspace(0.0, 0.3, 301)
    >>> columns = {name: np.zeros(301) for name in COLUMNS}
    >>> hardening = 1e5 * np.exp(20 * np.maximum(strain - 0.2, 0))
    >>> stress = np.where(strain < 0.01, 1e7 * strain, hardening)
    >>> broken = np.where(strain > 0.01, 5.0, 0.0)
    >>> columns.update(axial_strain=strain, broken_in_shear=broken)
    >>> columns.update(top_stress_pa=stress, bottom_stress_pa=stress)
    >>> phases = find_phases(LoadingCurve(columns))
    >>> round(phases.tangent_modulus), round(phases.hardening_onset, 2)
    (10000000, 0.2)
    """
    nothing = Phases(None, None, None, None, None, None)
    if len(curve) < 2:
        return nothing
    if reason := no_contact_text(curve, kind):
        return replace(nothing, unknown=reason)
    strain, stress = stage_strain(curve, kind), stage_stress(curve, kind)
    felt = np.flatnonzero(stress != 0.0)
    first = max(int(felt[0]) - 1, 0) if felt.size else 0
    limit, modulus, linearity = _elastic(strain[first:], stress[first:], curve.broken[first:])
    hardens = kind in ("compress", "isotropic")
    onset, rate = _hardening(strain, stress, limit or 0.0) if hardens else (None, None)
    peaks = curve.peaks
    below = stage_strain(peaks, kind) <= (MAX_PEAK_STRAIN if hardens else math.inf)
    strength = float(carried_stress(peaks, kind)[below].max())
    known = strength if strength > 0.0 else None
    return Phases(limit, modulus, linearity, onset, rate, known, float(strain[first]))


@checked
def mean_stress(strain: Floats, stress: Floats, low: float, high: float) -> Optional[float]:
    """Return the mean of the stress over a range of strain; None if the curve ends before `high`.

    Parameters
    ----------
    strain : (n,)
        In rising order.
    stress : (n,)
        Stress at these strains, linear in between.

    Examples
    --------
    >>> mean_stress(np.array([0.0, 0.1]), np.array([0.0, 2.0]), 0.0, 0.1)
    1.0
    """
    end = float(strain[-1])
    if end < high and not math.isclose(end, high, rel_tol=1e-3):
        return None
    high = min(high, end)
    inside = (strain > low) & (strain < high)
    at = np.concatenate(([low], strain[inside], [high]))
    value = np.interp(at, strain, stress)
    return float(np.sum(0.5 * (value[1:] + value[:-1]) * np.diff(at)) / (high - low))


def _elastic(
    strain: Floats, stress: Floats, broken: Floats
) -> tuple[Optional[float], Optional[float], Optional[float]]:
    breaking = np.flatnonzero(broken > broken[0])
    rows = slice(0, int(breaking[0]) if breaking.size else len(strain))
    x, y = strain[rows], stress[rows]
    limit = float(x[-1])
    if len(x) < MIN_ROWS or x[-1] <= x[0]:
        return limit, None, None
    slope, start = np.polyfit(x, y, 1)
    scatter, spread = np.sum((y - start - slope * x) ** 2), np.sum((y - y.mean()) ** 2)
    return limit, float(slope), float(1.0 - scatter / spread) if spread > 0 else None


def _hardening(
    strain: Floats, stress: Floats, limit: float
) -> tuple[Optional[float], Optional[float]]:
    """Return onset and rate of hardening.

    A constant and a rising line that meet at the onset are fitted to the logarithm of the stress,
    averaged over bins of `STRAIN_BIN`, by least squares. The rise counts only if it doubles the
    stress and explains at least half of the logarithm's variance.
    """
    edges = np.arange(limit, strain[-1] + 1e-9, STRAIN_BIN)
    if len(edges) < 6:
        return None, None
    means = [mean_stress(strain, stress, a, b) for a, b in zip(edges, edges[1:])]
    pairs = [
        (a + STRAIN_BIN / 2, math.log(mean)) for a, mean in zip(edges, means) if mean and mean > 0
    ]
    if len(pairs) < 5:
        return None, None
    x, y = np.array(pairs).T
    best = min((_hinge(x, y, float(onset)) for onset in edges[:-2]), key=lambda fit: fit[0])
    misfit, onset, rate = best
    scatter = float(np.sum((y - y.mean()) ** 2))
    if rate * (x[-1] - onset) < MIN_HARDENING or misfit > (1 - MIN_EXPLAINED_VARIANCE) * scatter:
        return None, None
    return onset, rate


def _hinge(x: Floats, y: Floats, onset: float) -> tuple[float, float, float]:
    """Return the squared misfit of a constant and a later line, the onset, and the slope."""
    design = np.column_stack([np.ones_like(x), np.maximum(x - onset, 0.0)])
    coefficients, *_ = np.linalg.lstsq(design, y, rcond=None)
    return float(np.sum((design @ coefficients - y) ** 2)), onset, float(coefficients[1])
