"""A viscous current that spreads over a floor, as a fluid of particles."""

from __future__ import annotations

import math

from snowshed.methods.mps.settings import MpsSettings
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import absolute, relative
from validation.mps.bodies import GRAVITY, block, floor_and_sides, mps_driver

DENSITY, VISCOSITY = 1000.0, 50.0  # kg/m3, Pa s
WIDTH, HEIGHT = 0.3, 0.2  # m, before it spreads
TIMES = (4.0, 16.0)  # s
#: Exponent of the front's distance as a function of time.
EXPONENT = 0.2


def front_at(time: float) -> float:
    """Return the distance of the front from the wall, m.

    x = 1.411 (g q^3/(3 nu))^(1/5) t^(1/5) with the area q in the plane: Huppert (1982), Journal of
    Fluid Mechanics 121, 43-58, equation 2.19 with a constant volume.

    Examples
    --------
    >>> round(front_at(1.0), 3)
    0.602
    """
    area, viscosity = WIDTH * HEIGHT, VISCOSITY / DENSITY
    return float(1.411 * (GRAVITY * area**3 / (3 * viscosity) * time) ** EXPONENT)


def measure(settings: CaseSettings) -> Outcome:
    """Let a block of a viscous fluid spread, and compare the distance of its front."""
    fluid = MpsSettings(density=DENSITY, viscosity=VISCOSITY, rheology="newtonian")
    drive = mps_driver(fluid, floor_and_sides(), [block(WIDTH, HEIGHT)], settings)
    fronts, exact = [], []
    for time in TIMES:
        drive.run_to(time)
        fronts.append(float(drive.core.positions()[:, 0].max()) + 0.5 * float(settings["spacing"]))
        exact.append(front_at(drive.core.time_s))
    growth = math.log(fronts[1] / fronts[0]) / math.log(exact[1] / exact[0])
    return drive.outcome(
        [
            relative("front", fronts[1], exact[1]),
            absolute("exponent", EXPONENT * growth, EXPONENT),
        ]
    )


def matrix(full: bool) -> list[CaseSettings]:
    """Return the settings to measure: particle spacings, then walls of particles."""
    spacings = (0.03, 0.02, 0.01) if full else (0.02, 0.01)
    settings_list: list[CaseSettings] = [{"spacing": spacing} for spacing in spacings]
    return [*settings_list, {"spacing": 0.01, "walls": "particles"}]


CASE = Case(
    name="mps_current",
    title="Viscous current on a floor, as a fluid of particles",
    source="Huppert (1982), Journal of Fluid Mechanics 121, 43-58",
    description="""
    A block of a fluid of 50 Pa s, 0.3 m wide and 0.2 m high, spreads along a floor from a wall. Its
    front is compared with that of a thin viscous current of the same area after 16 s, and the
    exponent of its growth from 4 to 16 s with one fifth.
    """,
    quantities=(
        Quantity("front", "front, m", limit=0.03, limit_for={"spacing": 0.01}),
        Quantity(
            "exponent", "exponent of the front's growth", limit=0.01, limit_for={"spacing": 0.01},
            relative=False,
        ),
    ),
    matrix=matrix,
    measure=measure,
)  # fmt: skip
