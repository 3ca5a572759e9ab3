"""Samples of segmented snow for studies: coarser spheres, parts of a sample, other directions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Optional

import numpy as np

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.analysis.tomography.downscaling import downscaled
from snowshed.analysis.tomography.ice_image import IceImage
from snowshed.base.arguments import checked
from snowshed.base.arrays import AnyIntegers, Labels, positive
from snowshed.base.callers import argument
from snowshed.base.notes import InputNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.io.atomic import replacing
from snowshed.io.voxels.array_files import open_npy
from snowshed.methods.grains.sample_folder import LABELS, find_sample

#: Least number of voxels of a sample along an edge.
MIN_VOXELS = 6
MAX_LABEL = 2**31 - 1


@checked
@dataclass(frozen=True)
class LabelledSample:
    """Labels of grains with the size of their voxels, as a loading test takes them.

    Attributes
    ----------
    name
        Name of the sample and its file.
    labels : (nz, ny, nx)
        0 air, else a grain.
    voxel_size
        Edge of a voxel, m: the diameter of the spheres.
    source
        Origin of a synthetic sample, if known.
    """

    name: str
    labels: AnyIntegers
    voxel_size: float
    source: str = ""

    @classmethod
    def read(
        cls, path: PathLike, voxel_size: Optional[float] = None, *, split_labels: bool = False
    ) -> LabelledSample:
        """Read the labels of a sample.

        Parameters
        ----------
        path
            A folder of ``snowshed grains segment`` or ``synthetic``, which names the sample, or an
            NPY file.
        voxel_size
            Edge of a voxel, m; None: as the folder says.
        split_labels
            Whether each connected piece of a label is a grain.

        Raises
        ------
        InputError
            If the file is not a label image, the voxel size is unknown, or the grains are
            implausibly large or small.
        OSError
            If the file cannot be read.
        """
        sample = find_sample(path, LABELS)
        size = sample.voxel_size if voxel_size is None else voxel_size
        if size is None:
            raise InputError(
                f"{sample.file}: the edge of a voxel is not known; give it in m "
                f"({argument('voxel_size', option='voxel')})"
            )
        positive("voxel size", size)
        opened = open_npy(sample.file)
        if opened.dtype.kind not in "iu":
            raise InputError(f"{sample.file}: not a label image, which holds integers (nz, ny, nx)")
        labels = opened.layers(0, opened.shape[0])
        labels = _checked_labels(sample.file, labels, split_labels)
        _check_voxel_size(sample.file, labels, size)
        named = sample.file.resolve().parent if sample.file.name == LABELS else sample.file
        return cls(named.stem, labels, size, sample.source)

    @property
    def ice_fraction(self) -> float:
        """Voxels of ice over all voxels."""
        return float(np.count_nonzero(self.labels) / self.labels.size)

    @property
    def grains(self) -> int:
        """Number of grains."""
        return int(np.count_nonzero(np.unique(self.labels)))

    def coarser(self, factor: int) -> LabelledSample:
        """Return the sample with voxels `factor` times as large, and the same ice fraction.

        `downscaled` decides which voxels are ice; a voxel belongs to the grain with the most ice in
        it.

        Examples
        --------
        >>> labels = np.zeros((12, 12, 12), dtype=np.int32)
        >>> labels[:6], labels[6:, :7] = 1, 2
        >>> sample = LabelledSample("two", labels, 5e-5)
        >>> coarse = sample.coarser(2)
        >>> coarse.labels.shape, coarse.voxel_size
        ((6, 6, 6), 0.0001)
        >>> abs(coarse.ice_fraction - sample.ice_fraction) < 1e-3
        True
        """
        if factor == 1:
            return self
        counts = [length // factor for length in self.labels.shape]
        if factor < 1 or min(counts) < MIN_VOXELS:
            raise InputError(
                f"{self.name}: {self.labels.shape} voxels cannot be made {factor} times coarser; "
                f"at least {MIN_VOXELS} must remain along each edge"
            )
        image = downscaled(IceImage(self.labels > 0, self.voxel_size, self.name), factor)
        nz, ny, nx = counts
        divisible = self.labels[: nz * factor, : ny * factor, : nx * factor]
        blocks = divisible.reshape(nz, factor, ny, factor, nx, factor).transpose(0, 2, 4, 1, 3, 5)
        labels = np.zeros(image.ice.shape, dtype=self.labels.dtype)
        labels[image.ice] = _modal_label(blocks[image.ice].reshape(-1, factor**3))
        name = f"{self.name}-coarser{factor}"
        return LabelledSample(name, labels, image.voxel_size, self.source)

    def middle(self, part: float) -> LabelledSample:
        """Return the middle of the sample, whose edges are a share of the sample's.

        Examples
        --------
        >>> LabelledSample("one", np.ones((20, 20, 20), dtype=int), 1e-4).middle(0.5).labels.shape
        (10, 10, 10)
        """
        if not 0 < part <= 1:
            raise InputError(f"part {part:g}: above 0 and up to 1 are allowed")
        lengths = [round(part * length) for length in self.labels.shape]
        if min(lengths) < MIN_VOXELS:
            raise InputError(
                f"{self.name}: {part:g} of {self.labels.shape} voxels are fewer than "
                f"{MIN_VOXELS} along an edge"
            )
        cut = tuple(
            slice((size - length) // 2, (size - length) // 2 + length)
            for size, length in zip(self.labels.shape, lengths)
        )
        return replace(self, name=f"{self.name}-middle{part:g}", labels=self.labels[cut])

    def turned(self, axis: int) -> LabelledSample:
        """Return the sample turned so that it is loaded along another axis of its array.

        Examples
        --------
        >>> LabelledSample("one", np.ones((6, 7, 8), dtype=int), 1e-4).turned(2).labels.shape
        (8, 6, 7)
        """
        if axis == 0:
            return self
        turned = np.ascontiguousarray(np.moveaxis(self.labels, axis, 0))
        return replace(self, name=f"{self.name}-along-{'zyx'[axis]}", labels=turned)

    def write(self, folder: Path) -> Path:
        """Write the labels into a folder, and return their file.

        Raises
        ------
        InputError
            If another sample is there under this name.
        """
        folder.mkdir(parents=True, exist_ok=True)
        file = folder / f"{self.name}.npy"
        if not file.is_file():
            with replacing(file) as beside:
                np.save(beside, self.labels)
        elif not np.array_equal(np.load(file, mmap_mode="r"), self.labels):
            raise InputError(f"{file}: holds another sample; take a new folder")
        return file.resolve()


def _checked_labels(file: Path, labels: AnyIntegers, split: bool) -> Labels:
    """Return labels as the core takes them; a note reports labels in several pieces."""
    if int(labels.min()) < 0 or int(labels.max()) > MAX_LABEL:
        raise InputError(
            f"{file}: not a label image, in which 0 is air and grains are 1 to {MAX_LABEL:,}"
        )
    labelled = labels.astype(np.int32)
    try:
        note = _core.label_note(labelled, split)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None
    if note:
        issue_note(f"{file}: {note}", InputNote)
    return _core.split_labels(labelled) if split else labelled


def _check_voxel_size(file: Path, labels: AnyIntegers, voxel_size: float) -> None:
    """Raise InputError unless the grains have plausible sizes for snow."""
    voxels = np.unique(labels[labels > 0], return_counts=True)[1]
    if not len(voxels):
        raise InputError(f"{file}: no grain in the image: every voxel is 0, which is air")
    volume = float(np.median(voxels)) * voxel_size**3
    try:
        _core.check_grain_diameter(float(np.cbrt(6 / np.pi * volume)))
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def _modal_label(blocks: AnyIntegers) -> AnyIntegers:
    """Return the label other than 0 that each row has most often; the smaller of equals."""
    rows = np.sort(blocks, axis=1)
    best = np.zeros(len(rows), dtype=rows.dtype)
    length = np.zeros(len(rows), dtype=np.int64)
    run = np.zeros(len(rows), dtype=np.int64)
    for column in range(rows.shape[1]):
        same = rows[:, column] == rows[:, max(column - 1, 0)]
        run = np.where(same & (column > 0), run + 1, 1)
        longer = (run > length) & (rows[:, column] != 0)
        best[longer], length[longer] = rows[longer, column], run[longer]
    return best
