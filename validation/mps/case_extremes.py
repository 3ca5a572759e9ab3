"""Fluids of particles at the extremes of their settings: finite values and tight walls."""

from __future__ import annotations

import math

import numpy as np

from snowshed._core import SimulationError
from snowshed.methods.mps.settings import MpsSettings
from snowshed.scene.components import Body, Obstacle
from snowshed.scene.shape import Shape
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.mps.bodies import mps_driver

SNOW = MpsSettings(density=200.0, friction_angle=24.0)
CASE_SETTINGS = frozenset({"tilt", "board"})
STEPS = 60
BLOCK_EDGE = 0.2  # m; the block of snow falls by a quarter of its edge onto a tilted plane
BOARD_DISTANCE = 0.25  # m, down the plane from the block's middle
BOARD_HEIGHT = 0.3  # m, above the plane

DEFAULTS: CaseSettings = {"spacing": 0.02, "tilt": 35.0, "board": 0.0}
#: Viscosities in Pa s, and yield stresses in Pa.
VISCOSITIES = (0.0, 1.0, 1e2, 1e4)


def measure(settings: CaseSettings) -> Outcome:
    """Let a block slide to a board; count values that are not finite and particles in walls."""
    tilt, board = float(settings["tilt"]), float(settings["board"])
    angle = math.radians(tilt)
    down = np.array([math.cos(angle), 0.0, -math.sin(angle)])
    normal = np.array([math.sin(angle), 0.0, math.cos(angle)])
    obstacles = [_sticky("plane", Shape.plane((0, 0), (normal[0], normal[2])))]
    if board > 0:
        size = (board * float(settings["spacing"]), BOARD_HEIGHT)
        obstacles.append(
            _sticky("board", _box(BOARD_DISTANCE * down + 0.5 * size[1] * normal, size, tilt))
        )
    snow = Body(shape=_box(0.75 * BLOCK_EDGE * normal, (BLOCK_EDGE, BLOCK_EDGE), tilt))
    drive = mps_driver(SNOW, obstacles, [snow], settings, CASE_SETTINGS)
    stopped = 0.0
    try:
        drive.step(STEPS)
    except SimulationError:  # the error names its cause, and the snow is unchanged
        stopped = 1.0
    positions, speeds = drive.core.positions(), drive.core.velocities()
    fields = [drive.core.field_by_id(name) for name in ("pressure", "apparent_viscosity")]
    not_finite = sum(int((~np.isfinite(values)).sum()) for values in (positions, speeds, *fields))
    height, distance = positions @ normal, positions @ down
    behind_walls = int((height < 0).sum())
    if board > 0:
        inside = np.abs(distance - BOARD_DISTANCE) < 0.5 * board * float(settings["spacing"])
        behind_walls += int((inside & (height < BOARD_HEIGHT)).sum())
        low = height < 0.8 * BOARD_HEIGHT  # no snow has come over the board
        behind_walls += (
            int((low & (distance > BOARD_DISTANCE)).sum()) if height.max() < BOARD_HEIGHT else 0
        )
    density = float(drive.core.field_by_id("number_density").max())
    return drive.outcome(
        [
            Measured("unsound", float(not_finite), 0.0, float(not_finite)),
            Measured("through", float(behind_walls), 0.0, float(behind_walls)),
            Measured("stopped", stopped, 0.0, stopped),
            Measured("density", density, 1.0, density - 1),
        ]
    )


def _sticky(name: str, shape: Shape) -> Obstacle:
    return Obstacle(name=name, shape=shape, condition="sticky")


def _box(centre: np.ndarray, size: tuple[float, float], tilt: float) -> Shape:
    box = Shape.box((0, 0), size)
    return Shape.transform(box, angle=tilt, translate=(float(centre[0]), float(centre[2])))


def matrix(full: bool) -> list[CaseSettings]:
    """Return viscosities with yield stresses, tilts, boards, spacings and radii, for both walls."""
    values = VISCOSITIES if full else VISCOSITIES[::3]
    settings_list: list[CaseSettings] = [
        {"viscosity": v, "cohesion": c} for v in values for c in values
    ]
    settings_list += [{"tilt": tilt} for tilt in ((0.0, 20.0, 60.0, 85.0) if full else (0.0, 85.0))]
    settings_list += [
        {"board": board} for board in ((0.05, 0.2, 0.5, 1.0, 2.0, 4.0) if full else (0.2, 2.0))
    ]
    settings_list += [{"spacing": spacing} for spacing in ((0.1, 0.05, 0.005) if full else (0.05,))]
    settings_list += [{"radius": radius} for radius in ((1.5, 3.1, 4.5) if full else (3.1,))]
    settings_list += [{"viscosity": 1e4, "cohesion": 1e4, "board": 0.2}]
    walls: list[CaseSettings] = [{}, {"walls": "particles"}]
    return [{**DEFAULTS, **variant, **wall} for variant in settings_list for wall in walls]


CASE = Case(
    name="mps_extremes",
    title="Fluids of particles at the extremes of their settings",
    source="all values are finite, no particle is behind a wall",
    description="""
    A block of snow falls a little and slides down a plane, with or without a board that stands on
    it. Viscosity and yield stress go up to 1e4 Pa s and Pa, and tilts to 85 degrees. Boards are
    thinner or thicker than a particle (their thickness is in particle spacings). After 60
    steps all values must be finite, and no particle may be behind or in a wall. A run may stop with
    an error.
    """,
    quantities=(
        Quantity("unsound", "values that are not finite", limit=0.0, relative=False),
        Quantity("through", "particles behind or in a wall", limit=0.0, relative=False),
        Quantity("stopped", "runs that stopped with an error", relative=False),
        Quantity("density", "largest density over that of a lattice"),
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    Stiff fluids are compressed, and so is snow for a moment as it lands. The density is therefore
    reported without a limit.
    """,
)
