"""Folders with images of snow: the files that loading tests and segmentation read."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from snowshed.base.arrays import positive
from snowshed.base.paths import PathLike
from snowshed.io.json_file import read_object

SNOW = "snow.npy"
LABELS = "labels.npy"
NUMBERS = "microstructure.json"
SYNTHETIC = "synthetic"  # beginning of the source of a synthetic sample


@dataclass(frozen=True)
class SampleFile:
    """An image or labels, with voxel size and origin.

    Attributes
    ----------
    file
        The file.
    voxel_size
        Edge of a voxel, m; None: not known.
    source
        Origin of synthetic ones; else empty.
    """

    file: Path
    voxel_size: Optional[float]
    source: str = ""


def find_sample(path: PathLike, name: str) -> SampleFile:
    """Return a file of a sample, with the numbers of ``microstructure.json`` beside it.

    Parameters
    ----------
    path
        A folder that ``snowshed grains segment`` or ``synthetic`` wrote, or any other path.
    name
        Name of the file in such a folder, `SNOW` or `LABELS`.

    Raises
    ------
    InputError
        If ``microstructure.json`` is damaged.

    Examples
    --------
    >>> find_sample("labels.npy", LABELS).voxel_size is None
    True
    """
    file = Path(path)
    if (file / NUMBERS).is_file():
        file = file / name
    numbers = file.with_name(NUMBERS)
    if file.name not in (SNOW, LABELS) or not numbers.is_file():
        return SampleFile(file, None)
    facts = read_object(numbers)
    size = positive(f"{numbers}: voxel_size_m", facts.get("voxel_size_m", float("nan")))
    return SampleFile(
        file, size, str(facts.get("source", SYNTHETIC)) if facts.get("synthetic") is True else ""
    )
