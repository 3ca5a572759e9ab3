"""Height and length of the stack, in dependence on grid, scheme, seeding and dimension."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from snowshed.snow.accuracy.mechanisms import scheme_of
from validation.framework.case import Case, Outcome, Quantity, SettingsFilter
from validation.framework.drive import relative
from validation.laboratory.lab_records import noise, recorded
from validation.laboratory.lab_stack import COMPARED, StackRun, outcome_of, run_seedings

#: Ratio of stack heights in 3D and 2D if height and width are similar (thesis, 5.1.1).
RULE_OF_THUMB = 2 / 3

BASE: CaseSettings = {"dimension": 2, "dx": 0.01, "transfer": "flip", "events": 5, "seedings": 4}

#: Grids in the plane, with the seeds of the recorded runs.
GRIDS: Sequence[CaseSettings] = (
    {"dx": 0.02, "seedings": 12},
    {"dx": 0.01, "seedings": 12},
    {"dx": 0.005, "seedings": 6},
)
#: Affordable grids in space, with the seeds of the recorded runs.
GRIDS_3D: Sequence[CaseSettings] = (
    {"dimension": 3, "dx": 0.02, "seedings": 8},
    {"dimension": 3, "dx": 0.01, "seedings": 1},
)

#: Grids of the scheme objective, with the seeds of its recorded runs.
OBJECTIVE: CaseSettings = {"scheme": "objective", "dimension": 2}
OBJECTIVE_GRIDS: Sequence[CaseSettings] = (
    {**OBJECTIVE, "dx": 0.02, "seedings": 12},
    {**OBJECTIVE, "dx": 0.01, "seedings": 12},
    {**OBJECTIVE, "dx": 0.005, "seedings": 12},
    {**OBJECTIVE, "dimension": 3, "dx": 0.02, "seedings": 8},
    {**OBJECTIVE, "dimension": 3, "dx": 0.01, "seedings": 4},
)

#: Variants of the default scheme, on the grid of the laboratory's stacks.
SCHEMES: Sequence[CaseSettings] = (
    {"transfer": "apic"},
    {"flip_ratio": 0.95},
    {"flip_ratio": 0.999},
    {"basis": "cubic"},
    {"precision": "double"},
    {"particles_per_voxel": 4},
    {"particles_per_voxel": 12},
    {"courant_factor": 0.3},
    # The same share of PIC per second as 0.99 at three times the step: 0.99^(1/3).
    {"courant_factor": 0.3, "flip_ratio": 0.9967},
    {"courant_factor": 0.3, "transfer": "apic"},
)

#: Settings of the recorded runs of each scheme; None: the setting must not be given.
AS_RECORDED: SettingsFilter = {
    "transfer": ("flip", None),
    "flip_ratio": None,
    "basis": None,
    "precision": None,
    "particles_per_voxel": None,
    "courant_factor": None,
}
#: Largest difference between the means of new and recorded stacks, in standard deviations.
MAX_NOISE = 3.0

#: Speeds below which snow may sleep, m/s; 0: snow never sleeps.
SLEEP_SPEEDS = (0.0, 0.002, 0.005, 0.02)
#: Stacks that are made with each of these speeds.
SLEEPERS: Sequence[CaseSettings] = (
    {"seedings": 12},
    {"seedings": 12, "transfer": "apic"},
    {"seedings": 12, "transfer": "apic", "events": 1},
    {"dimension": 3, "dx": 0.02, "seedings": 8},
)


def matrix(full: bool) -> list[CaseSettings]:
    """Return grids and schemes; if full, more of them, and several speeds of sleep."""
    if not full:
        quick = {**BASE, "events": 2, "seedings": 2}
        return [
            {**quick, "dx": 0.02},
            {**quick, "dx": 0.02, "sleep_speed": 0.0},
            {**quick, "dx": 0.01},
            {**quick, "dx": 0.02, "transfer": "apic"},
            {**quick, "dimension": 3, "dx": 0.02, "events": 1},
            {**OBJECTIVE, "dx": 0.02, "events": 2, "seedings": 2},
        ]
    grids: list[CaseSettings] = [
        {**BASE, **grid, "events": events}
        for events in (1, 2, 3, 5)
        for grid in (*GRIDS, *GRIDS_3D)
    ]
    affine: list[CaseSettings] = [
        {**entry, "transfer": "apic"} for entry in grids if entry["dimension"] == 2
    ]
    awake: list[CaseSettings] = [
        {**BASE, **grid, "sleep_speed": 0.0} for grid in (*GRIDS, *GRIDS_3D)
    ]
    sleeping: list[CaseSettings] = [
        {**BASE, **sleeper, "sleep_speed": speed} for sleeper in SLEEPERS for speed in SLEEP_SPEEDS
    ]
    schemes: list[CaseSettings] = [{**BASE, **scheme} for scheme in SCHEMES]
    objective: list[CaseSettings] = [
        {**grid, "events": events}
        for events in (1, 2, 3, 5)
        for grid in OBJECTIVE_GRIDS
        if grid["dimension"] == 2 or events <= 2  # the reference in space has two events
    ]
    return [*grids, *affine, *schemes, *awake, *sleeping, *objective]


def measure(settings: CaseSettings) -> Outcome:
    """Run every seeding and compare the stacks after the last event with the reference."""
    return compared(run_seedings(settings), settings)


def compared(runs: Sequence[StackRun], settings: CaseSettings) -> Outcome:
    """Compare the last stacks of runs, one for each seeding, with the reference of their scheme."""
    measured = [_against_reference(name, runs, settings) for name in COMPARED]
    if len(runs) > 1:
        measured += [_spread(name, runs) for name in ("height", "length")]
    measured += [noise(name, runs, settings) for name in ("height", "length")]
    if int(settings["dimension"]) == 3:
        plane = recorded(2, float(settings["dx"]), scheme_of(settings))
        flat = plane.mean("height", int(settings["events"]))
        measured.append(
            relative("height_over_2d", float(_last("height", runs).mean()) / flat, RULE_OF_THUMB)
        )
    return outcome_of(runs, measured)


def _last(name: str, runs: Sequence[StackRun]) -> np.ndarray:
    return np.array([run.series(name)[-1] for run in runs])


def _against_reference(name: str, runs: Sequence[StackRun], settings: CaseSettings) -> Measured:
    """Return the mean over seedings, and the root-mean-square error of a single run.

    Both the exact value and the error are NaN after an event that the reference does not have.
    """
    reference = recorded(int(settings["dimension"]), scheme=scheme_of(settings))
    exact = reference.mean(name, int(settings["events"]))
    values = _last(name, runs)
    error = float(np.sqrt(np.mean((values / exact - 1) ** 2)))
    return Measured(name, float(values.mean()), exact, error)


def _spread(name: str, runs: Sequence[StackRun]) -> Measured:
    values = _last(name, runs)
    spread = float(values.std(ddof=1) / values.mean())
    return Measured(f"{name}_spread", spread, 0.0, spread)


DESCRIPTION = """
The laboratory scene (preset lab-50, panel friction 0.3): one to five slabs, 2 cm thick, slide off a
panel at 50 degrees onto each other. Height and length of the stack are measured after the last
slab, once by the rule that leaves out the outermost 3 % of the mass, and once for the largest
connected body.

There is no exact answer. Each scheme has a reference of its own, the mean of recorded runs on the
finest grid. The grid of the scheme thesis is dx 0.0025 m with four seedings in the plane, and 0.005
m with one seeding in space. These runs were made with the default settings, except that sleep was
off. The grid of the scheme objective is dx 0.0025 m with eight seedings in the plane, and 0.005 m
with four seedings in space (one and two slabs). Its snow could sleep, as by default. Both were made
once and are kept in lab_stack.json, together with runs on coarser grids. The error is that of a
single run: the root mean square, over the random seedings, of its relative deviation from the
reference. The spread is the standard deviation between the seedings, relative to their mean. The
deviation from the recorded runs on the same grid compares the mean of the seedings with the mean of
the recorded ones, in standard deviations between single recorded runs. It shows whether a scheme,
or sleep, changes the stack by more than another seeding does. The time is the mean of one run.
"""

REMARKS = """
The height of a stack does not converge on any affordable grid. After one, two, three, four and five
slabs it is 0.048, 0.070, 0.109, 0.141, 0.136 m at dx 0.01 m, 0.039, 0.063, 0.087, 0.112, 0.134 m at
0.005 m and 0.030, 0.057, 0.077, 0.091, 0.106 m at 0.0025 m (2D, means of 12, 6 and 4 seedings). It
still falls by 10 to 22 % from 0.005 to 0.0025 m, so the error of the reference itself is about as
large, and the fall is too irregular to be extrapolated. At dx 0.01 m, two cells to the slab,
heights are 22 to 58 % too large. Pictures of the particles show the cause: every layer of snow
rests on the ground or on other snow with a gap of one to one and a half cells, and folds of the
slab bridge hollows. On finer grids these folds break and fill the hollows. At dx 0.02 m, one cell
to the slab, heights are 43 to 97 % too large. From there the error does not even fall steadily.

Lengths depend less on the grid: 0.217, 0.292, 0.329, 0.361, 0.424 m at dx 0.01 m and 0.258, 0.322,
0.345, 0.369, 0.397 m at 0.0025 m, a difference of 2 to 16 % that is largest after the first slab.

In space the runs at dx 0.01 m are 32, 27, 29 and 9 % higher than the single one at 0.005 m after
one to four slabs, and 24 % lower after five, because at 0.01 m the pile gives way under the fifth
slab and at 0.005 m it does not. Lengths are 2 to 9 % larger.

The damping of FLIP is the second large error. The share of PIC, 1 - flip_ratio, is taken in every
step, so the damping per second depends on the time step. At dx 0.01 m after five slabs a flip_ratio
of 0.95, 0.99 or 0.999 gives heights of 0.20, 0.14 and 0.11 m, and lengths of 0.31, 0.41 and 0.72 m.
A third of the time step (courant_factor 0.3) has almost the effect of 0.95: 0.20 and 0.33 m. If
flip_ratio is raised to 0.9967 as well, which is the same share per second, the stack does not
change. APIC is less sensitive: 0.14 and 0.44 m, and with a third of the step 0.15 and 0.39 m.
Stacks can be compared only at equal flip_ratio and equal time step.

Random seeding moves the height by 2 to 5 % and the length by 2 to 11 % (one standard deviation, 2D)
after one to four slabs. After the fifth slab, under which a 2D pile may or may not give way, it
moves the height by 8 to 16 % and the length by 3 to 8 %. In space piles give way more evenly: 0.5
to 4 % in height and about 1 % in length at dx 0.01 m. A difference of less than two standard
deviations between two single runs means nothing. Neither precision nor basis nor the number of
particles per voxel changes the stack by more than the noise.

Snow that is slower than sleep_speed may sleep: time steps then leave it out. The savings and the
changes depend on this speed. The same seeds with sleep and without were compared, five slabs in the
plane at dx 0.01 m (12 seeds). At 2 mm/s sleep saved 30 % of the time, at 5 mm/s 38 % and at 20
mm/s, the default, 56 %. Up to 5 mm/s mean height and length changed by 0.6 % at most. At 20 mm/s
the height grew by 5 % and the length fell by 3 %, a third and two fifths of a standard deviation
between seedings. APIC's snow creeps more: 11 % and 7 % at 20 mm/s (0.7 and 1 standard deviations),
4 % and 2 % at 5 mm/s; a first stack stays the same to 0.5 %. In space at dx 0.01 m one stack became
1.5 % lower and 0.9 % shorter and took half of the time. At dx 0.02 m, one cell to the slab, stacks
in space became 8 % higher and 3 % shorter at 20 mm/s, which is more than the effect of another
seeding. At 5 mm/s they did not change, but only 8 % of the time was saved.

3D stacks at dx 0.01 m are as high as 2D ones after up to three slabs (ratio 1.03, 1.02, 1.03), then
0.88 and 0.74. The rule of thumb of two thirds holds for piles that are about as high as wide, and
therefore give way sideways.

Heights of the scheme objective are nearer to those of its finest grid than with thesis, but they do
not converge either. Its heights after one to five slabs in the plane are 0.045, 0.068, 0.082,
0.089, 0.092 m at dx 0.02 m, 0.051, 0.061, 0.071, 0.081, 0.098 m at 0.01 m, 0.043, 0.057, 0.074,
0.092, 0.109 m at 0.005 m and 0.038, 0.055, 0.078, 0.102, 0.115 m at 0.0025 m (means of 12, 12, 12
and 8 seedings). At dx 0.01 m the first height is 35 % too large, and the later ones are wrong by
+11, -10, -20 and -15 %; with thesis it is +57 % and then +23, +42, +54 and +28 %. At 0.005 m it is
+15 % and then +4, -6, -10 and -5 %, with thesis +27 % and then +11, +13, +23 and +27 %. The first
height still falls by 13 % from 0.005 to 0.0025 m, so its limit is lower than the reference. The
later ones differ from the reference by less than two standard errors of the difference, because the
standard errors of the reference alone are 2 to 6 % of its means. Lengths differ by at most 11 % at
0.01 m and 7 % at 0.005 m.

Stacks of the scheme objective scatter more: on the finest grid by 12, 4, 15, 16 and 15 % in height
and 1, 2, 11, 11 and 13 % in length (one standard deviation), with thesis by 2 to 9 % in both. At dx
0.02 m, one cell to the slab, the first slab of one in twelve seedings remained standing, 0.11 m
high. The schemes do not tend to the same first stack: at 0.0025 m it is 0.038 m high with objective
and 0.030 m with thesis. After five slabs it is 0.115 and 0.106 m, which is within the noise.

In space the runs of the scheme objective have two slabs. The stack is 0.036 and 0.065 m high at dx
0.02 m, 0.052 and 0.059 m at 0.01 m and 0.052 and 0.068 m at 0.005 m (means of 8, 4 and 4 seedings):
32 and 4 % too low at 0.02 m and 1 and 13 % too low at 0.01 m, where it is 32 and 27 % too high with
thesis. The error of the first stack changes its sign between these grids, so its small value at
0.01 m is no evidence of accuracy. Single runs scatter by 1 % in height at 0.01 m. The error after
three and more slabs is unknown.

The length by the 3 % rule includes chunks that roll metres away, and grains that are more than two
or three cells from their neighbours and no longer act on them (numerical fracture). The largest
body contains neither.
"""

CASE = Case(
    name="stack_convergence",
    title="The stack itself",
    source=(
        "Self-convergence of the laboratory scene (thesis, Tables 2.3.1 and 4.1.1); the ratio of "
        "3D to 2D is compared with the rule of thumb of two thirds (thesis, 5.1.1)"
    ),
    description=DESCRIPTION,
    quantities=[
        Quantity("height", "Height of the last stack, m", order_in="dx"),
        Quantity("length", "Length of the last stack, m", order_in="dx"),
        Quantity("body_height", "Height of its largest body, m", order_in="dx"),
        Quantity("body_length", "Length of its largest body, m", order_in="dx"),
        Quantity("height_spread", "Height, spread between seedings over mean", relative=False),
        Quantity("length_spread", "Length, spread between seedings over mean", relative=False),
        Quantity(
            "height_noise",
            "Height less that of recorded runs, standard deviations",
            limit=MAX_NOISE,
            limit_for=AS_RECORDED,
            relative=False,
        ),
        Quantity(
            "length_noise",
            "Length less that of recorded runs, standard deviations",
            limit=MAX_NOISE,
            limit_for=AS_RECORDED,
            relative=False,
        ),
        Quantity("height_over_2d", "Height in 3D over height in 2D on the same grid"),
    ],
    matrix=matrix,
    measure=measure,
    remarks=REMARKS,
)
