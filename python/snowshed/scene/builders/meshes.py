"""Panels and roofs of any form, from a mesh."""

from __future__ import annotations

import os
from pathlib import Path

from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.scene.builders.slope import check_positive
from snowshed.scene.components import Body, Ground, Obstacle
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape


@checked
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
    """Return a structure from a mesh, with snow of even depth on all upward faces.

    The scene has no panel. Snow that stays on the structure is no part of the stack.

    Parameters
    ----------
    file
        A closed STL, OBJ or PLY mesh, z up.
    snow
        Vertical depth of the snow, m.
    scale
        Length of a unit of the file, m.
    dimension
        2 or 3; in 2D, the scene is the section of the mesh at y = 0.
    friction
        Coulomb coefficient of the structure.
    ground_tilt
        Tilt of the ground, degrees; positive falls in the slide direction.
    layers
        Number of steps in which the mesh is raised by `snow` to sweep the volume of the snow; a
        step must be smaller than the mesh is thick.
    dx
        Size of grid cells, m; parts must be at least two cells thick.

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
