"""Terrain as ground: elevations of a raster, converted to a grid of signed distances.

The elevations become a closed body of triangles. The core computes its exact distances on a regular
grid. The cost of this shape per step does not depend on the roughness of the terrain.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Optional, Union

import numpy as np

from snowshed._core import InputError, Simulation
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats, Integers
from snowshed.base.paths import PathLike
from snowshed.io.atomic import replacing
from snowshed.io.raster.raster import Raster
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.scene.builders.slope import check_positive
from snowshed.scene.builders.terrain_checks import MAX_SLOPE, check_terrain, read_terrain
from snowshed.scene.components import Body, Condition, Obstacle
from snowshed.scene.panel_edge import panel_edge
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape

CELLS_BELOW = 6  # cells of the grid below the lowest ground
CELLS_ABOVE = 3  # cells of the grid above the highest ground
MAX_SAMPLES = 20_000_000

Span = tuple[float, float]


@checked
def on_terrain(
    scene: Scene,
    raster: Union[Raster, PathLike],
    file: PathLike,
    *,
    origin: Span,
    azimuth: float,
    x: Span,
    y: Span = (0.0, 0.0),
    spacing: float = 0.1,
    condition: Condition = "sticky",
    friction: float = 0.3,
    band: Optional[int] = None,
    max_slope: float = MAX_SLOPE,
) -> Scene:
    """Return a scene whose ground is terrain.

    An obstacle "terrain" replaces the plane ground. Elevations are shifted: the terrain below the
    lower edge of the panel (or at x = 0, without a panel) is at z = 0, so that the panel's height
    is measured from the terrain there. The stack's height is measured from the terrain below it.

    Parameters
    ----------
    scene
        Any scene; it is not changed.
    raster
        Terrain, or its file, which `read_terrain` reads.
    file
        File to write the grid of distances to (.npy); the scene names it by its absolute path.
    origin
        East and north of the scene's x = y = 0 on the map, m.
    azimuth
        Slide direction (+x) on the map, degrees from north, clockwise.
    x
        Extent of the terrain along the slide direction, m; beyond it there is no ground.
    y
        Extent of the terrain across the slide direction, m; in 3D only.
    spacing
        Distance between samples of the terrain, m; start with two grid cells of the scene, or the
        spacing of a coarser raster.
    condition
        Contact condition of the terrain.
    friction
        Coulomb coefficient of the terrain.
    band
        Band of a GeoTIFF, from 1; needed if it has several.
    max_slope
        Steepest plausible cliff beside elevations of 0, degrees.

    Raises
    ------
    InputError
        If the raster is not in metres or does not cover the extent, or the grid is too large.

    Examples
    --------
    >>> from snowshed.scene.builders.panels import single_panel
    >>> hill = Raster(np.arange(12.0)[:, None] * np.ones(12), 0.0, 0.0, 1.0)
    >>> panel = single_panel(height=1.0, length=1.0, tilt=40.0, snow=0.1, dx=0.1)
    >>> with TemporaryDirectory() as folder:
    ...     scene = on_terrain(
    ...         panel, hill, Path(folder) / "hill.npy", origin=(5, 8), azimuth=180, x=(-1, 3)
    ...     )
    >>> scene.obstacles[0].shape.type, scene.ground
    ('grid', None)
    """
    check_positive(spacing=spacing)
    terrain = _checked_terrain(raster, band, max_slope)
    flat = scene.dimension == 2
    xs, ys = _axis("x", x, spacing), np.zeros(1) if flat else _axis("y", y, spacing)
    edge_x = panel_edge(scene.to_data()).x if scene.panel is not None else 0.0
    level = float(_heights(terrain, origin, azimuth, np.array([edge_x]), np.zeros(1))[0, 0])
    heights = _heights(terrain, origin, azimuth, xs, ys) - level
    samples, bottom = signed_distances(heights, xs, ys, spacing)
    with replacing(file) as beside, beside.open("wb") as stream:
        np.save(stream, samples.astype(np.float32))
    corner = (xs[0], bottom) if flat else (xs[0], ys[0], bottom)
    shape = Shape.grid(str(Path(file).absolute()), origin=corner, spacing=spacing)
    built = copy.deepcopy(scene)
    built.ground = None
    return built.append(
        "obstacles",
        Obstacle(name="terrain", shape=shape, condition=condition, friction=friction),
    )


def _checked_terrain(
    raster: Union[Raster, PathLike], band: Optional[int], max_slope: float
) -> Raster:
    if not isinstance(raster, Raster):
        return read_terrain(raster, band, max_slope)
    check_terrain(raster, max_slope)
    return raster


def signed_distances(
    heights: Floats, xs: Floats, ys: Floats, spacing: float
) -> tuple[Floats, float]:
    """Return distances from terrain, negative inside, and the z of the lowest samples, m.

    Parameters
    ----------
    heights : (nx, ny)
        Elevations of the terrain at `xs` and `ys`, m; with a single y, it is constant along y.
    xs, ys
        Coordinates of the samples, `spacing` apart, m.
    spacing
        Distance between samples, also along z, m.

    Returns
    -------
    (nx, ny, nz), float
        Distances for a shape of the type "grid", and the z of the lowest samples, m.
    """
    bottom = float(heights.min()) - CELLS_BELOW * spacing
    count = math.ceil((float(heights.max()) - bottom) / spacing) + CELLS_ABOVE + 1
    if len(xs) * len(ys) * count > MAX_SAMPLES:
        raise InputError(
            f"spacing: {spacing:g} m makes a grid of {len(xs)} x {len(ys)} x {count} samples; at "
            f"most {MAX_SAMPLES} are allowed in all"
        )
    zs = bottom + spacing * np.arange(count)
    points = np.stack(np.meshgrid(xs, ys, zs, indexing="ij"), axis=-1).reshape(-1, 3)
    reach = spacing * (count + CELLS_BELOW)  # sides beyond the depth of the bottom
    distances = _distances(_solid(heights, xs, ys, bottom - reach, reach), points, spacing)
    return distances.reshape(len(xs), len(ys), count), bottom


def _axis(name: str, span: Sequence[float], spacing: float) -> Floats:
    low, high = span
    if not (math.isfinite(low) and math.isfinite(high) and high - low >= 2 * spacing):
        raise InputError(
            f"{name}: {low:g} to {high:g} m is not allowed; give at least two spacings of "
            f"{spacing:g} m"
        )
    steps: Floats = np.arange(round((high - low) / spacing) + 1, dtype=np.float64)
    return low + spacing * steps


def _heights(terrain: Raster, origin: Span, azimuth: float, xs: Floats, ys: Floats) -> Floats:
    """Return the raster's heights (nx, ny) at positions of the scene."""
    sin, cos = math.sin(math.radians(azimuth)), math.cos(math.radians(azimuth))
    x, y = np.meshgrid(xs, ys, indexing="ij")
    return terrain.height_at(origin[0] + x * sin - y * cos, origin[1] + x * cos + y * sin)


Mesh = tuple[Floats, Integers]  # corners (n, 3) and triangles (m, 3)


def _solid(heights: Floats, xs: Floats, ys: Floats, bottom: float, reach: float) -> Mesh:
    """Return terrain as a closed body, continued level by `reach` beyond its edges."""
    top = np.pad(heights, 1 if len(ys) > 1 else ((1, 1), (0, 0)), mode="edge")
    x = np.concatenate([[xs[0] - reach], xs, [xs[-1] + reach]])
    y = np.concatenate([[ys[0] - reach], ys, [ys[-1] + reach]])
    if len(ys) == 1:
        top, y = np.repeat(top, 2, axis=1), np.array([-reach, reach]) * len(xs)
    rows, columns = top.shape
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    upper = np.concatenate([grid, top[..., None]], axis=-1).reshape(-1, 3)
    lower = upper * [1.0, 1.0, 0.0] + [0.0, 0.0, bottom]
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    face = np.concatenate([_triangles(a, b, c), _triangles(a, c, d)])
    below = face[:, ::-1] + rows * columns
    rim = np.concatenate([index[:, 0], index[-1, 1:], index[-2::-1, -1], index[0, -2::-1]])
    start, end = rim[:-1], rim[1:]
    under = rows * columns
    walls = np.concatenate(
        [_triangles(start, start + under, end), _triangles(end, start + under, end + under)]
    )
    return np.concatenate([upper, lower]), np.concatenate([face, below, walls])


def _triangles(a: Integers, b: Integers, c: Integers) -> Integers:
    return np.stack([a.ravel(), b.ravel(), c.ravel()], axis=1)


def _distances(mesh: Mesh, points: Floats, spacing: float) -> Floats:
    """Return the signed distances of points (n, 3) from a closed mesh, from the core."""
    corners, triangles = mesh
    above = (0.0, 0.0, float(corners[:, 2].max()) + 10.0 * spacing)
    with TemporaryDirectory() as folder:
        file = Path(folder) / "terrain.obj"
        with file.open("w", encoding="ascii") as out:
            np.savetxt(out, corners, fmt="v %.9g %.9g %.9g")
            np.savetxt(out, triangles + 1, fmt="f %d %d %d")
        scene = Scene(
            dimension=3,
            obstacles=[Obstacle(name="terrain", shape=Shape.mesh(str(file)))],
            bodies=[Body(shape=Shape.sphere(above, 2.0 * spacing))],  # a scene needs some snow
            numerics=MpmSettings(dx=spacing, threads=1),
        )
        resolved = scene.resolve()
        return Simulation(resolved.core, resolved.base_dir).obstacle_distance(points)
