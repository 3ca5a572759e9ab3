"""Panels and roofs of any form, from a mesh."""

from __future__ import annotations

import os
from pathlib import Path

from snowshed.base.paths import PathLike
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.scene.builders.slope import check_positive
from snowshed.scene.components import Body, Ground, Obstacle
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape


def mesh_structure(
    file: PathLike,
    *,
    snow: float,
    scale: float = 1.0,
    dimension: int = 3,
    friction: float = 0.3,
    ground_tilt: float = 0.0,
    layers: int = 8,
    dx: float = 0.02,
) -> Scene:
    """Return a structure from a mesh, with snow of an even depth on all that faces upward.

    The scene has no panel: what stays on the structure counts as part of the stack.

    Parameters
    ----------
    file
        A closed STL, OBJ or PLY mesh, z up; in 2D its section at y = 0 counts.
    snow
        Depth of the snow, m, measured vertically.
    scale
        Length of a unit of the file, m.
    dimension
        2 or 3.
    friction
        Coulomb coefficient of the structure.
    ground_tilt
        Degrees.
    layers
        The snow is what the mesh sweeps when it is lifted by `snow`, in so many steps; each must be
        smaller than the mesh is thick.
    dx
        Grid cell, m.

    Raises
    ------
    InputError
        If a number is not allowed. The mesh itself is read when the scene is run.

    Examples
    --------
    >>> mesh_structure("roof.stl", snow=0.2).bodies[0].shape.type
    'difference'
    """
    check_positive(snow=snow, scale=scale, dx=dx, layers=layers)
    path = os.fspath(Path(file).absolute())
    solid = Shape.mesh(path, scale=scale)
    raised = [_raised(solid, snow * (step + 1) / layers, dimension) for step in range(layers)]
    return Scene(
        dimension=dimension,
        ground=Ground(tilt=ground_tilt),
        obstacles=[
            Obstacle(name="structure", shape=solid, condition="separate", friction=friction)
        ],
        bodies=[Body(shape=Shape.difference(Shape.union(*raised), solid), event=0)],
        numerics=MpmSettings(dx=dx),
    )


def _raised(solid: Shape, height: float, dimension: int) -> Shape:
    upward = (0.0, height) if dimension == 2 else (0.0, 0.0, height)
    return Shape.transform(solid, translate=upward)
