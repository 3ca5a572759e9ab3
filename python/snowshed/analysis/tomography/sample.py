"""Images of snow: the folder with their ice, their grains and their numbers.

================== ==========================================================================
snow.npy           the ice (nz, ny, nx): 1, and 0 for air
labels.npy         the grains (nz, ny, nx): 1, 2, ..., and 0 for air
grains.csv         the grains: volume, diameter, surface, contacts
                   (`snowshed.analysis.tomography.grain_tables.grain_table`)
contacts.csv       the contacts between them
microstructure.json  numbers of the ice and the grains, and how they were found
slices.png         three slices with a colour for each grain
surface.vtp        the surface of the ice for ParaView (only if asked for)
================== ==========================================================================
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Optional, Union

import numpy as np

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.analysis.tomography.grain_tables import (
    GrainStatistics,
    contact_table,
    grain_statistics,
    grain_table,
)
from snowshed.analysis.tomography.ice_image import IceImage
from snowshed.analysis.tomography.microstructure import Microstructure, measure_microstructure
from snowshed.analysis.tomography.segmentation import Segmentation
from snowshed.analysis.tomography.surface_mesh import write_surface
from snowshed.base.arguments import checked
from snowshed.base.arrays import AnyIntegers
from snowshed.base.paths import PathLike
from snowshed.io.atomic import replacing, write_text
from snowshed.io.csv_table import write_csv
from snowshed.io.folders import check_empty
from snowshed.methods.grains.sample_folder import LABELS, NUMBERS, SNOW

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Fact = Union[str, float, int, bool, None, list[str]]


@dataclass(frozen=True)
class SampleNumbers:
    """Numbers of an image of snow.

    Attributes
    ----------
    ice
        Numbers of the ice.
    grains
        Numbers of the grains; None if grains are not separated.
    """

    ice: Microstructure
    grains: Optional[GrainStatistics] = None


def check_new(folder: PathLike) -> None:
    """Raise InputError unless a folder is new or empty."""
    check_empty(folder, "; choose a new folder")


@checked
def write_ice(folder: PathLike, image: IceImage, facts: Mapping[str, Fact]) -> SampleNumbers:
    """Write an image of ice into a folder, and return its numbers.

    Parameters
    ----------
    folder
        New or empty.
    image
        The image to write; for a sphere pack, its known grains are written, too.
    facts
        Facts about its making, for ``microstructure.json``.

    Raises
    ------
    InputError
        If the folder is not empty, or the image cannot be snow.
    """
    from snowshed.analysis.tomography.slices import slices_figure

    check_new(folder)
    path, numbers = Path(folder), SampleNumbers(measure_microstructure(image))
    path.mkdir(parents=True, exist_ok=True)
    _write_array(path / SNOW, image.ice.view(np.uint8))
    _write_numbers(path, numbers, facts)
    _save(slices_figure(image.ice.astype(np.int32), numbers.ice), path)
    return numbers


@checked
def write_grains(
    folder: PathLike,
    segmentation: Segmentation,
    facts: Mapping[str, Fact],
    *,
    surface: bool = False,
) -> SampleNumbers:
    """Write the grains of an image into a folder, and return their numbers.

    Parameters
    ----------
    folder
        New or empty.
    segmentation
        The grains.
    facts
        Facts about their segmentation, for ``microstructure.json``.
    surface
        Whether to write ``surface.vtp``.

    Raises
    ------
    InputError
        If the folder is not empty, or the image cannot be snow.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.analysis.tomography.segmentation import known_grains
    >>> from snowshed.analysis.tomography.sphere_packing import sphere_snow
    >>> snow = sphere_snow((24, 24, 24), 1e-4, diameter=8e-4, density=200, seed=1)
    >>> with TemporaryDirectory() as folder:
    ...     numbers = write_grains(folder, known_grains(snow), {})
    >>> numbers.grains.grains == int(snow.labels.max())
    True
    """
    from snowshed.analysis.tomography.slices import slices_figure

    check_new(folder)
    image, path = segmentation.image, Path(folder)
    grains, contacts = grain_table(segmentation), contact_table(segmentation)
    numbers = SampleNumbers(measure_microstructure(image), grain_statistics(grains, contacts))
    _check_sizes(image, numbers)
    path.mkdir(parents=True, exist_ok=True)
    _write_array(path / SNOW, image.ice.view(np.uint8))
    _write_array(path / LABELS, segmentation.labels)
    write_csv(grains, path / "grains.csv", float_format="%.7g")
    write_csv(contacts, path / "contacts.csv", float_format="%.7g")
    settings = {} if segmentation.settings is None else asdict(segmentation.settings)
    settings.pop("threads", None)  # the grains do not depend on it
    _write_numbers(path, numbers, {**facts, **settings})
    _save(slices_figure(segmentation.labels, numbers.ice, numbers.grains), path)
    if surface:
        write_surface(path / "surface.vtp", segmentation.labels, image.voxel_size)
    return numbers


def _check_sizes(image: IceImage, numbers: SampleNumbers) -> None:
    try:
        _core.check_grain_diameter(numbers.grains.median_diameter_m if numbers.grains else 0.0)
    except InputError as error:
        raise InputError(f"{image.source}: {error}") from None


def _write_array(path: Path, array: AnyIntegers) -> None:
    with replacing(path) as beside, beside.open("wb") as file:
        np.save(file, array, allow_pickle=False)


def _write_numbers(path: Path, numbers: SampleNumbers, facts: Mapping[str, Fact]) -> None:
    values = {**asdict(numbers.ice), **(asdict(numbers.grains) if numbers.grains else {}), **facts}
    text = json.dumps({name: _rounded(value) for name, value in values.items()}, indent=2)
    write_text(path / NUMBERS, text + "\n")


def _rounded(value: object) -> object:
    """Return a value for JSON: numbers with nine digits, null for values that are not finite."""
    if not isinstance(value, float):
        return value
    return float(f"{value:.9g}") if math.isfinite(value) else None


def _save(figure: Figure, path: Path) -> None:
    from snowshed.plot.figure_style import save_figure

    save_figure(figure, path / "slices.png")
