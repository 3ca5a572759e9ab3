"""Tests of claims: a number, its noise, and the claim about the number."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from snowshed.base.formatting import MISSING, number, percent

CONFIRMED, CONTRADICTED, UNDECIDED = "confirmed", "contradicted", "undecided"
#: A difference counts if it is larger than this number of standard deviations of its noise.
SIGMAS = 2.0

Data = TypeVar("Data")


@dataclass(frozen=True)
class Estimate:
    """A number with the standard deviation of its noise; NaN: the noise is unknown.

    Examples
    --------
    >>> (Estimate(3.0, 0.3) - Estimate(1.0, 0.4)).noise
    0.5
    """

    value: float
    noise: float

    def __sub__(self, other: Estimate) -> Estimate:
        return Estimate(self.value - other.value, math.hypot(self.noise, other.noise))

    def scaled(self, factor: float) -> Estimate:
        """Return the number in another unit, or relative to an exact number."""
        return Estimate(self.value * factor, self.noise * abs(factor))

    def text(self, unit: str = "") -> str:
        """Return number and noise as text; the unit "%" is for shares.

        Examples
        --------
        >>> Estimate(0.0123, 0.0004).text("m"), Estimate(0.5, 0.01).text("%")
        ('0.0123 ± 0.0004 m', '50 % ± 1 %')
        """
        if unit == "%":
            return f"{percent(self.value)} ± {percent(self.noise, 2)}"
        noise = MISSING if math.isnan(self.noise) else number(self.noise, 2)
        return f"{number(self.value)} ± {noise} {unit}".rstrip()


def widening(freedom: float) -> float:
    """Return the factor by which Student's t widens a noise estimated from few numbers.

    Then `SIGMAS` times the widened noise covers 95 %, as with an exact noise.

    Examples
    --------
    >>> [round(widening(freedom), 2) for freedom in (2, 6, 1000)]
    [2.26, 1.26, 1.0]
    """
    if freedom <= 0:
        return math.nan
    from scipy import stats

    return float(stats.t.ppf(stats.norm.cdf(SIGMAS), freedom)) / SIGMAS


def mean_of(estimates: Sequence[Estimate]) -> Estimate:
    """Return the mean of numbers whose noises are independent."""
    mean = math.fsum(estimate.value for estimate in estimates) / len(estimates)
    return Estimate(mean, math.hypot(*(estimate.noise for estimate in estimates)) / len(estimates))


@dataclass(frozen=True)
class Finding:
    """The verdict of the data on a claim.

    Attributes
    ----------
    verdict
        "confirmed", "contradicted" or "undecided".
    sentence
        The deciding number, with its noise.
    """

    verdict: str
    sentence: str


@dataclass(frozen=True)
class Claim(Generic[Data]):
    """A claim of a publication.

    Attributes
    ----------
    source
        Section, table or figure of the claim.
    text
        The claim.
    rule
        Condition for "confirmed". The opposite contradicts the claim, and a number
        within `SIGMAS` deviations of noise from the bound leaves it undecided.
    judge
        Function from the data to the finding.
    """

    source: str
    text: str
    rule: str
    judge: Callable[[Data], Finding]


@dataclass(frozen=True)
class JudgedClaim:
    """A claim's text with its finding."""

    source: str
    text: str
    rule: str
    finding: Finding


def judge(claims: Sequence[Claim[Data]], data: Data) -> list[JudgedClaim]:
    """Test claims against the same data; missing data leave a claim undecided."""
    return [
        JudgedClaim(claim.source, claim.text, claim.rule, _finding(claim, data)) for claim in claims
    ]


def _finding(claim: Claim[Data], data: Data) -> Finding:
    try:
        return claim.judge(data)
    except LookupError as missing:
        return Finding(UNDECIDED, f"the data lack {missing}")


def is_positive(estimate: Estimate, what: str, unit: str = "") -> Finding:
    """Test the claim that a number is above zero.

    Examples
    --------
    >>> is_positive(Estimate(0.3, 0.1), "growth", "m")
    Finding(verdict='confirmed', sentence='growth: 0.3 ± 0.1 m')
    >>> [is_positive(Estimate(x, 0.1), "").verdict for x in (-0.3, 0.1)]
    ['contradicted', 'undecided']
    """
    return Finding(_sign(estimate.value, estimate.noise), _sentence(what, estimate, unit))


def is_negative(estimate: Estimate, what: str, unit: str = "") -> Finding:
    """Test the claim that a number is below zero."""
    return Finding(_sign(-estimate.value, estimate.noise), _sentence(what, estimate, unit))


def is_small(estimate: Estimate, bound: float, what: str, unit: str = "") -> Finding:
    """Test the claim that the magnitude of a number is at most a bound.

    Examples
    --------
    >>> [is_small(Estimate(x, 0.02), 0.1, "").verdict for x in (0.01, -0.2, 0.09)]
    ['confirmed', 'contradicted', 'undecided']
    """
    verdict = _sign(bound - abs(estimate.value), estimate.noise)
    return Finding(verdict, _sentence(what, estimate, unit))


def is_near(estimate: Estimate, target: float, bound: float, what: str, unit: str = "") -> Finding:
    """Test the claim that a number is close to another: their difference is within a bound."""
    difference = Estimate(estimate.value - target, estimate.noise)
    return Finding(is_small(difference, bound, "").verdict, _sentence(what, estimate, unit))


def all_of(findings: Sequence[Finding]) -> Finding:
    """Return the finding on a claim with several parts: it holds if every part does."""
    verdicts = {finding.verdict for finding in findings}
    ranked = (CONTRADICTED, UNDECIDED, CONFIRMED)
    verdict = next((worst for worst in ranked if worst in verdicts), UNDECIDED)
    return Finding(verdict, "; ".join(finding.sentence for finding in findings))


def _sign(value: float, noise: float) -> str:
    if math.isnan(value) or math.isnan(noise) or abs(value) <= SIGMAS * noise:
        return UNDECIDED
    return CONFIRMED if value > 0 else CONTRADICTED


def _sentence(what: str, estimate: Estimate, unit: str) -> str:
    return f"{what}: {estimate.text(unit)}"
