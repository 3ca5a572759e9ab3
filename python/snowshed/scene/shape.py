"""Solids: primitives, meshes, sampled grids, OpenVDB files, and what can be composed of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import List, Optional

from snowshed.io.record import Record

Vector = Sequence[float]


@dataclass
class Shape(Record):
    """A solid; use the constructors, which ask for what their type needs. Lengths in metres.

    In 2D (plane strain) vectors are (x, z), and every shape is unbounded across.

    Examples
    --------
    >>> roof = Shape.union(Shape.box((0, 0, 1), (2, 1, 0.1)), Shape.sphere((1, 0, 1), 0.2))
    >>> roof.to_data()["shapes"][1]
    {'type': 'sphere', 'center': [1, 0, 1], 'radius': 0.2}
    """

    type: Optional[str] = None
    center: Optional[Vector] = None
    size: Optional[Vector] = None
    normal: Optional[Vector] = None
    from_: Optional[Vector] = None
    to: Optional[Vector] = None
    radius: Optional[float] = None
    length: Optional[float] = None
    width: Optional[float] = None
    thickness: Optional[float] = None
    file: Optional[str] = None
    scale: Optional[float] = None
    origin: Optional[Vector] = None
    spacing: Optional[float] = None
    grid_: Optional[str] = None
    threshold: Optional[float] = None
    translate: Optional[Vector] = None
    axis: Optional[Vector] = None
    angle: Optional[float] = None
    shapes: Optional[List[Shape]] = None

    @classmethod
    def plane(cls, center: Vector, normal: Vector) -> Shape:
        """Half-space behind the plane through `center` with outward `normal`."""
        return cls(type="plane", center=center, normal=normal)

    @classmethod
    def box(cls, center: Vector, size: Vector) -> Shape:
        """Box with edges of lengths `size` along the axes."""
        return cls(type="box", center=center, size=size)

    @classmethod
    def sphere(cls, center: Vector, radius: float) -> Shape:
        """Ball; a disc in 2D."""
        return cls(type="sphere", center=center, radius=radius)

    @classmethod
    def cylinder(cls, start: Vector, end: Vector, radius: float) -> Shape:
        """Cylinder with flat ends, its axis from `start` to `end`."""
        return cls(type="cylinder", from_=start, to=end, radius=radius)

    @classmethod
    def capsule(cls, start: Vector, end: Vector, radius: float) -> Shape:
        """Cylinder with round caps, its axis from `start` to `end`."""
        return cls(type="capsule", from_=start, to=end, radius=radius)

    @classmethod
    def plate(
        cls,
        center: Vector,
        normal: Vector,
        length: float,
        *,
        width: Optional[float] = None,
        thickness: Optional[float] = None,
    ) -> Shape:
        """Plate whose face is centred on `center`; `length` along the slope, `width` across."""
        plate = cls(type="plate", center=center, normal=normal, length=length)
        plate.width, plate.thickness = width, thickness
        return plate

    @classmethod
    def mesh(cls, file: str, *, scale: Optional[float] = None) -> Shape:
        """Return a closed mesh from an STL, OBJ or PLY file; `scale` is metres per file unit."""
        return cls(type="mesh", file=file, scale=scale)

    @classmethod
    def grid(cls, file: str, *, origin: Vector, spacing: float) -> Shape:
        """Signed distances sampled on a regular grid (.npy), its first sample at `origin`."""
        return cls(type="grid", file=file, origin=origin, spacing=spacing)

    @classmethod
    def vdb(
        cls,
        file: str,
        *,
        grid: Optional[str] = None,
        scale: Optional[float] = None,
        threshold: Optional[float] = None,
    ) -> Shape:
        """Return a level set, or what is denser than `threshold`, from an OpenVDB file."""
        return cls(type="vdb", file=file, grid_=grid, scale=scale, threshold=threshold)

    @classmethod
    def union(cls, *shapes: Shape) -> Shape:
        """Everything inside any of `shapes`."""
        return cls(type="union", shapes=list(shapes))

    @classmethod
    def difference(cls, shape: Shape, *removed: Shape) -> Shape:
        """Return what is inside `shape` and outside all of `removed`."""
        return cls(type="difference", shapes=[shape, *removed])

    @classmethod
    def transform(
        cls,
        shape: Shape,
        *,
        axis: Optional[Vector] = None,
        angle: Optional[float] = None,
        translate: Optional[Vector] = None,
    ) -> Shape:
        """`shape` turned by `angle` degrees about `axis` through the origin, then moved."""
        return cls(type="transform", shapes=[shape], axis=axis, angle=angle, translate=translate)
