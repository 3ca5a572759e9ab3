"""Snow fitted to loading tests of grains, with the ranges of its parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Optional, TypeVar

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.grains.material import readings
from snowshed.analysis.grains.material.law import CamClayFit, Elasticity
from snowshed.analysis.grains.material.loading_tests import (
    COMPACTION,
    CONFINED,
    ISOTROPIC,
    SHEAR,
    TENSION,
    Curves,
)
from snowshed.analysis.grains.material.yield_surface import fit_yield_surface
from snowshed.analysis.grains.ratios import LogMean
from snowshed.base.arguments import checked
from snowshed.base.formatting import percent
from snowshed.methods.grains.curve import LoadingCurve
from snowshed.methods.grains.phases import MIN_LINEARITY
from snowshed.methods.grains.summary import FEW_GRAINS
from snowshed.scene.components import Snow

Reading = TypeVar("Reading")
#: A note reports stresses of the law above this many times those of the grains.
MAX_LAW_OVER_GRAINS = 2.0
#: A note reports that the yield surface misses the strengths above this residual, relative to them.
MAX_YIELD_RESIDUAL = 0.25
#: p0 over K above which the law's elastic strains are no longer small.
MAX_P0_OVER_BULK = 0.1


@dataclass(frozen=True)
class Range:
    """A parameter over the samples.

    Attributes
    ----------
    value
        The mean of the samples; geometric for positive quantities.
    low, high
        The 95 % interval of the mean by Student's t; NaN with one sample.
    deviation
        Between samples: the standard deviation of the logarithm, or of the value itself.
    samples
        Number of samples.
    """

    value: float
    low: float
    high: float
    deviation: float
    samples: int

    @classmethod
    def of(cls, values: Sequence[float], *, logarithmic: bool = True) -> Range:
        """Return the range of some values.

        Examples
        --------
        >>> Range.of([1.0, 4.0]).value, round(Range.of([0.1, 0.3], logarithmic=False).value, 9)
        (2.0, 0.2)
        """
        if logarithmic:
            mean = LogMean.of(values)
            deviation = mean.error * math.sqrt(mean.count)
            return cls(mean.value, *mean.interval(), deviation, mean.count)
        mean = LogMean.of([math.exp(value) for value in values])
        low, high = (math.log(end) for end in mean.interval())
        return cls(mean.mean, low, high, mean.error * math.sqrt(mean.count), mean.count)


@dataclass
class FittedSnow:
    """A snow, and where its parameters come from.

    Attributes
    ----------
    law
        The parameters.
    ranges
        Each parameter's range, by its name in `Snow`; and ``tension_pa`` (axial),
        ``yield_residual``, ``hardening_residual``, ``confined_yield_over_law``.
    notes
        Notes on the limits of the fit.
    """

    law: CamClayFit
    ranges: dict[str, Range]
    notes: list[str] = field(default_factory=list)

    @property
    def step_count_ratio(self) -> float:
        """Number of MPM time steps, relative to the calibrated snow.

        The number is proportional to the speed of elastic waves.
        """
        return self.law.wave_speed / CamClayFit.of(Snow.preset("calibrated")).wave_speed


def isotropic_strength(curves: Curves) -> float:
    """Return the geometric mean of p0 over the samples, Pa, for the shear tests."""
    return Range.of(list(_read(curves, ISOTROPIC, readings.isotropic_yield, []).values())).value


@checked
def fit_material(
    curves: Curves, density: float, *, modulus: Optional[float] = None, min_grains: int = FEW_GRAINS
) -> FittedSnow:
    """Return the snow whose law agrees with the tests.

    E and nu come from the elastic phase of confined compression, p0 from the peak of isotropic
    compression, M and beta from the strengths in shear and tension, and xi from the hardening in
    isotropic compression.

    Parameters
    ----------
    curves
        From `read_curves`.
    density
        Density of the snow, kg/m3.
    modulus
        Young's modulus to use instead of the grains', Pa, for longer steps; xi then compensates.
    min_grains
        Number of grains of the smallest sample. [default: enough for its snow]

    Raises
    ------
    InputError
        If a parameter cannot be read from any sample, or the law would be meaningless.
    """
    notes: list[str] = []
    elasticities = list(_read(curves, CONFINED, readings.elasticity, notes).values())
    ranges = {
        "youngs_modulus": Range.of([reading.youngs_modulus for reading, _ in elasticities]),
        "poissons_ratio": Range.of(
            [reading.poissons_ratio for reading, _ in elasticities], logarithmic=False
        ),
    }
    nu = min(max(ranges["poissons_ratio"].value, 0.0), readings.MAX_POISSON)
    elastic = Elasticity(modulus or ranges["youngs_modulus"].value, nu)
    linearity = min(share for _, share in elasticities)
    if linearity < MIN_LINEARITY:
        notes.append(f"the elastic phase is not linear (R2 {linearity:.2f}): E is doubtful")
    strengths = _read(curves, ISOTROPIC, readings.isotropic_yield, notes)
    ranges["preconsolidation_pressure"] = Range.of(list(strengths.values()))
    p0 = ranges["preconsolidation_pressure"].value
    if p0 > MAX_P0_OVER_BULK * elastic.bulk_modulus:
        raise InputError(
            f"p0 {p0:.3g} Pa is {p0 / elastic.bulk_modulus:.2g} of the bulk modulus "
            f"{elastic.bulk_modulus:.3g} Pa: the law would yield at large elastic strains only; "
            f"up to {MAX_P0_OVER_BULK:g} are allowed"
        )
    own_p0 = {sample: value for (_, sample), value in strengths.items()}
    _read_strengths(curves, ranges, own_p0, notes)
    _read_hardening(curves, ranges, elastic, p0, notes)
    law = CamClayFit(
        density,
        elastic,
        ranges["critical_state_slope"].value,
        p0,
        ranges["cohesion"].value,
        ranges["hardening_factor"].value,
    )
    _check_confined(curves, ranges, law, notes)
    fitted = FittedSnow(law, ranges, notes)
    _note_meaning(fitted, modulus, min_grains)
    return fitted


def _read(
    curves: Curves, test: str, read: Callable[[LoadingCurve], Reading], notes: list[str]
) -> dict[tuple[str, int], Reading]:
    """Return a reading of each sample, by test and sample; a note reports failed readings."""
    values, failures = {}, []
    for (name, sample), curve in sorted(curves.items(), key=lambda item: item[0]):
        if name.partition(" ")[0] == test:
            try:
                values[name, sample] = read(curve)
            except InputError as error:
                failures.append(f"{name}, sample {sample + 1}: {error}")
    if not values:
        raise InputError("; ".join(failures) or f"no test {test} is computed")
    notes.extend(failures)
    return values


def _read_strengths(
    curves: Curves, ranges: dict[str, Range], own_p0: dict[int, float], notes: list[str]
) -> None:
    """Read M and beta: the yield surface through the strengths in tension and shear.

    Each sample's strengths are relative to its own p0.
    """
    tensions = _read(curves, TENSION, readings.tension, notes)
    strengths = {**_read(curves, SHEAR, readings.shear_strength, notes), **tensions}
    ranges["tension_pa"] = Range.of([_axial(*tension) for tension in tensions.values()])
    p0 = ranges["preconsolidation_pressure"].value
    points: dict[int, list[tuple[float, float]]] = {}
    for (_, sample), (p, q) in strengths.items():
        own = own_p0.get(sample, p0)
        points.setdefault(sample, []).append((p / own, q / own))
    surface = fit_yield_surface(*np.array([point for some in points.values() for point in some]).T)
    each = [fit_yield_surface(*np.array(some).T) for some in points.values() if len(some) > 1]
    slopes = Range.of([fit.slope for fit in each])
    betas = Range.of([fit.cohesion for fit in each], logarithmic=False)
    ranges["critical_state_slope"] = replace(slopes, value=surface.slope)
    ranges["cohesion"] = replace(betas, value=surface.cohesion)
    ranges["yield_residual"] = Range.of([surface.residual])
    if surface.residual > MAX_YIELD_RESIDUAL:
        notes.append(
            f"the law's yield surface misses the strengths by {100 * surface.residual:.0f} % of "
            "their size"
        )
    if surface.cohesion in (0.0, 1.0):
        notes.append(
            f"beta {surface.cohesion:g} is at the limit of the law: its tensile strength differs "
            f"from that of the grains, {ranges['tension_pa'].value:.3g} Pa"
        )


def _axial(p: float, q: float) -> float:
    """Return the axial tension of a stretched sample, from p < 0 and q = side - axial."""
    return -p + 2 * q / 3


def _read_hardening(
    curves: Curves, ranges: dict[str, Range], elastic: Elasticity, p0: float, notes: list[str]
) -> None:
    read = _read(curves, COMPACTION, lambda curve: readings.hardening(curve, elastic, p0), notes)
    hardenings = list(read.values())
    ranges["hardening_factor"] = Range.of([hardening.factor for hardening in hardenings])
    ranges["hardening_residual"] = Range.of([hardening.residual for hardening in hardenings])
    excess = max(hardening.excess for hardening in hardenings)
    if excess > MAX_LAW_OVER_GRAINS:
        notes.append(
            f"between its brittle peak and hardening the snow is up to {excess:.2g} times weaker "
            "than the law, which does not soften while it compacts"
        )


def _check_confined(
    curves: Curves, ranges: dict[str, Range], law: CamClayFit, notes: list[str]
) -> None:
    """Compare the peaks of confined compression, which are not fitted, with the law."""
    stress = law.confined_yield()
    peaks = _read(curves, CONFINED, readings.confined_peak, notes)
    ranges["confined_yield_over_law"] = ratio = Range.of([peak / stress for peak in peaks.values()])
    if not 1 / MAX_LAW_OVER_GRAINS <= ratio.value <= MAX_LAW_OVER_GRAINS:
        notes.append(
            f"in confined compression the grains' peak is {ratio.value:.2g} times the law's yield "
            "stress, to which nothing is fitted"
        )


def _note_meaning(fitted: FittedSnow, modulus: Optional[float], min_grains: int) -> None:
    notes = fitted.notes
    own = fitted.ranges["youngs_modulus"].value
    if modulus is not None:
        notes.append(
            f"E is given; that of the grains is {own:.3g} Pa. The hardening factor compensates"
        )
    notes.append(
        f"the material point method takes {fitted.step_count_ratio:.2g} times as many steps as "
        "with the calibrated snow; the law has lost its strength after "
        f"{percent(fitted.law.dilation_at_strength_loss, 2)} of plastic dilation"
    )
    if min_grains < FEW_GRAINS:
        notes.append(f"{min_grains} grains: so small a sample hardly represents its snow")
    if fitted.ranges["preconsolidation_pressure"].samples < 2:
        notes.append("one sample: the ranges of the parameters are not known")


def exponents(laws: Sequence[CamClayFit]) -> dict[str, float]:
    """Return the exponents n with which E and p0 grow as density^n; empty for one density.

    Examples
    --------
    >>> laws = [CamClayFit(d, Elasticity(d**4, 0.3), 0.5, d, 0.2, 0.1) for d in (100.0, 200.0)]
    >>> {name: round(n, 6) for name, n in exponents(laws).items()}
    {'youngs_modulus': 4.0, 'preconsolidation_pressure': 1.0}
    """
    densities = np.log([law.density for law in laws])
    if len(set(densities)) < 2:
        return {}
    moduli = np.log([law.elastic.youngs_modulus for law in laws])
    pressures = np.log([law.preconsolidation_pressure for law in laws])
    return {
        "youngs_modulus": float(np.polyfit(densities, moduli, 1)[0]),
        "preconsolidation_pressure": float(np.polyfit(densities, pressures, 1)[0]),
    }
