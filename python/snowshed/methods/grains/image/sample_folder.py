"""What loading tests take from a folder of grains."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.io.array_arguments import positive
from snowshed.io.json_file import read_object
from snowshed.io.paths import PathLike

LABELS = "labels.npy"
NUMBERS = "microstructure.json"


@dataclass(frozen=True)
class SampleFile:
    """Labels, and what is known of them.

    Attributes
    ----------
    labels
        The NPY file.
    voxel_size
        Edge of a voxel, m.
    source
        What they show, if it is known and synthetic; else empty.
    """

    labels: Path
    voxel_size: float
    source: str = ""


def find_sample(path: PathLike, voxel_size: Optional[float] = None) -> SampleFile:
    """Return the labels at a path.

    Parameters
    ----------
    path
        A folder that ``snowshed grains segment`` or ``synthetic`` wrote, or an NPY file.
    voxel_size
        Edge of a voxel, m; None: as ``microstructure.json`` says, which stands beside the labels.

    Raises
    ------
    InputError
        If there are no labels, or nothing says how large a voxel is.
    """
    file = Path(path) / LABELS if Path(path).is_dir() else Path(path)
    numbers = file.with_name(NUMBERS)
    if not numbers.is_file():
        if voxel_size is None:
            raise InputError(
                f"{file}: no {NUMBERS} beside it; give the edge of a voxel (--voxel) in m"
            )
        return SampleFile(file, voxel_size)
    facts = read_object(numbers)
    source = str(facts.get("source", "")) if facts.get("synthetic") is True else ""
    if voxel_size is not None:
        return SampleFile(file, voxel_size, source)
    size = positive(f"{numbers}: voxel_size_m", facts.get("voxel_size_m", float("nan")))
    return SampleFile(file, size, source)
