"""A column of snow that settles under its own weight, elastic or yielding."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Union

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.scene.components import Body, Condition, Obstacle
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import TimedEventDriver, apply_settings, relative
from validation.material_paths.rate_equations import RateEquations

HEIGHT = 0.4  # m
WIDTH_CELLS = 8  # cells, at any resolution
DENSITY, GRAVITY = 210.0, 9.81  # kg/m3, m/s2
#: Soft snow, so that the column settles visibly: by 1.5 % if elastic, by 3 % if it yields.
YOUNGS_MODULUS, POISSONS_RATIO = 2e4, 0.3
SLOPE, COHESION, HARDENING, STRENGTH = 0.5, 0.2, 1.0, 200.0
#: Settings of the case itself: the height of the floor above a row of nodes, in cells.
CASE_SETTINGS = frozenset({"floor_offset"})
#: Lowest layers, which the rms error of pressure leaves out.
FLOOR_LAYERS = 2
#: Steps between two dampings of the velocities.
STEPS_PER_DAMPING = 4


@dataclass(frozen=True)
class ElasticColumn:
    """The elastic column at rest between its walls, in closed form with Lambert's function W.

    With a = lambda + 2 mu, the vertical Kirchhoff stress of the compression x (minus the vertical
    Hencky strain) is a x. Per area of the undeformed column the force is a x exp(x). It carries the
    weight rho g h of the snow above, where h is the depth before settling. Hence x = W(rho g h/a).

    Attributes
    ----------
    dimension
        2 or 3; the definition of the pressure depends on it (K_d).

    Examples
    --------
    For small strains the top sinks by rho g H^2/(2 a).

    >>> column = ElasticColumn(dimension=2)
    >>> ratio = column.settlement(np.array(0.4)) / (210 * 9.81 * 0.4**2 / 2 / column.modulus)
    >>> round(float(ratio), 2)
    0.97
    """

    dimension: int

    @property
    def law(self) -> RateEquations:
        """Constitutive law of the snow."""
        return RateEquations(
            YOUNGS_MODULUS, POISSONS_RATIO, SLOPE, COHESION, HARDENING, self.dimension
        )

    @property
    def modulus(self) -> float:
        """Lambda + 2 mu, Pa."""
        return float(self.law.stiffness[0, 0])

    def compression(self, depth: Floats) -> Floats:
        """Return the compression x at depths (m, before settling) below the top."""
        from scipy.special import lambertw

        return np.asarray(lambertw(DENSITY * GRAVITY * depth / self.modulus).real)

    def pressure(self, depth: Floats) -> Floats:
        """Return the Kirchhoff pressure (Pa) at depths (m)."""
        bulk = float(self.law.stiffness.mean())
        return bulk * self.compression(depth)

    def settlement(self, depth: Floats) -> Floats:
        """Return the shortening (m) of the snow above a depth (m).

        The shortening is the integral of 1 - exp(-x) over the depth, with exp(-W(w)) = W(w)/w.
        """
        x = self.compression(depth)
        return depth - self.modulus / (DENSITY * GRAVITY) * (x + x**2 / 2)


@dataclass(frozen=True)
class YieldingColumn:
    """The column of snow that yields and hardens, with stresses from the rate equations.

    Attributes
    ----------
    dimension
        2 or 3.
    deepest
        Largest depth at which values are computed, m.

    Examples
    --------
    >>> elastic, yielding = ElasticColumn(2), YieldingColumn(2)
    >>> bool(yielding.settlement(np.array(0.4)) > 2 * elastic.settlement(np.array(0.4)))
    True
    """

    dimension: int
    deepest: float = HEIGHT

    @cached_property
    def _table(self) -> tuple[Floats, Floats, Floats]:
        """Depth, pressure and settlement for evenly spaced compressions from zero."""
        law = ElasticColumn(self.dimension).law
        x = np.linspace(0.0, 0.2, 4001)
        downward = np.zeros(self.dimension)
        downward[-1] = -1.0
        states = law.integrate(law.initial_state(STRENGTH), downward, x)
        weight = -law.stress(states)[:, -1] * np.exp(x)
        depth = weight / (DENSITY * GRAVITY)
        if depth[-1] < self.deepest:
            raise ValueError(f"{self.deepest} m: at most {depth[-1]:.3g} m are tabulated")
        shortening = 1 - np.exp(-x)
        steps = np.diff(depth) * (shortening[1:] + shortening[:-1]) / 2
        return depth, law.invariants(states)[0], np.append(0.0, np.cumsum(steps))

    def pressure(self, depth: Floats) -> Floats:
        """Return the Kirchhoff pressure (Pa) at depths (m)."""
        depths, pressures, _ = self._table
        return np.interp(depth, depths, pressures)

    def settlement(self, depth: Floats) -> Floats:
        """Return the shortening (m) of the snow above a depth (m)."""
        depths, _, settlements = self._table
        return np.interp(depth, depths, settlements)


Column = Union[ElasticColumn, YieldingColumn]


def column_scene(settings: CaseSettings) -> Scene:
    """Return a column between frictionless walls on a sticky floor."""
    dimension, dx = int(settings["dimension"]), float(settings["dx"])
    floor, width = float(settings["floor_offset"]) * dx, WIDTH_CELLS * dx
    if dimension == 3:
        width /= 2
    corner, size = np.zeros(dimension), np.full(dimension, width)
    corner[-1], size[-1] = floor, HEIGHT
    walls = [_wall(corner, axis=dimension - 1, side=1, condition="sticky")]
    for axis in range(dimension - 1):
        walls += [
            _wall(at, axis, side, "separate") for at, side in ((corner, 1), (corner + size, -1))
        ]
    snow = Body(shape=Shape.box((corner + size / 2).tolist(), size.tolist()))
    scene = Scene(dimension=2, obstacles=walls, bodies=[snow], gravity=GRAVITY)
    scene.update(
        {
            "snow.density": DENSITY,
            "snow.youngs_modulus": YOUNGS_MODULUS,
            "snow.poissons_ratio": POISSONS_RATIO,
            "snow.critical_state_slope": SLOPE,
            "snow.cohesion": COHESION,
            "snow.hardening_factor": HARDENING,
            "snow.preconsolidation_pressure": STRENGTH,
        }
    )
    return apply_settings(scene, settings, CASE_SETTINGS)


def _wall(corner: Floats, axis: int, side: int, condition: Condition) -> Obstacle:
    """Return a half-space with a face through `corner`, open towards `side` of an axis."""
    normal = [0.0] * len(corner)
    normal[axis] = float(side)
    plane = Shape.plane(corner.tolist(), normal)
    return Obstacle(shape=plane, condition=condition, friction=0.0)


def settle(drive: TimedEventDriver, periods: float) -> None:
    """Let a column come to rest, with so much damping that no layer overshoots.

    Snow that yields would keep the deformation of an overshoot. Velocities fall at the rate
    2 omega, which is critical for the slowest vibration, omega = pi c/(2 H). All other vibrations
    are too fast to matter.
    """
    speed = math.sqrt(ElasticColumn(drive.core.dimension).modulus / DENSITY)
    omega = math.pi * speed / (2 * HEIGHT)
    while drive.core.time_s < periods * 2 * math.pi / omega:
        before = drive.core.time_s
        drive.step(STEPS_PER_DAMPING)
        drive.damp(2 * omega * (drive.core.time_s - before))


def measure(settings: CaseSettings, column: Column, periods: float) -> Outcome:
    """Let a column settle, and compare means over layers one cell thick with the exact means."""
    drive = TimedEventDriver(column_scene(settings))
    dx = float(settings["dx"])
    start = drive.core.positions()[:, 2]
    settle(drive, periods)
    height = start - float(settings["floor_offset"]) * dx
    layers = np.minimum((height / dx).astype(int), round(HEIGHT / dx) - 1)
    size = np.bincount(layers)

    def mean(values: Floats) -> Floats:
        """Return the mean of each layer."""
        return np.bincount(layers, values) / size

    depth = HEIGHT - height
    settlement = mean(start - drive.core.positions()[:, 2])
    exact_settlement = mean(column.settlement(np.array(HEIGHT)) - column.settlement(depth))
    pressure, exact_pressure = mean(drive.core.pressures()), mean(column.pressure(depth))
    errors = (pressure - exact_pressure)[FLOOR_LAYERS:] / column.pressure(np.array(HEIGHT))
    rms_error = float(np.sqrt(np.mean(errors**2)))
    return drive.outcome(
        [
            relative("settlement", float(settlement[-1]), float(exact_settlement[-1])),
            Measured("pressure", rms_error, 0.0, rms_error),
            relative("floor_pressure", float(pressure[0]), float(exact_pressure[0])),
        ]
    )


def measure_elastic(settings: CaseSettings) -> Outcome:
    """Let a column of elastic snow settle, and return its errors."""
    column = ElasticColumn(int(settings["dimension"]))
    return measure({**settings, "model": "elastic"}, column, periods=4)


def measure_yielding(settings: CaseSettings) -> Outcome:
    """Let a column of snow that yields settle, and return its errors."""
    column = YieldingColumn(int(settings["dimension"]))
    return measure({**settings, "model": "cam_clay"}, column, periods=10)


REGULAR_SETTINGS: CaseSettings = {
    "dimension": 2,
    "dx": 0.01,
    "pattern": "regular",
    "particles_per_voxel": 4,
    "transfer": "flip",
    "basis": "quadratic",
    "precision": "float",
    "floor_offset": 0.0,
}
RANDOM_SETTINGS: CaseSettings = {**REGULAR_SETTINGS, "pattern": "poisson", "particles_per_voxel": 6}
METHOD_VARIANTS: tuple[CaseSettings, ...] = (
    {"particles_per_voxel": 9},
    {"particles_per_voxel": 16},
    {"transfer": "apic"},
    {"precision": "double"},
    {"floor_offset": 0.5},
    {"floor_offset": 0.75},
)


def elastic_matrix(full: bool) -> list[CaseSettings]:
    """Return resolutions; if full, also seedings, bases and other variations."""
    sizes = (0.04, 0.02, 0.01, 0.005, 0.0025) if full else (0.02, 0.01, 0.005)
    settings_list: list[CaseSettings] = [{**REGULAR_SETTINGS, "dx": dx} for dx in sizes]
    if not full:
        return [*settings_list, {**RANDOM_SETTINGS, "dx": 0.01, "seed": 1}]
    settings_list += [
        {**RANDOM_SETTINGS, "dx": dx, "seed": seed} for dx in sizes for seed in (1, 2, 3)
    ]
    denser = (12, 24, 48)
    settings_list += [{**RANDOM_SETTINGS, "particles_per_voxel": n, "seed": 1} for n in denser]
    settings_list += [{**REGULAR_SETTINGS, "basis": "cubic", "dx": dx} for dx in sizes[1:]]
    settings_list += [{**REGULAR_SETTINGS, "floor_offset": 0.5, "dx": dx} for dx in (0.02, 0.005)]
    settings_list += [{**REGULAR_SETTINGS, **method} for method in METHOD_VARIANTS]
    return [
        *settings_list,
        {**REGULAR_SETTINGS, "dx": 0.02, "particles_per_voxel": 8, "dimension": 3},
    ]


def yielding_matrix(full: bool) -> list[CaseSettings]:
    """Return resolutions; if full, also seedings and other variations."""
    sizes = (0.02, 0.01, 0.005, 0.0025) if full else (0.02, 0.01)
    settings_list: list[CaseSettings] = [{**REGULAR_SETTINGS, "dx": dx} for dx in sizes]
    if full:
        settings_list += [
            {**RANDOM_SETTINGS, "dx": dx, "seed": seed} for dx in sizes[:3] for seed in (1, 2, 3)
        ]
        settings_list += [{**REGULAR_SETTINGS, "basis": "cubic"}]
        settings_list += [{**REGULAR_SETTINGS, **method} for method in METHOD_VARIANTS[:4]]
    return settings_list


def _quantities(finest: float) -> tuple[Quantity, ...]:
    lattice: CaseSettings = {
        "dx": finest,
        "pattern": "regular",
        "basis": "quadratic",
        "floor_offset": 0.0,
    }
    return (
        Quantity("settlement", "settlement of the top, m", 0.01, lattice, order_in="dx"),
        Quantity("pressure", "rms error of pressure above the two lowest cells", 0.01, lattice),
        Quantity("floor_pressure", "mean pressure in the lowest cell, Pa"),
    )


DESCRIPTION = """
    A column of snow 40 cm high, between frictionless walls on a floor to which it sticks, settles
    under its own weight until it rests. Its velocities are damped so strongly that it never swings
    back. The settlement of the uppermost cell and the pressure are compared as means over layers
    one cell thick. Pressure errors are relative to the pressure at the bottom.
"""
FLOOR_REMARK = """
The floor causes the largest error. The grid stops the nodes on and below the floor, but snow
between the floor and the first free node still moves. The column therefore behaves as if the floor
were a third of a cell lower. The pressure in the lowest cell is 11 to 16 % too high at any
resolution (22 % with cubic splines), and the pressure in the next cell is too low. This error is of
first order in dx: the settlement is right to 1 % if the column is at least 80 cells high (160 if
the snow yields). These numbers hold if the floor lies on a row of nodes. If it lies half a cell
above a row, errors are five times as large; at three quarters of a cell they are fourteen times as
large.
"""
SEEDING_REMARK = """
Random seeding, the default, makes snow softer. The grid strains too much where particles are
sparse, and denser places do not compensate for it. At 6 particles per voxel the column settles by
another 1 to 3 % if it is elastic and by 4 to 6 % if it yields. A finer grid does not help, because
a cell holds as many particles as before. With 24 or more particles the excess is about half a
percent. The pressure of single particles scatters by 8 % of the pressure at the bottom; on a
lattice it scatters by 2 to 4 %. Use means over a cell.
"""

ELASTIC = Case(
    name="settlement",
    title="Settlement of an elastic column under its own weight",
    source=(
        "closed form for Hencky elasticity: the vertical strain is W(w/(λ + 2 μ)), with Lambert's "
        "function W and the weight w of the snow above per area"
    ),
    description=DESCRIPTION
    + """
    The snow is elastic and soft (E = 20 kPa), so the top sinks by 1.5 % of the height and the
    strain at the bottom is no longer small.
    """,
    quantities=_quantities(0.005),
    matrix=elastic_matrix,
    measure=measure_elastic,
    remarks=FLOOR_REMARK + SEEDING_REMARK,
)
YIELDING = Case(
    name="yielding_settlement",
    title="Settlement of a yielding column under its own weight",
    source=(
        "equilibrium of every layer, with the stress of oedometric compression from the rate "
        "equations of the snow (SciPy's DOP853)"
    ),
    description=DESCRIPTION
    + """
    The snow is soft (E = 20 kPa) and weak (p0 = 200 Pa), so that all except its top 5 cm yields and
    hardens (factor 1), and the top sinks by 3.1 % of the height.
    """,
    quantities=_quantities(0.0025),
    matrix=yielding_matrix,
    measure=measure_yielding,
    remarks=FLOOR_REMARK + SEEDING_REMARK,
)

CASES = (ELASTIC, YIELDING)
