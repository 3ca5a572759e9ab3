"""A slide over time: the thickness of the snow at some times, for pictures that move."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.io.array_archive import open_archive
from snowshed.io.atomic import replacing
from snowshed.io.damage import DAMAGED
from snowshed.io.input_file import read_regular

Singles = NDArray[np.float32]
FIRST_INTERVAL = 0.25  # s between frames, to begin with
LARGEST = 64  # frames; of more, every second one goes


@dataclass(frozen=True)
class Frame:
    """The thickness of the snow at a time.

    Attributes
    ----------
    time
        s.
    thickness : (rows, columns)
        m, of the rectangle that holds all snow, the southernmost row first.
    first_row, first_column
        Where the rectangle begins in the whole grid.
    """

    time: float
    thickness: Singles
    first_row: int
    first_column: int

    def window(self, rows: slice, columns: slice) -> Singles:
        """Return a rectangle of the whole grid, zero where there is no snow."""
        found = np.zeros((rows.stop - rows.start, columns.stop - columns.start), dtype=np.float32)
        top, left = self.first_row - rows.start, self.first_column - columns.start
        height, width = self.thickness.shape
        r0, r1 = max(top, 0), min(top + height, found.shape[0])
        c0, c1 = max(left, 0), min(left + width, found.shape[1])
        if r0 < r1 and c0 < c1:
            found[r0:r1, c0:c1] = self.thickness[r0 - top : r1 - top, c0 - left : c1 - left]
        return found


class FrameSeries:
    """Frames at even intervals; the longer a slide lasts, the longer these are.

    Examples
    --------
    >>> series = FrameSeries()
    >>> snow = np.ones((2, 2))
    >>> for step in range(400):
    ...     if series.due(0.1 * step):
    ...         series.add(0.1 * step, snow)
    >>> len(series.frames) <= 64, series.interval
    (True, 1.0)
    """

    def __init__(self) -> None:
        self.frames: list[Frame] = []
        self.interval = FIRST_INTERVAL

    def due(self, time: float) -> bool:
        """Return whether the next frame's time has come."""
        return not self.frames or time >= self.frames[-1].time + self.interval - 1e-9

    def add(self, time: float, thickness: Any) -> None:
        """Add the snow at a time: a whole map (rows, columns), m."""
        whole = np.asarray(thickness)
        snow = whole > 0.0
        rows, columns = (np.flatnonzero(snow.any(axis=axis)) for axis in (1, 0))
        if not rows.size:
            rows = columns = np.array([0])
        cut = whole[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1].astype(np.float32)
        self.frames.append(Frame(time, cut, int(rows[0]), int(columns[0])))
        if len(self.frames) > LARGEST:
            self.frames = self.frames[::2]
            self.interval *= 2.0

    def save(self, file: Path) -> None:
        """Write the frames to a file, whole or not at all."""
        stream = io.BytesIO()
        arrays: dict[str, Any] = {f"frame{n}": one.thickness for n, one in enumerate(self.frames)}
        places = [[one.time, one.first_row, one.first_column] for one in self.frames]
        np.savez_compressed(stream, places=np.array(places).reshape(-1, 3), **arrays)
        with replacing(file) as beside:
            beside.write_bytes(stream.getvalue())

    @classmethod
    def load(cls, file: Path, until: float) -> FrameSeries:
        """Return the frames of a file before a time, s; none if there is no such file."""
        series = cls()
        try:
            with open_archive(read_regular(file)) as archive:
                for number, (time, row, column) in enumerate(archive["places"].tolist()):
                    if time < until:
                        cut = archive[f"frame{number}"]
                        series.frames.append(Frame(time, cut, int(row), int(column)))
        except (InputError, OSError, *DAMAGED):
            return cls()  # the page begins later; nothing else depends on it
        times = [frame.time for frame in series.frames]
        if len(times) > 1:
            steps = np.log2(np.median(np.diff(times)) / FIRST_INTERVAL)
            series.interval = FIRST_INTERVAL * 2.0 ** max(0.0, float(np.floor(steps + 0.5)))
        return series
