"""The solids of a scene as triangles, for views in space."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arrays import Floats, Integers
from snowshed.io.raster.raster import Raster
from snowshed.plot.surface_nets import section_of, surface_of
from snowshed.scene.resolved import ResolvedScene

ROUND_SIDES = 24  # number of sides of round shapes
SAMPLES = 48  # samples along the longest side of a solid
FLAT_SAMPLES = 400  # the same in 2D
TERRAIN_NODES = 220  # along a side, at most
#: Corners of the unit cube.
CORNERS = np.array([[i, j, k] for i in (0.0, 1.0) for j in (0.0, 1.0) for k in (0.0, 1.0)])
MAX_TRIANGLES = 200_000  # of a mesh; larger meshes are sampled


@dataclass(frozen=True)
class Box:
    """A box that holds something: its lowest and highest corner, m."""

    low: Floats
    high: Floats

    @property
    def size(self) -> Floats:
        """Edge lengths."""
        edges: Floats = self.high - self.low
        return edges

    @property
    def corners(self) -> Floats:
        """Its corners (8, 3)."""
        points: Floats = self.low + CORNERS * self.size
        return points

    def widened(self, margin: float) -> Box:
        """Return the box with a margin on all sides, m."""
        return Box(self.low - margin, self.high + margin)

    def joined(self, points: Floats) -> Box:
        """Return a box that holds points as well."""
        if not len(points):
            return self
        return Box(
            np.minimum(self.low, points.min(axis=0)), np.maximum(self.high, points.max(axis=0))
        )


@dataclass(frozen=True)
class Solid:
    """A solid that snow collides with.

    Attributes
    ----------
    name
        Name of the solid.
    kind
        Kind, which decides the colour: "ground", "panel" or "solid".
    corners : (n, 3)
        Corners before any motion, m.
    triangles : (m, 3)
        Corners of each triangle.
    motion
        Motion, as in a scene; None for a fixed solid.
    grid
        Distance of lines on its surface, m; 0: no lines.
    """

    name: str
    kind: str
    corners: Floats
    triangles: Integers
    motion: Optional[Mapping[str, Any]] = None
    grid: float = 0.0

    @property
    def data(self) -> dict[str, Any]:
        """The solid as JSON data for a page."""
        return {
            "name": self.name,
            "kind": self.kind,
            "corners": _base64(self.corners.astype("<f4")),
            "triangles": _base64(self.triangles.astype("<u4")),
            "motion": None if self.motion is None else _motion(self.motion),
            "grid": self.grid,
            "cut": self.kind != "ground",
        }


def scene_solids(
    scene: ResolvedScene, snow: Box, terrain: Optional[Raster]
) -> tuple[list[Solid], Box]:
    """Return the solids of a scene around its snow, and a box around all except the ground.

    Parameters
    ----------
    scene
        The simulated scene.
    snow
        A box that holds the snow at all times.
    terrain
        The ground of a slide; None for other methods.
    """
    data, frame = scene.data, scene.core.panel_frame()
    flat = data["dimension"] == 2
    solids = [
        *([] if frame is None else [_panel(frame)]),
        *_obstacles(data, Path(scene.base_dir), snow),
    ]
    focus = snow
    for solid in solids:
        if solid.kind == "panel" or np.all(np.ptp(solid.corners, axis=0) < 3 * snow.size.max()):
            focus = focus.joined(solid.corners)
    if data.get("ground"):
        solids.insert(0, _ground(data["ground"]["tilt"], focus, flat))
        focus = focus.joined(_below(focus, data["ground"]["tilt"]))
    if terrain is not None:
        solids.insert(0, _terrain(terrain, focus))
    return [_flattened(solid) for solid in solids] if flat else solids, focus


def _flattened(solid: Solid) -> Solid:
    """Return a solid flattened into the plane y = 0, for 2D scenes seen from the side."""
    corners = solid.corners.copy()
    corners[:, 1] = 0.0
    return replace(solid, corners=corners)


def _below(focus: Box, tilt: float) -> Floats:
    """Return the points of the ground below two edges of a box."""
    x = np.array([focus.low[0], focus.high[0]])
    middle = 0.5 * (focus.low[1] + focus.high[1])
    return np.column_stack([x, np.full(2, middle), -x * np.tan(np.radians(tilt))])


def _panel(frame: Mapping[str, Any]) -> Solid:
    """Return the board below the panel's face."""
    board = frame["board_thickness"] * np.asarray(frame["normal"])
    across = np.array([0.0, frame["width"], 0.0])
    edges = (frame["length"] * np.asarray(frame["slope"]), across, board)
    return _box("panel", "panel", np.asarray(frame["center"]) - 0.5 * board, edges)


def _ground(tilt: float, focus: Box, flat: bool) -> Solid:
    size = float(focus.size.max())
    grid = float(10.0 ** np.floor(np.log10(max(size, 1e-9))))
    low, high = (
        grid * np.round(edge / grid) for edge in (focus.low - 2 * size, focus.high + 2 * size)
    )
    x = np.array([low[0], high[0], high[0], low[0]])
    z = -x * np.tan(np.radians(tilt))
    if flat:
        z[2:] = z.min() - 2 * size  # seen from the side
        corners = np.column_stack([x, np.zeros(4), z])
    else:
        corners = np.column_stack([x, [low[1], low[1], high[1], high[1]], z])
    return Solid(
        "ground", "ground", corners, np.array([[0, 1, 2], [0, 2, 3]]), grid=0 if flat else grid
    )


def _terrain(raster: Raster, focus: Box) -> Solid:
    margin = 0.5 * float(focus.size[:2].max())
    rows, columns = raster.heights.shape
    c0, r0 = (int(np.floor((focus.low[k] - margin) / raster.cell)) for k in (0, 1))
    c1, r1 = (int(np.ceil((focus.high[k] + margin) / raster.cell)) for k in (0, 1))
    step = max(1, int(np.ceil(max(c1 - c0, r1 - r0) / TERRAIN_NODES)))
    column = np.arange(max(c0, 0), min(c1, columns - 1) + 1, step)
    row = np.arange(max(r0, 0), min(r1, rows - 1) + 1, step)
    z = raster.heights[np.ix_(row, column)]
    x, y = np.meshgrid(column * raster.cell, row * raster.cell)
    corners = np.column_stack([x.ravel(), y.ravel(), np.nan_to_num(z).ravel()])
    at = np.arange(z.size).reshape(z.shape)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1).reshape(-1, 4)
    quads = quads[np.isfinite(z.ravel()[quads]).all(axis=1)]
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    grid = float(10.0 ** np.round(np.log10(max(focus.size[:2].max(), 1e-9) / 4)))
    return Solid("terrain", "ground", corners, triangles, grid=grid)


def _obstacles(scene: Mapping[str, Any], base_dir: Path, snow: Box) -> Iterator[Solid]:
    near = snow.widened(0.5 * float(snow.size.max()) + 1e-6)
    for number, obstacle in enumerate(scene.get("obstacles", ())):
        name = obstacle.get("name") or f"obstacle {number + 1}"
        motion = obstacle.get("motion")
        for part in _parts(obstacle["shape"], scene, base_dir, near):
            yield replace(part, name=name, motion=motion)


def _parts(
    shape: Mapping[str, Any], scene: Mapping[str, Any], base_dir: Path, near: Box
) -> Iterator[Solid]:
    """Yield the triangles of a shape; complex shapes are sampled."""
    kind = shape["type"]
    vector = {
        k: _in_space(shape[k]) for k in ("center", "size", "normal", "from", "to") if k in shape
    }
    if kind == "box":
        size = vector["size"]
        if scene["dimension"] == 2:
            size[1] = 0.0
        yield _box(kind, "solid", vector["center"], np.diag(size))
    elif kind == "sphere":
        yield _capsule(vector["center"], vector["center"], shape["radius"])
    elif kind == "capsule":
        yield _capsule(vector["from"], vector["to"], shape["radius"])
    elif kind == "cylinder" and scene["dimension"] == 3:
        yield _cylinder(vector["from"], vector["to"], shape["radius"])
    elif kind == "plate":
        yield _plate(vector["center"], vector["normal"], shape)
    elif kind == "union":
        for part in shape["shapes"]:
            yield from _parts(part, scene, base_dir, near)
    elif kind == "transform":
        turn, shift = _turn(shape, scene["dimension"])
        around = near.corners - shift
        own = around @ turn  # the inverse of a rotation is its transpose
        region = Box(own.min(axis=0), own.max(axis=0))
        for part in _parts(shape["shapes"][0], scene, base_dir, region):
            yield replace(part, corners=part.corners @ turn.T + shift)
    elif kind == "mesh" and (surface := _mesh(shape, base_dir)) is not None:
        yield surface
    else:
        surface = _sampled_surface(shape, scene, base_dir, near)
        if len(surface.triangles):
            yield surface


def _in_space(vector: Any) -> Floats:
    x = np.asarray(vector, dtype=float)
    return np.array([x[0], 0.0, x[1]]) if len(x) == 2 else x


def _mesh(shape: Mapping[str, Any], base_dir: Path) -> Optional[Solid]:
    corners, triangles = _core.read_mesh(base_dir / shape["file"], shape.get("scale", 1.0))
    if len(triangles) > MAX_TRIANGLES:
        return None
    return Solid("mesh", "solid", corners, triangles)


def _sampled_surface(
    shape: Mapping[str, Any], scene: Mapping[str, Any], base_dir: Path, near: Box
) -> Solid:
    """Return the surface of any shape where the snow may come, from samples of its distance."""
    single = _core.Simulation(_scene_of_shape(shape, scene).core, str(base_dir))
    flat = scene["dimension"] == 2
    spacing = float(near.size.max()) / (FLAT_SAMPLES if flat else SAMPLES)
    axes = [
        np.zeros(1)
        if flat and axis == 1
        else np.arange(near.low[axis], near.high[axis] + spacing, spacing)
        for axis in range(3)
    ]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    distance = single.obstacle_distance(points.reshape(-1, 3)).reshape(points.shape[:3])
    if flat:
        corners, triangles = section_of(distance[:, 0, :])
        corners = near.low + np.insert(corners, 1, 0.0, axis=1) * spacing
    else:
        corners, triangles = surface_of(np.pad(distance, 1, constant_values=spacing))
        corners = near.low + (corners - 1.0) * spacing
    return Solid(shape["type"], "solid", corners, triangles)


def _turn(shape: Mapping[str, Any], dimension: int) -> tuple[Floats, Floats]:
    """Return the rotation (3, 3) and the shift (3,) of a transform."""
    axis = np.asarray(shape.get("axis") if dimension == 3 else (0.0, 1.0, 0.0), dtype=float)
    angle = np.radians(float(shape.get("angle") or 0.0))
    along = axis / np.linalg.norm(axis)
    across = np.cross(np.eye(3), along)  # its product with x is along x x (Rodrigues)
    turn = np.eye(3) + np.sin(angle) * across + (1.0 - np.cos(angle)) * across @ across
    return turn, _in_space(shape.get("translate") or [0.0] * dimension)


def _scene_of_shape(shape: Mapping[str, Any], scene: Mapping[str, Any]) -> ResolvedScene:
    """Return a scene with a single shape and hardly any snow."""
    dimension = scene["dimension"]
    drop = {"type": "sphere", "center": [0.0] * dimension, "radius": 0.05}
    bare = {"snowshed": scene["snowshed"], "dimension": dimension, "numerics": {"dx": 0.05}}
    bare |= {"obstacles": [{"shape": dict(shape)}], "bodies": [{"shape": drop}]}
    return ResolvedScene.from_data(bare)


def _box(name: str, kind: str, centre: Floats, edges: Any) -> Solid:
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = np.array([t for a, b, c, d in sides for t in ([a, b, c], [a, c, d])])
    return Solid(name, kind, centre + (CORNERS - 0.5) @ np.asarray(edges), triangles)


def _plate(centre: Floats, normal: Floats, shape: Mapping[str, Any]) -> Solid:
    up = normal / np.linalg.norm(normal)
    across = np.array([0.0, 1.0, 0.0])
    slope = np.cross(across, up)
    slope /= np.linalg.norm(slope)
    across = np.cross(up, slope)
    width = float(shape.get("width") or 0.0)
    edges = (shape["length"] * slope, width * across, shape["thickness"] * up)
    return _box("plate", "solid", centre - 0.5 * shape["thickness"] * up, edges)


def _frame_along(axis: Floats) -> tuple[Floats, Floats, Floats]:
    length = np.linalg.norm(axis)
    along = axis / length if length > 0 else np.array([0.0, 0.0, 1.0])
    side = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    side /= np.linalg.norm(side)
    return along, side, np.cross(along, side)


def _revolved(rings: list[tuple[Floats, float]], side: Floats, other: Floats) -> Solid:
    """Return the solid of revolution through rings: centre and radius of each, end to end."""
    angle = np.linspace(0.0, 2.0 * np.pi, ROUND_SIDES, endpoint=False)
    circle = np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * other
    corners = np.concatenate([centre + radius * circle for centre, radius in rings])
    triangles = []
    for ring in range(len(rings) - 1):
        for k in range(ROUND_SIDES):
            a, b = ring * ROUND_SIDES + k, ring * ROUND_SIDES + (k + 1) % ROUND_SIDES
            triangles += [[a, b, a + ROUND_SIDES], [b, b + ROUND_SIDES, a + ROUND_SIDES]]
    return Solid("round", "solid", corners, np.array(triangles))


def _cylinder(start: Floats, end: Floats, radius: float) -> Solid:
    _, side, other = _frame_along(end - start)
    return _revolved([(start, 0.0), (start, radius), (end, radius), (end, 0.0)], side, other)


def _capsule(start: Floats, end: Floats, radius: float) -> Solid:
    along, side, other = _frame_along(end - start)
    quarter = np.linspace(0.0, 0.5 * np.pi, ROUND_SIDES // 4 + 1)
    first = [(start - radius * np.cos(a) * along, radius * float(np.sin(a))) for a in quarter]
    last = [(end + radius * np.sin(a) * along, radius * float(np.cos(a))) for a in quarter]
    return _revolved(first + last, side, other)


def _motion(spec: Mapping[str, Any]) -> dict[str, Any]:
    """Return a motion with all its keys, in space."""
    turning = np.atleast_1d(np.asarray(spec.get("angular_velocity", [0.0, 0.0, 0.0]), dtype=float))
    if turning.size not in (1, 3):
        raise InputError(f"motion: an angular velocity of {turning.size} numbers")
    return {
        "velocity": _in_space(spec.get("velocity", [0.0, 0.0, 0.0])).tolist(),
        "angular_velocity": [0.0, float(turning[0]), 0.0]
        if turning.size == 1
        else turning.tolist(),
        "pivot": _in_space(spec.get("pivot", [0.0, 0.0, 0.0])).tolist(),
        "start": float(spec.get("start", 0.0)),
        "end": float(spec.get("end", 1e9)),
    }


def _base64(values: NDArray[Any]) -> str:
    return base64.b64encode(values.tobytes()).decode()
