"""A folder of grains from a file with an image of snow."""

from __future__ import annotations

import os
from math import prod
from typing import Optional

from snowshed._core import InputError
from snowshed.analysis.tomography.ice_image import IceImage
from snowshed.analysis.tomography.microstructure import measure_microstructure
from snowshed.analysis.tomography.sample import Fact, SampleNumbers, check_new, write_grains
from snowshed.analysis.tomography.segmentation import SegmentationSettings, segment
from snowshed.analysis.tomography.threshold import (
    ImageSettings,
    ReadImage,
    cropped_shape,
    read_ice,
)
from snowshed.base.arguments import checked
from snowshed.base.formatting import duration, number
from snowshed.base.notes import InputNote, issue_note, record_notes
from snowshed.base.paths import PathLike
from snowshed.base.progress import Progress, Reporter
from snowshed.io.voxels.voxel_file import VoxelFile

MAX_ANISOTROPY = 3.0  # ratio of correlation lengths; that of depth hoar is about 2
BYTES_READ = 2  # memory per voxel of the file
BYTES_SEGMENTED = 45  # memory per voxel of the segmentation
#: Time on one core of a desktop computer, s per voxel.
SECONDS_PER_VOXEL = 1e-6
READ_SHARE = 0.1  # share of the work that is finished after reading
FOUND_SHARE = 0.85  # share of the work that is finished after the segmentation


def segmentation_plan(file: VoxelFile, settings: ImageSettings) -> tuple[int, float]:
    """Return how many bytes and about how many seconds it takes to find the grains of an image.

    Raises
    ------
    InputError
        If the image has more voxels than fit into this machine's memory.
    """
    voxels = prod(cropped_shape(file, settings.crop))
    coarse = voxels // max(settings.downscale, 1) ** 3
    needed = BYTES_READ * voxels + BYTES_SEGMENTED * coarse
    available = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    if needed > available:
        raise InputError(
            f"{file.name}: {voxels:,} voxels take some {number(needed / 1e9, 2)} GB; this machine "
            f"has {number(available / 1e9, 2)} GB: crop or downscale the image"
        )
    return needed, SECONDS_PER_VOXEL * coarse


@checked
def segment_image(
    file: VoxelFile,
    folder: PathLike,
    image_settings: Optional[ImageSettings] = None,
    settings: Optional[SegmentationSettings] = None,
    *,
    surface: bool = False,
    progress: Optional[Reporter] = None,
) -> tuple[SampleNumbers, ReadImage]:
    """Find the grains in an image of snow, and write them into a folder.

    Parameters
    ----------
    file
        The image.
    folder
        New or empty.
    image_settings
        Settings that separate ice from air in the image.
    settings
        Settings of the segmentation.
    surface
        Whether to write the surface for ParaView.
    progress
        Called during the work.

    Raises
    ------
    InputError
        If the image is damaged, empty, wrongly scaled or one grain, or does not fit into memory.
    """
    check_new(folder)
    wanted = image_settings or ImageSettings()
    _, seconds = segmentation_plan(file, wanted)

    def report(part: float, doing: str) -> None:
        if progress is not None:
            progress(Progress(part, int(part), 1, "images", doing, expected_s=seconds))

    report(0.0, "reading")
    with record_notes() as notes:
        read = read_ice(file, wanted)
        _note_on_axes(read.image)  # what cannot be snow is refused before the long part
    segmentation = segment(
        read.image,
        settings,
        lambda part, doing: report(READ_SHARE + (FOUND_SHARE - READ_SHARE) * part, doing),
    )
    report(FOUND_SHARE, "writing")
    facts: dict[str, Fact] = {
        "threshold": read.threshold,
        "threshold_from": read.chosen,
        "unconnected_ice": read.lost,
        "downscale": wanted.downscale,
        "notes": [*file.notes, *notes],
    }
    numbers = write_grains(folder, segmentation, facts, surface=surface)
    report(1.0, "")
    return numbers, read


def _note_on_axes(image: IceImage) -> None:
    """Note an anisotropy that no snow has, as of an image whose axes are in another order."""
    ice = measure_microstructure(image)
    lengths = (ice.correlation_length_x_m, ice.correlation_length_y_m, ice.correlation_length_z_m)
    ratio = max(lengths) / min(lengths)
    if ratio > MAX_ANISOTROPY:
        issue_note(
            f"{image.source}: its correlation lengths differ by a factor of {ratio:.1f} along x, "
            "y and z, which is unusual for snow; is the order of its axes, or its number type, "
            "another?",
            InputNote,
        )


def plan_text(file: VoxelFile, settings: ImageSettings) -> str:
    """Return the announcement of a segmentation: its time and memory."""
    needed, seconds = segmentation_plan(file, settings)
    nz, ny, nx = cropped_shape(file, settings.crop)
    return (
        f"{nx} x {ny} x {nz} voxels: up to {number(needed / 1e9, 2)} GB of memory, about "
        f"{duration(seconds)}"
    )
