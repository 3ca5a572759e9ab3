"""The way between events: particles carried over, against the stack reseeded as a solid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from snowshed.verify.case import Case, Measured, Outcome, Quantity, Settings
from snowshed.verify.driving import absolute, relative
from snowshed.verify.lab_stack import LabRun, outcome_of, recorded, run_seedings

#: Seeds begin here, so that none is one of the reference's.
FIRST_SEED = 101

BASE: Settings = {"dimension": 2, "dx": 0.01, "events": 5, "seedings": 4, "seed": FIRST_SEED}


def matrix(full: bool) -> list[Settings]:
    """Return the settings to solve with."""
    if full:
        grids: list[Settings] = [{**BASE, "dx": dx} for dx in (0.02, 0.01, 0.005)]
        grids.append({**BASE, "dimension": 3, "dx": 0.02})
    else:
        grids = [{**BASE, "dx": 0.02, "events": 3, "seedings": 3}, {**BASE, "events": 2}]
    return [{**grid, "between": between} for grid in grids for between in ("carry", "reseed")]


def measure(settings: Settings) -> Outcome:
    """Run every seeding; compare the conversions' two sides, and the last stacks with the noise."""
    runs = run_seedings(settings)
    measured = [_mass(runs)]
    rows = _conversions(runs)
    if rows:
        dx = float(settings["dx"])
        measured += [_moved_most(name, rows, dx) for name in ("height", "length")]
        outline = max(float(row["outline_rms_m"]) for row in rows) / dx
        measured.append(absolute("conversion_outline", outline, 0.0))
        measured.append(relative("conversion_space", _space(runs), 1.0))
    for name in ("height", "length"):
        measured += _against_carried(name, runs, settings)
    return outcome_of(runs, measured)


def _conversions(runs: Sequence[LabRun]) -> list[dict[str, Any]]:
    return [row for run in runs for row in run.conversions]


def _space(runs: Sequence[LabRun]) -> float:
    """Return the space that stacks fill after their last conversion over their snow's volume.

    A solid is seeded as densely as a slab. The more of it was void, the less mass is left for each
    particle.
    """
    rows = [run.conversions[-1] for run in runs]
    full = [row["particles_after"] * run.particle_mass for row, run in zip(rows, runs)]
    return float(np.mean([mass / row["mass_after_kg"] for mass, row in zip(full, rows)]))


def _mass(runs: Sequence[LabRun]) -> Measured:
    """Return the worst of all masses that should be equal: at conversions and at the end."""
    pairs = [(run.mass, run.brought_mass) for run in runs]
    pairs += [(row["mass_after_kg"], row["mass_before_kg"]) for row in _conversions(runs)]
    value, exact = max(pairs, key=lambda pair: abs(pair[0] / pair[1] - 1))
    return relative("mass", value, exact)


def _moved_most(name: str, rows: Sequence[Mapping[str, Any]], dx: float) -> Measured:
    """Return a measure after and before the conversion that changed it most, in cells."""
    before, after = f"{name}_before_m", f"{name}_after_m"
    worst = max(rows, key=lambda row: abs(float(row[after]) - float(row[before])))
    value, exact = float(worst[after]) / dx, float(worst[before]) / dx
    return absolute(f"conversion_{name}", value, exact)


def _against_carried(name: str, runs: Sequence[LabRun], settings: Settings) -> list[Measured]:
    """Compare the mean of the last stacks with the recorded ones, whose snow was carried over."""
    carried = recorded(int(settings["dimension"]), float(settings["dx"]))
    event = int(settings["events"])
    exact, spread = carried.mean(name, event), carried.spread(name, event)
    value = float(np.mean([run.series(name)[-1] for run in runs]))
    noise = (value - exact) / spread
    return [relative(name, value, exact), absolute(f"{name}_noise", noise, 0.0)]


DESCRIPTION = """
Between two slabs the snow either goes on as it is (carry) or is turned into a solid and filled with
new particles at rest (reseed, the thesis's way). Mass must be the same to round-off, with either.
For reseeding, height, length and outline of the stack just before and just after each conversion
should be the same; the worst conversion is shown, in grid cells. The space that the stack fills
after the last conversion is compared with the volume of its snow at the initial density: what is
more than 1 is void that has become snow.

The last stacks, means over the seedings, are compared with the mean of the recorded runs on the
same grid, whose snow was carried over, as a part of it and in standard deviations between single
seedings. For carried stacks, of other seeds than the recorded ones, this is noise: the mean of four
departs by half a deviation on average.
"""

REMARKS = """
A conversion does not move the stack's surface: heights stay within a third of a cell, outlines
within one cell. What it changes is inside. Gaps between layers, hollows under folds and loose
debris become part of the solid, which is then filled evenly. The mass stays, so at dx 0.01 m the
stack before the fifth slab fills 1.7 times the volume of its snow, as if it were foam of 120 kg/m3
that is as strong as snow of 210 kg/m3. Nothing can close these voids any more, and the bonds are
whole again, so reseeded stacks become higher: by 103 % at dx 0.02 m, 34 % at 0.01 m and 14 % at
0.005 m in the plane, 88 % at 0.02 m in space; 7, 2.2, 1.8 and 16 standard deviations. The coarser
the grid, the larger the voids.

The measured length can jump by many cells in one conversion (20 at dx 0.005 m, 10 cm). That is not
the stack's main body. Grains and chunks with less snow than about half a voxel vanish when they
become a solid, and their mass, up to 1 % of all, is spread over the rest. The length by the 3 %
rule hangs on them: 3 % is about the mass of what has rolled away.

Stacks carried over have none of this. Reseed only to compare with results that were made so.
"""

CASE = Case(
    name="between_events",
    title="Between events: carried over or reseeded",
    source=(
        "Conservation of mass; the stack before the conversion (thesis, A.3.2); stacks carried "
        "over, recorded in lab_stack.json"
    ),
    description=DESCRIPTION,
    quantities=[
        # Masses are single precision.
        Quantity("mass", "Mass of all snow, kg", bar=1e-6),
        Quantity(
            "conversion_height",
            "Height after a conversion, cells",
            bar=0.5,
            relative=False,
        ),
        Quantity("conversion_length", "Length after a conversion, cells", relative=False),
        Quantity(
            "conversion_outline",
            "Outline moved by a conversion, root mean square, cells",
            relative=False,
        ),
        Quantity("conversion_space", "Space filled after a conversion over the snow's volume"),
        Quantity("height", "Height of the last stack, m"),
        Quantity("height_noise", "Its departure in standard deviations", relative=False),
        Quantity("length", "Length of the last stack, m"),
        Quantity("length_noise", "Its departure in standard deviations", relative=False),
    ],
    matrix=matrix,
    measure=measure,
    remarks=REMARKS,
)
