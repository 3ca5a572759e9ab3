"""Return mapping along strain paths, compared with the rate equations of the same snow."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Callable, NamedTuple

import numpy as np

from snowshed import _core
from snowshed.analysis.accuracy.calibrated_snow import calibrated_snow
from snowshed.base.arrays import Floats
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import relative
from validation.material_paths.rate_equations import RateEquations, evenly

SOURCE = (
    "the rate equations of the law (thesis 1.2.5 to 1.2.7) in principal stresses, integrated by an "
    "adaptive Runge-Kutta method of order 8 (SciPy's DOP853) to a relative 1e-12"
)
#: Number of points of a path at which states are compared.
POINTS = 20
COARSE_INCREMENTS = (1e-3, 1e-4, 1e-5)
FINE_INCREMENTS = (1e-6, 2.5e-8)
MAX_DEVIATION = 1e-6  # from the rate equations
PLAIN_INCREMENT = 2.5e-8  # of strain, with which backward Euler must reach it
EXTRAPOLATED_INCREMENT = 1e-5  # of strain, with which extrapolated backward Euler must reach it


@dataclass(frozen=True)
class StrainPath:
    """Straight strain path of the calibrated snow, from an isotropic state.

    Attributes
    ----------
    strain
        Largest principal strain at the end of the path, tension positive.
    lateral
        Other principal strains, relative to the largest.
    pressure
        Pressure at the start, relative to p0.
    dimension
        2 (with one lateral direction) or 3 (with two).
    """

    strain: float
    lateral: float
    pressure: float = 0.0
    dimension: int = 3

    @property
    def rate(self) -> Floats:
        """Principal strains per length of the path, (d)."""
        parts = np.array([1.0, self.lateral, self.lateral])[: self.dimension]
        return math.copysign(1.0, self.strain) * parts

    def reference(self) -> Floats:
        """Return p (Pa), q (Pa) and e_v at the path's points by the rate equations, (points, 3)."""
        constants, strength = calibrated_snow()
        snow = RateEquations(*constants, dimension=self.dimension)
        start = snow.initial_state(strength, self.pressure * strength)
        states = snow.integrate(start, self.rate, evenly(abs(self.strain), POINTS))
        return np.column_stack([*snow.invariants(states), states[:, -1]])

    def mapped(self, increment: float) -> tuple[Floats, int]:
        """Return p, q and e_v by the core's return mapping, and the number of strain increments."""
        constants, strength = calibrated_snow()
        law = _core.CamClay(*constants, self.dimension)
        step = increment * self.rate
        volume = float(step.sum())
        deviator = step - volume / self.dimension
        # The direction of the deviator never changes, so its magnitude is enough.
        p_step = -law.bulk * volume
        q_step = 2 * law.shear * math.sqrt(1.5 * float(deviator @ deviator))
        increments_per_point = round(abs(self.strain) / (POINTS * increment))
        p, q, ev = self.pressure * strength, 0.0, law.initial_plastic_strain(strength)
        states = []
        for _ in range(POINTS):
            for _ in range(increments_per_point):
                p, q, ev = law.return_map(p + p_step, q + q_step, ev)
            states.append((p, q, ev))
        return np.array(states), POINTS * increments_per_point


class PathSolution(NamedTuple):
    """States of a path by the core and by the rate equations, and the cost of the core."""

    states: Floats
    reference: Floats
    wall_s: float
    increments: int

    @property
    def deviation(self) -> float:
        """Largest difference in p or q, relative to the largest value of p or q on the path."""
        stress, exact = self.states[:, :2], self.reference[:, :2]
        return float(np.abs(stress - exact).max() / np.abs(exact).max())

    def outcome(self, *measured: Measured) -> Outcome:
        """Return the measurements with their cost."""
        return Outcome(measured, self.wall_s, updates=self.increments)


def solve(path: StrainPath, settings: CaseSettings) -> PathSolution:
    """Solve a path with the increment of the settings, and extrapolate if they say so."""
    increment = float(settings["increment"])
    reference = path.reference()
    started = time.perf_counter()
    states, count = path.mapped(increment)
    if settings["method"] == "extrapolated":
        halved, more = path.mapped(increment / 2)
        states, count = 2 * halved - states, count + more
    return PathSolution(states, reference, time.perf_counter() - started, count)


def stress_error(solved: PathSolution, settings: CaseSettings) -> Measured:
    """Return the deviation as the quantity of the method, plain or extrapolated."""
    name = "extrapolated_stress" if settings["method"] == "extrapolated" else "stress"
    return Measured(name, solved.deviation, 0.0, solved.deviation)


# --- the paths --------------------------------------------------------------------------------


def measure_isotropic(settings: CaseSettings) -> Outcome:
    """Compress or pull equally in all directions."""
    strain = 0.1 if settings["sense"] == "tension" else -0.1
    path = StrainPath(strain, lateral=1.0, dimension=int(settings["dimension"]))
    solved = solve(path, settings)
    return solved.outcome(stress_error(solved, settings))


def measure_oedometer(settings: CaseSettings) -> Outcome:
    """Compress in one direction and hold the others."""
    solved = solve(StrainPath(-0.06, lateral=0.0, dimension=int(settings["dimension"])), settings)
    return solved.outcome(stress_error(solved, settings))


def measure_triaxial(settings: CaseSettings) -> Outcome:
    """Consolidate, then compress in one direction and stretch the others at constant volume."""
    path = StrainPath(-0.16, lateral=-0.5, pressure=float(settings["consolidation"]))
    solved = solve(path, settings)
    q = float(solved.states[-1, 1])
    critical = relative("critical_state", q, critical_state(path.pressure)[1])
    return solved.outcome(stress_error(solved, settings), critical)


def measure_tension(settings: CaseSettings) -> Outcome:
    """Pull in one direction and hold the others, until the strength is lost and beyond."""
    path = StrainPath(0.1, lateral=0.0, dimension=int(settings["dimension"]))
    solved = solve(path, settings)
    constants, strength = calibrated_snow()
    law = _core.CamClay(*constants, path.dimension)
    opened = law.initial_plastic_strain(strength) + path.strain
    left = relative("opening", float(solved.states[-1, 2]), opened)
    return solved.outcome(stress_error(solved, settings), left)


def critical_state(consolidation: float) -> tuple[float, float]:
    """Return the final p and q (Pa) of calibrated snow that is sheared at constant volume, in 3D.

    Flow is purely deviatoric at the centre of the ellipse, p = (1 - beta) p0/2, whose height there
    is q = M (p + beta p0)/sqrt(1 + 2 beta). The volume is constant, so the plastic strain e_v
    changes by the opposite of the elastic volumetric strain.

    Parameters
    ----------
    consolidation
        Initial pressure relative to the initial p0.

    Examples
    --------
    Snow consolidated to the centre of its ellipse keeps its pressure.

    >>> p, q = critical_state(0.4)
    >>> round(p / 7000, 6), round(q / (0.5 * (p + 0.2 * 7000) / 1.4**0.5), 6)
    (0.4, 1.0)
    """
    constants, strength = calibrated_snow()
    snow = RateEquations(*constants, dimension=3)
    start = snow.initial_state(strength, consolidation * strength)
    bulk = float(snow.stiffness.mean())

    def off_centre(p: float) -> float:
        return p - (1 - snow.cohesion) / 2 * snow.strength(_plastic(p))

    def _plastic(p: float) -> float:
        return float(start[-1] + (p - consolidation * strength) / bulk)

    from scipy.optimize import brentq

    p = brentq(off_centre, 0.0, strength)
    height = (p + snow.cohesion * snow.strength(_plastic(p))) / math.sqrt(1 + 2 * snow.cohesion)
    return p, snow.critical_state_slope * height


# --- the cases --------------------------------------------------------------------------------

STRESS = Quantity(
    "stress",
    "largest deviation of p or q over the largest stress",
    limit=MAX_DEVIATION,
    limit_for={"increment": PLAIN_INCREMENT},
    order_in="increment",
    min_order=0.9,
)
EXTRAPOLATED_STRESS = Quantity(
    "extrapolated_stress",
    "the same, extrapolated from increments and their halves",
    limit=MAX_DEVIATION,
    limit_for={"increment": EXTRAPOLATED_INCREMENT},
    order_in="increment",
    min_order=1.5,
)
REMARKS = """
Backward Euler is of first order: an increment ten times smaller brings only one more digit. While
snow yields, the relative error of stress is about ten to twenty times the strain increment: 0.1 to
0.2 % at an increment of 1e-4. An error of 1e-6 needs increments of about 5e-8, that is millions of
increments for a few percent of strain; no simulation takes that many. With one extrapolation, from
increments and half increments, 1e-5 is enough, but the solver does not extrapolate. The constants
of snow are known to 10 % at best, so these errors are far below the uncertainty.
"""


def _matrix(full: bool, variants: list[CaseSettings]) -> list[CaseSettings]:
    """Return all increments for all variants if full, else coarse ones for the first variant."""
    settings_list: list[CaseSettings] = []
    for variant in variants if full else variants[:1]:
        plain: CaseSettings = {**variant, "method": "backward Euler"}
        increments = (*COARSE_INCREMENTS, *FINE_INCREMENTS) if full else COARSE_INCREMENTS
        settings_list += [{**plain, "increment": increment} for increment in increments]
        settings_list += [
            {**plain, "method": "extrapolated", "increment": increment}
            for increment in COARSE_INCREMENTS
        ]
    return settings_list


def isotropic_matrix(full: bool) -> list[CaseSettings]:
    """Return compression and tension in 2D and 3D; the answer does not depend on the increment."""
    return [
        {
            "sense": sense,
            "dimension": dimension,
            "method": "backward Euler",
            "increment": increment,
        }
        for sense in ("compression", "tension")
        for dimension in ((3, 2) if full else (3,))
        for increment in (COARSE_INCREMENTS if full else COARSE_INCREMENTS[:1])
    ]


def plane_and_space_matrix(full: bool) -> list[CaseSettings]:
    """Return increments in 3D; if full, also in 2D."""
    return _matrix(full, [{"dimension": 3}, {"dimension": 2}])


def triaxial_matrix(full: bool) -> list[CaseSettings]:
    """Return increments from a stress on the wet side; if full, also from none and the dry side."""
    return _matrix(full, [{"consolidation": 0.8}, {"consolidation": 0.0}])


def _case(
    name: str,
    title: str,
    description: str,
    *more: Quantity,
    matrix: Callable[[bool], list[CaseSettings]],
    measure: Callable[[CaseSettings], Outcome],
) -> Case:
    quantities = (STRESS, EXTRAPOLATED_STRESS, *more)
    return Case(name, title, SOURCE, description, quantities, matrix, measure, REMARKS)


ISOTROPIC = Case(
    name="isotropic_path",
    title="Material path: isotropic compression and tension",
    source=SOURCE,
    description="""
    Calibrated snow is compressed or pulled by 10 %, equally in all directions. It yields at p0 or
    at -beta p0. In compression it hardens, and in tension it softens until it is loose. The error
    is the largest deviation of p or q from the rate equations at 20 points, over the largest
    stress.
    """,
    quantities=(Quantity("stress", STRESS.title, limit=MAX_DEVIATION),),
    matrix=isotropic_matrix,
    measure=measure_isotropic,
    remarks="""
    On this path the size of increments has no effect, because backward Euler is exact. The
    remaining error comes from the tolerances of both integrations.
    """,
)
OEDOMETER = _case(
    "oedometer",
    "Material path: oedometric compression",
    """
    Calibrated snow is compressed by 6 % in one direction and held in the others; it yields and
    hardens. The error is the largest deviation of p or q from the rate equations at 20 points, over
    the largest stress; "increment" is the strain of each step.
    """,
    matrix=plane_and_space_matrix,
    measure=measure_oedometer,
)
TRIAXIAL = _case(
    "triaxial",
    "Material path: triaxial compression to the critical state",
    """
    Calibrated snow, under no stress or consolidated to 0.8 p0, is compressed by 16 % in one
    direction, while the other two directions stretch so that the volume stays constant. It ends in
    the critical state, the centre of the yield ellipse, where it flows without change of stress or
    volume: p = (1 - beta) p0/2 and q = M (p + beta p0)/sqrt(1 + 2 beta), which is q = M p without
    cohesion. From 0.8 p0 it compacts on the way to this state, and from no stress it dilates.
    """,
    Quantity("critical_state", "q at the end, Pa", limit=MAX_DEVIATION),
    matrix=triaxial_matrix,
    measure=measure_triaxial,
)
TENSION = _case(
    "tension",
    "Material path: tension to full softening",
    """
    Calibrated snow is pulled by 10 % in one direction and held in the others. It yields, dilates
    and loses its strength, all of it after 8.4 %. Beyond that it carries no stress, and all further
    strain is plastic.
    """,
    Quantity("opening", "volumetric plastic strain at the end", limit=MAX_DEVIATION),
    matrix=plane_and_space_matrix,
    measure=measure_tension,
)

CASES = (ISOTROPIC, OEDOMETER, TRIAXIAL, TENSION)
