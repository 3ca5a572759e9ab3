"""Scatter of strengths between samples of the same snow, as far as it has been recorded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

#: Ratio of numbers of grains, and of densities, up to which a record applies to a sample.
MAX_GRAIN_RATIO, MAX_DENSITY_RATIO = 1.5, 1.1


@dataclass(frozen=True)
class RecordedScatter:
    """Scatter of the strength in compression between samples of one snow.

    Attributes
    ----------
    grains
        Mean number of grains of a sample.
    density
        Mean density, kg/m3.
    samples
        Number of samples.
    scatter
        Standard deviation of their strengths over their mean.
    """

    grains: int
    density: float
    samples: int
    scatter: float


#: Synthetic samples, from docs/trust/grains-record.md: "Strength and the grid of voxels", and
#: "Sensitivity".
RECORDS = (
    RecordedScatter(grains=150, density=320.0, samples=10, scatter=0.35),
    RecordedScatter(grains=1050, density=318.0, samples=3, scatter=0.09),
)


def recorded_scatter(grains: int, density: float, kind: str) -> Optional[RecordedScatter]:
    """Return the recorded scatter of samples like one; None if there is none.

    Parameters
    ----------
    grains
        Number of grains of the sample.
    density
        Its density, kg/m3.
    kind
        Kind of the loading stage.

    Examples
    --------
    >>> recorded_scatter(1000, 320.0, "compress").samples
    3
    >>> recorded_scatter(1000, 320.0, "shear") is None
    True
    """
    if kind != "compress":
        return None
    for record in RECORDS:
        if (
            _ratio(grains, record.grains) <= MAX_GRAIN_RATIO
            and _ratio(density, record.density) <= MAX_DENSITY_RATIO
        ):
            return record
    return None


def scatter_note(grains: int, density: float, kind: str) -> str:
    """Return a note on the strength of a single sample.

    Examples
    --------
    >>> scatter_note(20, 320.0, "compress")
    'the strength is that of one sample; the scatter between samples of this size is not known'
    >>> scatter_note(1000, 320.0, "compress")  # doctest: +ELLIPSIS
    'the strength is that of one sample; strengths of samples of this size scatter by 9 % (...)'
    """
    record = recorded_scatter(grains, density, kind)
    if record is None:
        unknown = "the scatter between samples of this size is not known"
        if recorded_scatter(grains, RECORDS[0].density, "compress"):
            unknown = f"the scatter between samples {_other(density, kind)} is not known"
        return f"the strength is that of one sample; {unknown}"
    return (
        "the strength is that of one sample; strengths of samples of this size scatter by "
        f"{100 * record.scatter:.0f} % (standard deviation of {record.samples} synthetic samples, "
        f"{record.grains} grains, {record.density:.0f} kg/m3)"
    )


def scatter_words(grains: int, density: float, kind: str) -> str:
    """Return a few words that stand beside the strength of a single sample.

    Examples
    --------
    >>> scatter_words(1000, 320.0, "compress"), scatter_words(20, 320.0, "compress")
    ('scatter between samples 9 %', 'scatter between samples not known')
    """
    record = recorded_scatter(grains, density, kind)
    return f"scatter between samples {f'{100 * record.scatter:.0f} %' if record else 'not known'}"


def _other(density: float, kind: str) -> str:
    """Return the property of a sample for which there is no record."""
    return f"of {density:.0f} kg/m3" if kind == "compress" else f'under the load "{kind}"'


def _ratio(first: float, other: float) -> float:
    return max(first / other, other / first) if first > 0 else float("inf")
