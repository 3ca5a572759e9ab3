"""A straight slope in the plane (x, z), with boards and layers of snow on it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Optional

from snowshed._core import InputError
from snowshed.scene.shape import Shape

Point = tuple[float, float]

BOARD_CELLS = 3  # smallest thickness of a board, as for the core's panel


@dataclass(frozen=True)
class Slope:
    """A slope that falls toward +x, or toward -x.

    Attributes
    ----------
    foot
        Its lower end (x, z), m.
    tilt
        Degrees from the horizontal.
    width
        Across, m; None in 2D.
    toward
        1: it falls toward +x; -1: toward -x.

    Examples
    --------
    >>> slope = Slope((1.0, 0.0), 45.0)
    >>> x, z = slope.point(2.0**0.5)
    >>> abs(round(x, 6)), round(z, 6)
    (0.0, 1.0)
    """

    foot: Point
    tilt: float
    width: Optional[float] = None
    toward: int = 1

    def point(self, up: float, above: float = 0.0) -> Point:
        """Return the point `up` the slope from its foot and `above` it, along its normal, m."""
        cos, sin = math.cos(math.radians(self.tilt)), math.sin(math.radians(self.tilt))
        x, z = self.foot
        return (
            x + self.toward * (above * sin - up * cos),
            z + up * sin + above * cos,
        )

    @property
    def normal(self) -> Point:
        """Outward normal."""
        tilt = math.radians(self.tilt)
        return self.toward * math.sin(tilt), math.cos(tilt)

    def board(self, start: float, end: float, thickness: float) -> Shape:
        """Return a board whose face lies on the slope, from `start` to `end` above its foot, m."""
        return Shape.plate(
            self._vector(self.point(0.5 * (start + end))),
            self._vector(self.normal),
            end - start,
            width=self.width,
            thickness=thickness,
        )

    def layer(self, start: float, end: float, low: float, high: float) -> Shape:
        """Return a layer from `start` to `end` up the slope, and from `low` to `high` above it."""
        size = (end - start, high - low)
        middle = self._vector(self.point(0.5 * (start + end), 0.5 * (low + high)))
        angle = self.toward * self.tilt
        if self.width is None:
            return Shape.transform(Shape.box((0.0, 0.0), size), angle=angle, translate=middle)
        box = Shape.box((0.0, 0.0, 0.0), (size[0], self.width, size[1]))
        return Shape.transform(box, axis=(0.0, 1.0, 0.0), angle=angle, translate=middle)

    def narrowed(self, width: Optional[float]) -> Slope:
        """Return the same slope with another width, in 3D."""
        return Slope(self.foot, self.tilt, width if self.width is not None else None, self.toward)

    def _vector(self, point: Point) -> tuple[float, ...]:
        return point if self.width is None else (point[0], 0.0, point[1])


def upright_box(x: Point, z: Point, dimension: int, y: Point = (-0.5, 0.5)) -> Shape:
    """Return a box between two values of each coordinate, m; y is left out in 2D."""
    spans = (x, z) if dimension == 2 else (x, y, z)
    center = [0.5 * (low + high) for low, high in spans]
    return Shape.box(center, [high - low for low, high in spans])


def check_resolved(name: str, size: float, dx: float, cells: int = 2) -> None:
    """Raise InputError if a part is too small for the grid.

    Obstacles thinner than two cells are thickened to two cells, and narrower gaps are closed.
    """
    if size < cells * dx * (1.0 - 1e-9):
        raise InputError(
            f"{name}: {size:g} m is less than {cells} grid cells of {dx:g} m; reduce dx to "
            f"{size / cells:.3g} m or less"
        )


def check_positive(**values: float) -> None:
    """Raise InputError naming the first of some lengths, m, that is not above zero."""
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name}: {value:g} is not allowed; give a length above 0 m")
