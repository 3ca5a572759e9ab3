"""A vertical cut in snow without friction, which stands or falls, as a fluid of particles."""

from __future__ import annotations

from snowshed.methods.mps.settings import MpsSettings
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import absolute
from validation.mps.bodies import GRAVITY, block, floor_and_sides, mps_driver

HEIGHT, WIDTH, END_S = 1.0, 2.0, 2.0  # m, m, s
DENSITY = 200.0  # kg/m3
#: c/(rho g H) below which a cut falls: the inverse of the stability number 3.78.
CRITICAL_STRENGTH = 0.265
#: A face that moved farther than this share of the height has fallen.
MAX_ADVANCE = 0.02


def measure(settings: CaseSettings) -> Outcome:
    """Release a block with a free face, and measure how far its front moves in 2 s."""
    strength = float(settings["strength"])
    snow = MpsSettings(
        density=DENSITY,
        viscosity=1.0,
        cohesion=strength * DENSITY * GRAVITY * HEIGHT,
        friction_angle=0.0,
        rheology="bingham",
    )
    spacing = HEIGHT / int(settings["layers"])
    drive = mps_driver(
        snow,
        floor_and_sides(),
        [block(WIDTH, HEIGHT)],
        {**settings, "spacing": spacing},
        {"strength", "layers"},
    )
    drive.run_to(END_S)
    advance = float(drive.core.positions()[:, 0].max()) + spacing / 2 - WIDTH
    fell = float(advance / HEIGHT > MAX_ADVANCE)
    expected = float(strength < CRITICAL_STRENGTH)
    return drive.outcome(
        [
            absolute("advance", advance / HEIGHT, 0.0),
            Measured("falls", fell, expected, fell - expected),
        ]
    )


def matrix(full: bool) -> list[CaseSettings]:
    """Return strengths on both sides of the critical one, numbers of layers, and kinds of walls."""
    settings_list: list[CaseSettings] = [
        {"strength": strength, "layers": layers}
        for layers in ((10, 20, 40) if full else (20,))
        for strength in ((0.34, 0.3, 0.28, 0.25) if full else (0.28, 0.25))
    ]
    beside: list[CaseSettings] = [
        {"strength": strength, "layers": 20, "walls": "particles"} for strength in (0.28, 0.25)
    ]
    return settings_list + beside


CASE = Case(
    name="mps_cut",
    title="Vertical cut in snow, as a fluid of particles",
    source="stability number 3.77 to 3.83 of limit analysis (Taylor 1937; Pastor and others 2000)",
    description="""
    A block of snow with cohesion and without friction, 1 m high and 2 m wide, has a free vertical
    face. By limit analysis it stands if the cohesion is more than 0.265 times the density, gravity
    and the height. The advance of the front in 2 s is measured; snow that moved by more than 2 % of
    the height has fallen.
    """,
    quantities=(
        Quantity("advance", "advance of the front over the height", relative=False),
        Quantity(
            "falls", "1 if the snow has fallen", limit=0.0, limit_for={"layers": 20},
            relative=False,
        ),
    ),
    matrix=matrix,
    measure=measure,
)  # fmt: skip
