"""The scenes: two slopes with an erodible layer, and a wooden slope with and without obstacles.

The paper prints density, adhesive force, friction angle, viscosity, spacing and the thickness of
the erodible layer. All shapes are ours, because our copy lacks the drawings: tilts, lengths of
slopes 1 and 2, the amount of snow, stakes and board. The limits of the dilatant branch, of erosion
and of deposition are ours, too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.methods.mps.settings import MpsSettings
from snowshed.scene.components import Body, Events, Obstacle
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape

#: Printed: slopes 1 and 2.
SLOPE_SNOW = MpsSettings(
    spacing=0.5, density=320, cohesion=100, friction_angle=24, viscosity=0.01, max_time_step=0.01
)
ERODIBLE_THICKNESS = 0.25  # m, printed
#: Printed: wooden slope.
WOOD_SNOW = MpsSettings(
    density=200, cohesion=0, friction_angle=24, viscosity=0.012, max_time_step=0.01
)
WOOD_LENGTH = 5.4  # m, printed
#: Inferred, wooden slope.
WOOD_TILT = 30.0  # degrees
BLOCK = (0.4, 0.2)  # m, length and height of the block of snow; it fills the slope's width
OBSTACLE_DISTANCE = 0.3  # m above the foot of the slope
STAKE_WIDTH, STAKE_HEIGHT = 0.02, 0.2  # m
BOARD_HEIGHT, BOARD_GAP = 0.12, 0.04  # m
NOTCH = (0.04, 0.06)  # m, width and depth of the board's notch
#: Inferred, slopes 1 and 2: tilt and length (m) from the top down, then level ground.
SLOPES: Mapping[int, Sequence[tuple[float, float]]] = {
    1: [(30.0, 40.0)],
    2: [(38.0, 30.0), (20.0, 30.0)],
}
RELEASED_SLAB = (12.0, 10.0, 1.5)  # m, length, width and height of the slab that is released
LAYER_WIDTH = 20.0  # m
#: Shear rate at which the dilatant branch begins on the wooden slope. Snow that slides along a wall
#: at 10 m/s has about this shear rate, with the particles of that slope.
WOOD_LIMIT = 1000.0  # 1/s
#: The same for slopes 1 and 2, whose particles are larger.
SLOPE_LIMIT = 50.0  # 1/s

BINGHAM, COMBINED = "Bingham", "combined"
NO_OBSTACLE, NARROW_STAKES, WIDE_STAKES, NOTCHED_BOARD = (
    "no obstacle",
    "stakes 0.02 m",
    "stakes 0.04 m",
    "notched board",
)
OBSTACLE_NAMES = (NO_OBSTACLE, NARROW_STAKES, WIDE_STAKES, NOTCHED_BOARD)


@dataclass(frozen=True)
class Resolution:
    """The resolution of the cases.

    Attributes
    ----------
    wooden_spacing
        Distance between particles on the wooden slope, m; the paper has 0.01 m.
    wooden_width
        Width of the wooden slope, m.
    slope_dimension
        Dimension of slopes 1 and 2. In two dimensions snow does not spread sideways.
    """

    wooden_spacing: float
    wooden_width: float
    slope_dimension: int


QUICK, FULL = Resolution(0.02, 0.24, 2), Resolution(0.01, 0.4, 3)


@dataclass(frozen=True)
class GroundProfile:
    """A ground of planes, from the top down to the level ground at x > 0, z = 0.

    Attributes
    ----------
    corners
        (x, z) of the upper end of the first plane and of the lower ends of all planes, m, from
        the top.
    """

    corners: Sequence[tuple[float, float]]

    @classmethod
    def of(cls, planes: Sequence[tuple[float, float]]) -> GroundProfile:
        """Return the profile of planes with tilts in degrees and lengths in m, from the top down.

        Examples
        --------
        >>> profile = GroundProfile.of([(30.0, 2.0)])
        >>> profile.along(np.array([[-1.7320508, 0, 1.0], [1, 0, 0]])).round(3).tolist()
        [-2.0, 1.0]
        """
        corners = [(0.0, 0.0)]
        for tilt, length in reversed(planes):
            x, z = corners[0]
            angle = math.radians(tilt)
            corners.insert(0, (x - length * math.cos(angle), z + length * math.sin(angle)))
        return cls(corners)

    def along(self, positions: Floats) -> Floats:
        """Return the distance of points along the ground, m; 0 where the level ground begins."""
        xs = [x for x, _ in self.corners]
        distances = [0.0]
        for (x, z), (next_x, next_z) in zip(self.corners[-2::-1], self.corners[:0:-1]):
            distances.insert(0, distances[0] - math.hypot(next_x - x, next_z - z))
        along = np.interp(positions[:, 0], xs, distances)
        beyond = positions[:, 0] > 0
        along[beyond] = positions[beyond, 0]
        return np.asarray(along)

    def frame(self, distance: float) -> tuple[Floats, Floats, Floats, float]:
        """Return a point of the ground, its downhill and normal directions, and its tilt."""
        for (x, z), (next_x, next_z) in zip(self.corners[-2::-1], self.corners[:0:-1]):
            length = math.hypot(next_x - x, next_z - z)
            down = np.array([next_x - x, 0.0, next_z - z]) / length
            if distance > -length or (x, z) == self.corners[0]:
                point = np.array([next_x, 0.0, next_z]) + distance * down
                tilt = math.degrees(math.asin(-down[2]))
                return point, down, np.array([-down[2], 0.0, down[0]]), tilt
            distance += length
        raise AssertionError("unreachable")

    def ground(self) -> list[Obstacle]:
        """Return the ground as planes; its bends must be concave."""
        planes = [
            Obstacle(name="ground", shape=Shape.plane((0, 0, 0), (0, 0, 1)), condition="sticky")
        ]
        for k, ((x, z), (next_x, next_z)) in enumerate(zip(self.corners, self.corners[1:])):
            normal = (z - next_z, 0.0, next_x - x)
            plane = Shape.plane((next_x, 0, next_z), normal)
            planes.append(Obstacle(name=f"slope {k + 1}", shape=plane, condition="sticky"))
        return planes

    def box(
        self,
        distance: float,
        size: tuple[float, float, float],
        *,
        across: float = 0.0,
        above: float = 0.0,
    ) -> Shape:
        """Return a box on or above the ground, at a distance along the profile and across it, m."""
        point, _, normal, tilt = self.frame(distance)
        centre = point + (0.5 * size[2] + above) * normal + np.array([0.0, across, 0.0])
        box = Shape.box((0, 0, 0), size)
        return Shape.transform(box, axis=(0, 1, 0), angle=tilt, translate=tuple(centre))


def folder_name(case: str) -> str:
    """Return the name of the folder and of the stage of a case.

    Examples
    --------
    >>> folder_name("wooden slope, stakes 0.02 m")
    'wooden-slope-stakes-002-m'
    """
    return case.replace(",", "").replace(" ", "-").replace(".", "")


@dataclass(frozen=True)
class Case:
    """A case of the paper.

    Attributes
    ----------
    name
        Name for people; files are named after it.
    profile
        Its ground.
    scene
        Its scene.
    end, interval
        End of the case, and interval of the stored states, s.
    obstacle
        Position along the profile of its obstacle, or of the obstacles of other cases if it has
        none, m.
    """

    name: str
    profile: GroundProfile
    scene: Scene
    end: float
    interval: float
    obstacle: Optional[float] = None

    @property
    def file(self) -> str:
        """The name of its folder and of its stage."""
        return folder_name(self.name)

    @property
    def times(self) -> list[float]:
        """Times of the stored states, s."""
        return [self.interval * k for k in range(round(self.end / self.interval) + 1)]


def wooden_case(obstacle: str, resolution: Resolution) -> Case:
    """Return the wooden slope with an obstacle at its foot."""
    profile = GroundProfile.of([(WOOD_TILT, WOOD_LENGTH)])
    width = resolution.wooden_width
    obstacles = profile.ground()
    for side in (-1, 1):
        rail = Shape.plane((0, side * width / 2, 0), (0, -side, 0))
        name = "rail right" if side < 0 else "rail left"
        obstacles.append(Obstacle(name=name, shape=rail, condition="separate", friction=0.1))
    if obstacle in (NARROW_STAKES, WIDE_STAKES):
        gap = 0.02 if obstacle == NARROW_STAKES else 0.04
        obstacles.append(_solid("stakes", Shape.union(*_stakes(profile, width, gap))))
    elif obstacle == NOTCHED_BOARD:
        obstacles.append(_solid("board", _board(profile, width)))
    snow = profile.box(-WOOD_LENGTH + BLOCK[0] / 2, (BLOCK[0], width, BLOCK[1]))
    settings = replace(
        WOOD_SNOW,
        spacing=resolution.wooden_spacing,
        dilatant_rate=WOOD_LIMIT,
        erosion=True,
        erosion_pressure=200.0,
        deposition_pressure=100.0,
        deposition_speed=0.005,  # below the speed after one step: snow is not deposited at once
    )
    scene = _scene(f"wooden slope, {obstacle}", 3, settings, obstacles, [Body(shape=snow)], 4.0)
    return Case(f"wooden slope, {obstacle}", profile, scene, 4.0, 0.25, -OBSTACLE_DISTANCE)


def slope_case(number: int, model: str, resolution: Resolution) -> Case:
    """Return slope 1 or 2 with the Bingham or the combined model."""
    profile = GroundProfile.of(SLOPES[number])
    spacing = SLOPE_SNOW.spacing
    assert spacing is not None
    top = sum(length for _, length in SLOPES[number])
    snow = [Body(shape=profile.box(-top + RELEASED_SLAB[0] / 2, RELEASED_SLAB, above=spacing))]
    lengths = [length for _, length in SLOPES[number]]
    ends = [-sum(lengths[k + 1 :]) for k in range(len(lengths))]
    for end, length in zip(ends, lengths):
        layer = (length - spacing, LAYER_WIDTH, spacing)
        snow.append(Body(shape=profile.box(end - length / 2, layer)))
    snow.append(
        Body(shape=Shape.box((10.0 + spacing, 0, spacing / 2), (20.0, LAYER_WIDTH, spacing)))
    )
    settings = replace(SLOPE_SNOW, dilatant_rate=SLOPE_LIMIT)
    if model == BINGHAM:
        settings = replace(settings, rheology="bingham")
        snow = snow[:1]  # without the layer: nothing is eroded
    else:
        # The layer is thinner than a particle, so the first row of particles represents it.
        settings = replace(settings, erosion=True, erodible_thickness=1.2 * ERODIBLE_THICKNESS)
        settings = replace(
            settings, erosion_pressure=1000, deposition_pressure=500, erosion_speed=1.0,
            deposition_speed=0.1,
        )  # fmt: skip
    dimension = resolution.slope_dimension
    scene = _scene(f"slope {number}, {model}", dimension, settings, profile.ground(), snow, 20.0)
    return Case(f"slope {number}, {model}", profile, scene, 20.0, 1.0)


def cases(resolution: Resolution) -> list[Case]:
    """Return all cases."""
    slopes = [
        slope_case(number, model, resolution) for number in SLOPES for model in (BINGHAM, COMBINED)
    ]
    return [*(wooden_case(obstacle, resolution) for obstacle in OBSTACLE_NAMES), *slopes]


def _solid(name: str, shape: Shape) -> Obstacle:
    return Obstacle(name=name, shape=shape, condition="sticky")


def _stakes(profile: GroundProfile, width: float, gap: float) -> list[Shape]:
    count = int((width + 1e-9) // (STAKE_WIDTH + gap))
    first = -0.5 * (count - 1) * (STAKE_WIDTH + gap)
    size = (STAKE_WIDTH, STAKE_WIDTH, STAKE_HEIGHT)
    return [
        profile.box(-OBSTACLE_DISTANCE, size, across=first + k * (STAKE_WIDTH + gap))
        for k in range(count)
    ]


def _board(profile: GroundProfile, width: float) -> Shape:
    """Return a board that leaves gaps at its ends and has a notch in the middle of its top."""
    board = profile.box(-OBSTACLE_DISTANCE, (STAKE_WIDTH, width - 2 * BOARD_GAP, BOARD_HEIGHT))
    cut = (3 * STAKE_WIDTH, NOTCH[0], NOTCH[1] + 0.02)  # beyond the board's faces
    return Shape.difference(
        board, profile.box(-OBSTACLE_DISTANCE, cut, above=BOARD_HEIGHT - NOTCH[1])
    )


def _scene(
    title: str,
    dimension: int,
    settings: MpsSettings,
    obstacles: list[Obstacle],
    bodies: list[Body],
    end: float,
) -> Scene:
    if dimension == 2:
        obstacles = [replace(obstacle, shape=_flat(obstacle.shape)) for obstacle in obstacles]
        bodies = [replace(body, shape=_flat(body.shape)) for body in bodies]
    events = Events(count=1, max_time=end + 1, between="carry")
    return Scene(
        title=title, dimension=dimension, method="mps", numerics=settings, obstacles=obstacles,
        bodies=bodies, events=events,
    )  # fmt: skip


def _flat(shape: Optional[Shape]) -> Optional[Shape]:
    """Return the section of a shape by the plane y = 0."""
    if shape is None:
        return None
    parts = shape.shapes and [flat for part in shape.shapes if (flat := _flat(part))]
    return replace(
        shape, axis=None, center=_section(shape.center), size=_section(shape.size),
        normal=_section(shape.normal), translate=_section(shape.translate), shapes=parts,
    )  # fmt: skip


def _section(vector: Optional[Sequence[float]]) -> Optional[Sequence[float]]:
    return None if vector is None else (vector[0], vector[2])
