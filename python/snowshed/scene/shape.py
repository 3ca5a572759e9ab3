"""Solids: primitives, meshes, sampled grids, OpenVDB files, and combinations of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import List, Literal, Optional

import numpy as np
from numpy.typing import ArrayLike

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.base.record import Record
from snowshed.io.array_files import array_file

Vector = Sequence[float]
#: Corners (x, y) of an area on the map, m.
Outline = Sequence[Sequence[float]]
ShapeType = Literal[
    "plane",
    "box",
    "sphere",
    "cylinder",
    "capsule",
    "plate",
    "mesh",
    "grid",
    "vdb",
    "union",
    "difference",
    "transform",
]


@checked
@dataclass
class Shape(Record):
    """A solid; use the constructors, which ask for what their type needs. Lengths in metres.

    In 2D (plane strain) vectors are (x, z), and every shape is unbounded across.

    Attributes
    ----------
    type : str
        Kind of solid; it decides which other keys are allowed.
    center : sequence of float
        A point on the plane (plane); Centre (box, sphere); Middle of the face (plate) [m].
    normal : sequence of float
        Outward normal (plane); Outward normal of the face; not along y (plate).
    size : sequence of float
        Edge lengths (box) [m].
    radius : float
        Radius (sphere, cylinder, capsule) [m].
    from_ : sequence of float
        One end of the axis (cylinder); One end of the segment (capsule) [m].
    to : sequence of float
        The other end (cylinder, capsule) [m].
    length : float
        Length, down the slope (plate) [m].
    width : float
        Width, across; ignored in 2D (required in 3D) (plate) [m].
    thickness : float
        Thickness, below the face (plate) [m].
    file : str or path
        STL, OBJ or PLY file; relative to the scene file (mesh); NPY file; relative to the scene
        file (grid); VDB file; relative to the scene file (vdb).
    scale : float
        Length of one unit of the file (mesh, vdb) [m].
    origin : sequence of float
        Position of the first sample (grid) [m].
    spacing : float
        Distance between samples (grid) [m].
    grid_ : str
        Name of the grid; empty: the only one of floats (vdb).
    threshold : float
        Threshold of a fog volume: the solid is where its value is larger (vdb).
    shapes : list of Shape
        The parts (union); The body, then the shapes that are cut away (difference); The shape
        (transform).
    axis : sequence of float
        Rotation axis (3D only; +y in 2D) (transform).
    angle : float
        Rotation about the axis (transform) [degrees].
    translate : sequence of float
        Translation, after the rotation (transform) [m].

    Examples
    --------
    >>> roof = Shape.union(Shape.box((0, 0, 1), (2, 1, 0.1)), Shape.sphere((1, 0, 1), 0.2))
    >>> roof.to_data()["shapes"][1]
    {'type': 'sphere', 'center': [1, 0, 1], 'radius': 0.2}
    """

    type: Optional[ShapeType] = None
    center: Optional[Vector] = None
    normal: Optional[Vector] = None
    size: Optional[Vector] = None
    radius: Optional[float] = None
    from_: Optional[Vector] = None
    to: Optional[Vector] = None
    length: Optional[float] = None
    width: Optional[float] = None
    thickness: Optional[float] = None
    file: Optional[PathLike] = None
    scale: Optional[float] = None
    origin: Optional[Vector] = None
    spacing: Optional[float] = None
    grid_: Optional[str] = None
    threshold: Optional[float] = None
    shapes: Optional[List[Shape]] = None
    axis: Optional[Vector] = None
    angle: Optional[float] = None
    translate: Optional[Vector] = None

    @classmethod
    def plane(cls, center: Vector, normal: Vector) -> Shape:
        """Return the half-space behind the plane through `center` with outward `normal`."""
        return cls(type="plane", center=center, normal=normal)

    @classmethod
    def box(cls, center: Vector, size: Vector) -> Shape:
        """Return a box with edges of lengths `size` along the axes."""
        return cls(type="box", center=center, size=size)

    @classmethod
    def sphere(cls, center: Vector, radius: float) -> Shape:
        """Return a ball; a disc in 2D."""
        return cls(type="sphere", center=center, radius=radius)

    @classmethod
    def cylinder(cls, start: Vector, end: Vector, radius: float) -> Shape:
        """Return a cylinder with flat ends, its axis from `start` to `end`."""
        return cls(type="cylinder", from_=start, to=end, radius=radius)

    @classmethod
    def capsule(cls, start: Vector, end: Vector, radius: float) -> Shape:
        """Return a cylinder with round caps, its axis from `start` to `end`."""
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
        """Return a plate centred on its face; `length` is along the slope, `width` across."""
        plate = cls(type="plate", center=center, normal=normal, length=length)
        plate.width, plate.thickness = width, thickness
        return plate

    @classmethod
    def mesh(cls, file: PathLike, *, scale: Optional[float] = None) -> Shape:
        """Return a closed mesh from an STL, OBJ or PLY file; `scale` is metres per file unit."""
        return cls(type="mesh", file=file, scale=scale)

    @classmethod
    def grid(cls, file: PathLike, *, origin: Vector, spacing: float) -> Shape:
        """Return a solid from signed distances on a regular grid (.npy), the first at `origin`."""
        return cls(type="grid", file=file, origin=origin, spacing=spacing)

    @classmethod
    def from_distances(cls, distances: ArrayLike, *, origin: Vector, spacing: float) -> Shape:
        """Return a solid from an array of signed distances, m, the first at `origin`.

        Parameters
        ----------
        distances : (nx, ny, nz), or (nx, nz) in 2D
            Distances, negative inside.
        origin
            Position of the first distance, m.
        spacing
            Distance between samples, m.

        Raises
        ------
        InputError
            If the array has another form, or a value is not finite.

        Examples
        --------
        >>> x, z = np.meshgrid(np.arange(-3.0, 4.0), np.arange(-3.0, 4.0), indexing="ij")
        >>> disc = Shape.from_distances(np.hypot(x, z) - 2.0, origin=(-3, -3), spacing=1.0)
        >>> disc.type
        'grid'
        """
        values = np.asarray(distances, dtype=np.float32)
        if values.ndim == 2:  # the plane of a scene in 2D
            values = values[:, np.newaxis, :]
        if values.ndim != 3 or not np.isfinite(values).all():
            raise InputError("distances: needed is an array (nx, ny, nz) of finite numbers")
        return cls.grid(array_file(values), origin=origin, spacing=spacing)

    @classmethod
    def vdb(
        cls,
        file: PathLike,
        *,
        grid: Optional[str] = None,
        scale: Optional[float] = None,
        threshold: Optional[float] = None,
    ) -> Shape:
        """Return a level set, or the region above `threshold`, from an OpenVDB file."""
        return cls(type="vdb", file=file, grid_=grid, scale=scale, threshold=threshold)

    @classmethod
    def union(cls, *shapes: Shape) -> Shape:
        """Return everything inside any of `shapes`."""
        return cls(type="union", shapes=list(shapes))

    @classmethod
    def difference(cls, shape: Shape, *removed: Shape) -> Shape:
        """Return the region inside `shape` and outside all of `removed`."""
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
        """Return `shape` turned by `angle` degrees about `axis` through the origin, then moved."""
        return cls(type="transform", shapes=[shape], axis=axis, angle=angle, translate=translate)
