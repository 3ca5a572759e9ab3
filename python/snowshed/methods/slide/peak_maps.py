"""Peak maps of a slide in few bytes, as a study of many slides keeps them."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.damage import DAMAGED
from snowshed.io.array_archive import open_archive

Singles = NDArray[np.float32]
PACKED = "peaks.npz"  # in the results folder of a compact run


@dataclass(frozen=True)
class PeakMaps:
    """The largest thickness, speed and pressure that a slide had at the nodes of its grid.

    Only the rectangle that holds all snow is kept.

    Attributes
    ----------
    thickness, speed, pressure : (rows, columns)
        m, m/s and kPa, in single precision, the southernmost row first.
    first_row, first_column
        Where the rectangle begins in the whole grid.
    shape
        Rows and columns of the whole grid.

    Examples
    --------
    >>> whole = np.zeros((4, 5)); whole[1, 2] = 0.5
    >>> maps = PeakMaps.cropped(whole, 2.0 * whole, 3.0 * whole)
    >>> PeakMaps.unpacked(maps.packed()).window("thickness", 0, 2).tolist()
    [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.5, 0.0, 0.0]]
    """

    thickness: Singles
    speed: Singles
    pressure: Singles
    first_row: int
    first_column: int
    shape: tuple[int, int]

    @classmethod
    def cropped(cls, thickness: Any, speed: Any, pressure: Any) -> PeakMaps:
        """Return the rectangle of whole maps (rows, columns) that holds all snow."""
        snow = (np.asarray(thickness) > 0.0) | (np.asarray(speed) > 0.0)
        rows, columns = (np.flatnonzero(snow.any(axis=axis)) for axis in (1, 0))
        if not rows.size:
            rows = columns = np.array([0])
        window = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        cut = (np.asarray(one)[window].astype(np.float32) for one in (thickness, speed, pressure))
        height, width = snow.shape
        h, v, p = cut
        return cls(h, v, p, int(rows[0]), int(columns[0]), (height, width))

    def window(self, name: str, begin: int, end: int) -> Singles:
        """Return the rows from `begin` to before `end` of a whole map, zero where no snow was."""
        found = np.zeros((end - begin, self.shape[1]), dtype=np.float32)
        kept: Singles = getattr(self, name)
        rows, columns = kept.shape
        top, bottom = max(begin, self.first_row), min(end, self.first_row + rows)
        if top < bottom:
            across = slice(self.first_column, self.first_column + columns)
            cut = kept[top - self.first_row : bottom - self.first_row]
            found[top - begin : bottom - begin, across] = cut
        return found

    def packed(self) -> bytes:
        """Return the maps as a compressed NumPy archive, which `unpacked` reads."""
        stream = io.BytesIO()
        np.savez_compressed(
            stream,
            thickness=self.thickness,
            speed=self.speed,
            pressure=self.pressure,
            place=np.array([self.first_row, self.first_column, *self.shape]),
        )
        return stream.getvalue()

    @classmethod
    def unpacked(cls, data: bytes) -> PeakMaps:
        """Return the maps that `packed` has packed.

        Raises
        ------
        InputError
            If it did not, or the bytes are damaged.
        """
        try:
            with open_archive(data) as archive:
                row, column, rows, columns = archive["place"].tolist()
                h, v, p = (archive[name] for name in ("thickness", "speed", "pressure"))
                return cls(h, v, p, row, column, (rows, columns))
        except (OSError, *DAMAGED) as error:
            raise InputError(f"not maps that snowshed kept: {error}") from None
