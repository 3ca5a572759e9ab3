"""Scatter of strengths between samples of the same snow, as far as it has been recorded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

from snowshed.base.formatting import percent

#: Ratios of numbers of grains, of densities and of voxels up to which a record applies to a sample.
MAX_GRAIN_RATIO, MAX_DENSITY_RATIO, MAX_VOXEL_RATIO = 1.3, 1.1, 1.2


@dataclass(frozen=True)
class RecordedScatter:
    """Scatter of the strength in compression between samples of one snow.

    Attributes
    ----------
    grains
        Mean number of grains of a sample.
    density
        Mean density, kg/m3.
    voxel
        Edge of a voxel, m.
    samples
        Number of samples.
    scatter
        Standard deviation of their strengths over their mean.
    """

    grains: int
    density: float
    voxel: float
    samples: int
    scatter: float


#: Synthetic samples, from docs/trust/grains-record.md: "Strength and the grid of voxels", and
#: "Sensitivity".
RECORDS = (
    RecordedScatter(grains=45, density=319.0, voxel=1e-4, samples=10, scatter=0.61),
    RecordedScatter(grains=84, density=319.0, voxel=7.5e-5, samples=10, scatter=0.44),
    RecordedScatter(grains=115, density=319.0, voxel=5e-5, samples=30, scatter=0.30),
    RecordedScatter(grains=1050, density=318.0, voxel=1e-4, samples=3, scatter=0.09),
)


def recorded_scatter(
    grains: int, density: float, voxel: float, kind: str
) -> Optional[RecordedScatter]:
    """Return the recorded scatter of samples like one; None if there is none.

    Parameters
    ----------
    grains
        Number of grains of the sample.
    density
        Its density, kg/m3.
    voxel
        Edge of its voxels, m.
    kind
        Kind of the loading stage; only compression has been recorded.

    Examples
    --------
    >>> recorded_scatter(1000, 320.0, 1e-4, "compress").samples
    3
    >>> recorded_scatter(1000, 320.0, 1e-4, "shear") is None
    True
    """
    if kind != "compress":
        return None
    for record in RECORDS:
        if (
            _ratio(grains, record.grains) <= MAX_GRAIN_RATIO
            and _ratio(density, record.density) <= MAX_DENSITY_RATIO
            and _ratio(voxel, record.voxel) <= MAX_VOXEL_RATIO
        ):
            return record
    return None


def scatter_note(record: Optional[RecordedScatter]) -> str:
    """Return a note on the strength of a single sample.

    Parameters
    ----------
    record
        From `recorded_scatter`.

    Examples
    --------
    >>> scatter_note(None)[:70]
    'the strength is that of one sample; how much strengths of such samples'
    >>> scatter_note(recorded_scatter(1000, 320.0, 1e-4, "compress"))[-72:]
    '(standard deviation of 3 synthetic samples of 1050 grains and 318 kg/m3)'
    """
    if record is None:
        return (
            "the strength is that of one sample; how much strengths of such samples scatter is not "
            "known: load several"
        )
    return (
        "the strength is that of one sample; strengths of samples of this size scatter by "
        f"{percent(record.scatter)} (standard deviation of {record.samples} synthetic samples of "
        f"{record.grains} grains and {record.density:.0f} kg/m3)"
    )


def scatter_words(record: Optional[RecordedScatter]) -> str:
    """Return a few words that stand beside the strength of a single sample.

    Examples
    --------
    >>> scatter_words(None)
    'scatter between samples not known'
    """
    return f"scatter between samples {percent(record.scatter) if record else 'not known'}"


def _ratio(first: float, other: float) -> float:
    return max(first / other, other / first) if first > 0 else float("inf")
