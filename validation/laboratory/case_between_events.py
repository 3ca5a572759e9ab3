"""Transition between events: stacks that are carried over, and stacks reseeded as a solid."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import absolute, relative
from validation.laboratory.lab_records import NO_SLEEP, noise, recorded
from validation.laboratory.lab_stack import (
    COMPARED,
    Conversion,
    LabRun,
    outcome_of,
    run_seedings,
)

#: First seed, above all seeds of the reference.
FIRST_SEED = 101

BASE: CaseSettings = {
    **NO_SLEEP,  # as in the recorded runs
    "dimension": 2,
    "dx": 0.01,
    "events": 5,
    "seedings": 4,
    "seed": FIRST_SEED,
}


def matrix(full: bool) -> list[CaseSettings]:
    """Return grids with both treatments; if full, more grids and events, and one grid in space."""
    if full:
        grids: list[CaseSettings] = [{**BASE, "dx": dx} for dx in (0.02, 0.01, 0.005)]
        grids.append({**BASE, "dimension": 3, "dx": 0.02})
    else:
        grids = [{**BASE, "dx": 0.02, "events": 3, "seedings": 3}, {**BASE, "events": 2}]
    return [{**grid, "between": between} for grid in grids for between in ("carry", "reseed")]


def measure(settings: CaseSettings) -> Outcome:
    """Run every seeding; compare stacks before and after conversions, and with recorded stacks."""
    runs = run_seedings(settings)
    measured = [_mass(runs)]
    conversions = _conversions(runs)
    if conversions:
        dx = float(settings["dx"])
        changes = {
            name: [conversion.change(name) / dx for conversion in conversions] for name in COMPARED
        }
        measured += [_largest(f"conversion_{name}", changes[name]) for name in COMPARED]
        measured += [
            _largest("conversion_loose", (conversion.loose_change for conversion in conversions)),
            _largest(
                "conversion_outline", (conversion.outline_moved / dx for conversion in conversions)
            ),
            relative("conversion_space", _space(runs), 1.0),
        ]
    for name in ("height", "length"):
        measured += [_against_carried(name, runs, settings), noise(name, runs, settings)]
    return outcome_of(runs, measured)


def _conversions(runs: Sequence[LabRun]) -> list[Conversion]:
    return [conversion for run in runs for conversion in run.conversions]


def _largest(name: str, changes: Iterable[float]) -> Measured:
    """Return the largest change as a measured value whose exact value is zero."""
    return absolute(name, max(changes, key=abs), 0.0)


def _space(runs: Sequence[LabRun]) -> float:
    """Return the mean volume of stacks after their last conversion, over the volume of their snow.

    A solid is seeded as densely as a slab. The larger its former voids, the smaller the mass of
    each particle.
    """
    last = [(run.particle_mass, run.conversions[-1]) for run in runs]
    return float(
        np.mean(
            [mass * conversion.particles_after / conversion.mass_after for mass, conversion in last]
        )
    )


def _mass(runs: Sequence[LabRun]) -> Measured:
    """Return the mass with the largest error, among those after conversions and at the end."""
    pairs = [(run.mass, run.brought_mass) for run in runs]
    pairs += [(conversion.mass_after, conversion.mass_before) for conversion in _conversions(runs)]
    value, exact = max(pairs, key=lambda pair: abs(pair[0] / pair[1] - 1))
    return relative("mass", value, exact)


def _against_carried(name: str, runs: Sequence[LabRun], settings: CaseSettings) -> Measured:
    """Compare the mean of the last stacks with the recorded ones, whose snow was carried over."""
    carried = recorded(int(settings["dimension"]), float(settings["dx"]))
    value = float(np.mean([run.series(name)[-1] for run in runs]))
    return relative(name, value, carried.mean(name, int(settings["events"])))


DESCRIPTION = """
Between two slabs the stack is either kept as it is (carry), or converted to a solid and reseeded at
rest (reseed, as in the thesis). Both must conserve mass to round-off.

For reseeding, the stack just before and just after each conversion is compared: its height and
length by the rule that leaves out the outermost 3 % of the mass; height and length of the largest
connected body; the outline (root mean square of its change in height); and the share of the snow
outside the largest body. The largest change in any conversion is shown; lengths are in grid cells.
The volume of the stack after the last conversion is compared with the volume of its snow at the
initial density. The excess over 1 consists of voids that have become snow. Only the height of the
largest body has a limit: half a cell, because the solid is made of cubes of a cell's size. Lengths
have no limit, because they depend on single grains (see "Where the method is poor").

The mean of the last stacks over the seedings is compared with the mean of the recorded runs on the
same grid, whose snow was carried over. The deviation is relative to that mean, and in standard
deviations between single recorded runs. None of these stacks sleep. Carried stacks have other seeds
than the recorded ones, so their deviation is noise: the mean of four stacks deviates by half a
standard deviation on average.
"""

REMARKS = """
A conversion hardly moves the stack's surface: heights stay within a quarter of a cell, outlines
within one cell. It changes the interior. Gaps between layers, hollows under folds and loose debris
become part of the solid, which is then filled evenly. The mass stays the same. Before the fifth
slab the stack fills 2.3, 1.8 and 1.5 times the volume of its snow at dx 0.02, 0.01 and 0.005 m in
the plane, and 2.5 times at 0.02 m in space. At 0.01 m it behaves like foam of 120 kg/m3 that is as
strong as snow of 210 kg/m3. These voids can no longer close, and all bonds are whole again, so
reseeded stacks become higher: by 90 % at dx 0.02 m, 30 % at 0.01 m and 8 % at 0.005 m in the plane,
and by 92 % at 0.02 m in space, that is by 6, 1.9, 1.0 and 16 standard deviations. Coarser grids
have larger voids.

Separate grains, too small for the grid, become balls about half a cell in radius in the solid. The
ends of the snow therefore stay in place, but the mass there changes slightly: the measured length,
which leaves out 3 % of the mass, changes by up to three cells in one conversion. The largest body
changes more. If a thin trail of grains joins two parts, a conversion may interrupt the trail, so
that one of the parts no longer counts. A conversion may also fill a gap and so join two bodies. The
body became longer by up to 8.5 cells at dx 0.01 m. Up to 6 % of the snow joined or left the largest
body in this way in the plane, 2 % in space.

Stacks that are carried over show none of these effects. Use reseeding only for comparisons with
reseeded results.
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
        Quantity("mass", "Mass of all snow, kg", limit=1e-6),
        Quantity("conversion_height", "Change of height by a conversion, cells", relative=False),
        # The solid is made of cubes of a cell's size, cut at half their filling.
        Quantity(
            "conversion_body_height",
            "Change of the largest body's height, cells",
            limit=0.5,
            relative=False,
        ),
        Quantity("conversion_length", "Change of length by a conversion, cells", relative=False),
        Quantity(
            "conversion_body_length", "Change of the largest body's length, cells", relative=False
        ),
        Quantity(
            "conversion_loose",
            "Change of the part of snow outside the largest body",
            relative=False,
        ),
        Quantity(
            "conversion_outline",
            "Shift of the outline by a conversion, cells",
            relative=False,
        ),
        Quantity("conversion_space", "Space filled after a conversion over the snow's volume"),
        Quantity("height", "Height of the last stack, m"),
        Quantity("height_noise", "Its height, departure in standard deviations", relative=False),
        Quantity("length", "Length of the last stack, m"),
        Quantity("length_noise", "Its length, departure in standard deviations", relative=False),
    ],
    matrix=matrix,
    measure=measure,
    remarks=REMARKS,
)
