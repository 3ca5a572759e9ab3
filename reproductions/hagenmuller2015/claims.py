"""The paper's claims on snow in compression, and the rules by which they are judged.

The rules were set before the computations. Numbers are logarithms of ratios of stresses, each the
mean over samples, with the standard error from the scatter between samples, widened by Student's t.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations
from typing import TYPE_CHECKING

from reproductions.common.hypothesis_tests import (
    CONFIRMED,
    CONTRADICTED,
    UNDECIDED,
    Claim,
    Estimate,
    Finding,
    all_of,
    is_near,
    is_negative,
    is_positive,
    is_small,
    widening,
)
from reproductions.hagenmuller2015.printed import YADE
from reproductions.hagenmuller2015.studies import (
    ELASTIC,
    EXCESSIVE_INERTIA,
    FEWER_GRAINS,
    HEAVY_SNOW,
    HIGH_FRICTION,
    LIGHT_SNOW,
    SOFT_ICE,
    THIN_NECKS,
    WIDE_NECKS,
)
from snowshed.analysis.grains.ratios import STRESSES, LogMean, paired_ratios
from snowshed.analysis.grains.variants import BASE
from snowshed.base.formatting import percent

if TYPE_CHECKING:
    import pandas as pd

PEAK, EARLY, MIDDLE, DENSE = STRESSES
SCALED_DENSITY = "density of ice x 100"
HALF_EDGE = "volume / 8"
#: Largest log ratio of stresses that hardly differ.
MAX_LOG_SIMILAR = math.log(1.3)
#: Smallest log ratio of clearly different stresses.
MIN_LOG_DISTINCT = math.log(2.0)
#: Log ratio above which two of Yade's numbers differ by more than a sample's scatter.
MIN_LOG_CLEAR = math.log(1.5)
#: Largest remaining part of a reversible strain, relative to the peak strain.
MAX_REMAINING_STRAIN = 0.05
#: Smallest R2 of a linear curve.
MIN_LINEARITY = 0.95


@dataclass(frozen=True)
class LoadingTests:
    """The computed loading tests.

    Attributes
    ----------
    tables
        A table per comparison, with a row per variant and sample. Comparisons that load further
        come first.
    """

    tables: Sequence[pd.DataFrame]

    def of(self, variant: str) -> pd.DataFrame:
        """Return the tests of a variant; raises LookupError if there is none."""
        table = self._with(variant)
        return table[table["variant"] == variant]

    def log(self, variant: str, stress: str) -> Estimate:
        """Return the logarithm of a stress in Pa, as the mean over the samples."""
        return _estimate(LogMean.of(self.of(variant)[stress].astype(float).tolist()))

    def change(self, variant: str, stress: str, base: str = BASE) -> Estimate:
        """Return the mean log ratio of a stress to that of another variant, sample by sample."""
        table = self._with(variant, base)
        return _estimate(LogMean.of(paired_ratios(table, variant, stress, base).tolist()))

    def _with(self, *variants: str) -> pd.DataFrame:
        """Return the first comparison with some variants; raises LookupError if there is none."""
        for table in self.tables:
            if set(variants) <= set(table["variant"]):
                return table
        raise LookupError(" beside ".join(variants))


def _estimate(mean: LogMean) -> Estimate:
    if not mean.count:
        raise LookupError("a stress that is positive")
    return Estimate(mean.mean, mean.error * widening(mean.count - 1))


def factor(ratio: Estimate, what: str) -> str:
    """Return the text of a ratio with its noise.

    Examples
    --------
    >>> factor(Estimate(math.log(2.0), math.log(1.1)), "strength")
    'strength: x 2 (noise: factor 1.1)'
    """
    noise = "not known" if math.isnan(ratio.noise) else f"factor {math.exp(ratio.noise):.2g}"
    return f"{what}: x {math.exp(ratio.value):.3g} (noise: {noise})"


def is_reversible(tests: LoadingTests) -> Finding:
    """Test whether loading and unloading in the elastic phase leaves no trace."""
    rows = tests.of(ELASTIC)
    broken = (rows["broken_in_tension"] + rows["broken_in_shear"]).astype(float)
    peak, remaining = rows["elastic_limit_strain"].astype(float), rows["axial_strain"].astype(float)
    linear = rows["linearity"].astype(float)
    is_good = (
        (broken == 0) & (remaining.abs() <= MAX_REMAINING_STRAIN * peak) & (linear >= MIN_LINEARITY)
    )
    verdict = CONFIRMED if is_good.all() else CONTRADICTED if not is_good.any() else UNDECIDED
    return Finding(
        verdict,
        f"{int(is_good.sum())} of {len(rows)} samples: at most {int(broken.max())} bonds broken, "
        f"{percent((remaining.abs() / peak).max(), 2)} of the strain left, "
        f"R2 from {linear.min():.3f}",
    )


def softens(tests: LoadingTests) -> Finding:
    """Test whether the stress falls after its peak."""
    rows = tests.of(BASE)
    drop = _estimate(LogMean.of((rows[EARLY].astype(float) / rows[PEAK].astype(float)).tolist()))
    return _with_factor(is_negative(drop, ""), drop, "mean from 5 to 10 % over the peak below 5 %")


def hardens(tests: LoadingTests) -> Finding:
    """Test whether the stress more than doubles from 10-15 to 25-30 %, like an exponential."""
    rows = tests.of(BASE)
    growth = (rows[DENSE].astype(float) / rows[MIDDLE].astype(float)).tolist()
    rise = _estimate(LogMean.of(growth))
    finding = _with_factor(
        is_positive(rise - Estimate(MIN_LOG_DISTINCT, 0.0), ""), rise, "25 to 30 % over 10 to 15 %"
    )
    onset = rows["hardening_onset_strain"].astype(float)
    seen = int(onset.notna().sum())
    begins = f"exponential from {percent(onset.mean(), 2)} in {seen} of {len(rows)}"
    is_complete = seen == len(rows) or finding.verdict != CONFIRMED
    return Finding(finding.verdict if is_complete else UNDECIDED, f"{finding.sentence}; {begins}")


def rises(variant: str, base: str, stresses: Sequence[str], tests: LoadingTests) -> Finding:
    """Test whether stresses of a variant are larger than those of another."""
    changes = [tests.change(variant, stress, base) for stress in stresses]
    return all_of(
        [
            _with_factor(is_positive(change, ""), change, STRESSES[name])
            for change, name in zip(changes, stresses)
        ]
    )


def falls(variant: str, stress: str, tests: LoadingTests, *, by: float = 0.0) -> Finding:
    """Test whether the logarithm of a stress is below the base's by more than `by`."""
    change = tests.change(variant, stress)
    return _with_factor(is_negative(change - Estimate(-by, 0.0), ""), change, STRESSES[stress])


def hardly_differs(
    variants: Sequence[str], stress: str, tests: LoadingTests, base: str = BASE
) -> Finding:
    """Test whether a stress hardly differs from the base's."""
    findings = []
    for variant in variants:
        change = tests.change(variant, stress, base)
        findings.append(
            _with_factor(
                is_small(change, MAX_LOG_SIMILAR, ""), change, f"{variant}, {STRESSES[stress]}"
            )
        )
    return all_of(findings)


def agrees_with_yade(stress: str, tests: LoadingTests) -> Finding:
    """Test whether a stress of the base is that of Yade within 30 %."""
    value = YADE[BASE][list(STRESSES).index(stress)]
    assert value is not None
    logarithm = tests.log(BASE, stress)
    verdict = is_near(logarithm, math.log(1e3 * value), MAX_LOG_SIMILAR, "").verdict
    text = f"{STRESSES[stress]} {math.exp(logarithm.value) / 1e3:.3g} kPa, Yade {value:g} kPa"
    return Finding(verdict, factor(logarithm - Estimate(math.log(1e3 * value), 0.0), text))


def same_signs(variant: str, tests: LoadingTests) -> Finding:
    """Test whether stresses change in the same direction as in Yade.

    Stresses that change in Yade by less than the scatter are left out.
    """
    findings = []
    for stress, printed, base in zip(STRESSES, YADE[variant], YADE[BASE]):
        if printed is None or base is None or abs(math.log(printed / base)) < MIN_LOG_CLEAR:
            continue
        change = tests.change(variant, stress)
        test = is_positive if printed > base else is_negative
        text = f"{STRESSES[stress]} (Yade x {printed / base:.3g})"
        findings.append(_with_factor(test(change, ""), change, text))
    return all_of(findings)


def same_order(stress: str, tests: LoadingTests) -> Finding:
    """Test whether all pairs of variants that differ clearly in Yade have the same order here."""
    place = list(STRESSES).index(stress)
    pairs = []
    for first, second in combinations(YADE, 2):
        high, low = YADE[first][place], YADE[second][place]
        if high is None or low is None or abs(math.log(high / low)) < MIN_LOG_CLEAR:
            continue
        above, below = (first, second) if high > low else (second, first)
        pairs.append((is_positive(tests.change(above, stress, below), "").verdict, above, below))
    verdict = all_of([Finding(verdict, "") for verdict, _, _ in pairs]).verdict
    right = sum(verdict == CONFIRMED for verdict, _, _ in pairs)
    wrong = [
        f"{above} not above {below}" for verdict, above, below in pairs if verdict == CONTRADICTED
    ]
    text = f"{right} of {len(pairs)} pairs in this order beyond noise"
    return Finding(verdict, "; ".join([text, *wrong]))


def _with_factor(finding: Finding, change: Estimate, what: str) -> Finding:
    return Finding(finding.verdict, factor(change, what))


def _direction_text(variant: str) -> str:
    return f"{variant}: stresses change in the direction in which they change in Yade"


PAPER: list[Claim[LoadingTests]] = [
    Claim(
        "elastic phase",
        "At first the deformation is elastic: linear, reversible, and no bond breaks.",
        "in every sample no bond breaks, less than 5 % of the strain is left, R2 above 0.95",
        is_reversible,
    ),
    Claim(
        "brittle phase",
        "Then bonds break, and the stress falls from its peak.",
        "the mean stress from 5 to 10 % is below the peak below 5 %",
        softens,
    ),
    Claim(
        "hardening",
        "At last the stress grows like an exponential.",
        "it more than doubles from 10-15 to 25-30 %, and every sample has a hardening phase",
        hardens,
    ),
    Claim(
        "density",
        "Density controls the stress.",
        f"stresses at {HEAVY_SNOW} are above those at 318 kg/m3, in all ranges of strain",
        lambda tests: rises(HEAVY_SNOW, BASE, list(STRESSES), tests),
    ),
    Claim(
        "density",
        "Density controls the stress, in light snow too.",
        f"stresses at 318 kg/m3 are above those at {LIGHT_SNOW}, in all ranges of strain",
        lambda tests: rises(BASE, LIGHT_SNOW, list(STRESSES), tests),
    ),
    Claim(
        "snow types",
        "Faceted snow is weaker than rounded or decomposed snow of equal density at first. (Here: "
        "thin against wide necks of sphere packs; no facets can be made.)",
        "the peak below 5 % with thin necks is below that with wide necks",
        lambda tests: rises(WIDE_NECKS, THIN_NECKS, [PEAK], tests),
    ),
    Claim(
        "snow types",
        "At large strain types of equal density do not differ clearly. (Here: necks as above.)",
        "stresses from 25 to 30 % differ by less than a factor of 1.3",
        lambda tests: hardly_differs([THIN_NECKS], DENSE, tests, WIDE_NECKS),
    ),
    Claim(
        "sphere size",
        "The brittle phase is insensitive to the size of the spheres.",
        "peaks of spheres half and one and a half times as large differ by less than 1.3",
        lambda tests: hardly_differs(["spheres 50 um", "spheres 150 um"], PEAK, tests),
    ),
    Claim(
        "segmentation",
        "The brittle phase is insensitive to the number of grains.",
        "the peak of half as many grains of the same ice differs by less than a factor of 1.3",
        lambda tests: hardly_differs([FEWER_GRAINS], PEAK, tests),
    ),
    Claim(
        "volume",
        "The volume is representative.",
        "the peak of an eighth of the volume differs by less than a factor of 1.3",
        lambda tests: hardly_differs([HALF_EDGE], PEAK, tests),
    ),
    Claim(
        "elastic modulus",
        "The brittle phase is insensitive to Young's modulus.",
        "the peak with a tenth of it differs by less than a factor of 1.3",
        lambda tests: hardly_differs([SOFT_ICE], PEAK, tests),
    ),
    Claim(
        "elastic modulus",
        "The dense phase is very sensitive to Young's modulus.",
        "the stress from 25 to 30 % with a tenth of it is less than half",
        lambda tests: falls(SOFT_ICE, DENSE, tests, by=MIN_LOG_DISTINCT),
    ),
    Claim(
        "friction",
        "Friction between grains raises the stress.",
        "peak, and mean from 25 to 30 %, are above the base's with friction 0.5 instead of 0.2",
        lambda tests: rises(HIGH_FRICTION, BASE, [PEAK, DENSE], tests),
    ),
    Claim(
        "density of ice",
        "Denser ice, which saves time, hardly changes the brittle phase.",
        "the peak with density_scaling 100 instead of 10 differs by less than a factor of 1.3",
        lambda tests: hardly_differs([SCALED_DENSITY], PEAK, tests),
    ),
]
ENGINE: list[Claim[LoadingTests]] = [
    Claim(
        "density of ice",
        "Far too dense ice raises the peak, by inertia.",
        "the peak with density_scaling 10000 is above the base's",
        lambda tests: rises(EXCESSIVE_INERTIA, BASE, [PEAK], tests),
    ),
    *(
        Claim(
            "base",
            f"{STRESSES[stress]} as with Yade, on a comparable sample",
            "within 30 % (a factor of 1.3)",
            partial(agrees_with_yade, stress),
        )
        for stress in (PEAK, EARLY)
    ),
    *(
        Claim(
            "line",
            _direction_text(variant),
            "for every stress that changes by more than a factor of 1.5 in Yade",
            partial(same_signs, variant),
        )
        for variant in YADE
        if variant != BASE
    ),
    *(
        Claim(
            "column",
            f"{STRESSES[stress]}: the lines have Yade's order",
            "for all pairs of lines that are apart by more than a factor of 1.5 in Yade",
            partial(same_order, stress),
        )
        for stress in STRESSES
    ),
]
