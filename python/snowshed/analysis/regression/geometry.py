"""The study of section 5.1: the data set of 610 rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import ceil, inf
from typing import Optional, get_args

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.methods.mpm.settings import Scheme
from snowshed.scene.accuracy_settings import ACCURACY
from snowshed.scene.components import Snow
from snowshed.scene.scene import Scene
from snowshed.study.definition import Study
from snowshed.study.factors import SEED, Factor, axis

#: Heights and lengths of the panels at 40 degrees, m, and those of steeper ones.
FLAT_HEIGHTS = (1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)
FLAT_LENGTHS = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 6.0, 8.0, 10.0)
STEEP_HEIGHTS = (2.0, 3.0, 4.0)
STEEP_LENGTHS = (0.5, 1.5, 2.0, 4.0, 8.0)
FLAT_TILT, STEEP_TILTS = 40.0, (50.0, 60.0, 70.0)  # degrees
#: Tilts, heights and lengths whose combinations are the panels.
GRIDS = (
    ((FLAT_TILT,), FLAT_HEIGHTS, FLAT_LENGTHS),
    (STEEP_TILTS, STEEP_HEIGHTS, STEEP_LENGTHS),
)
#: Treatments of the stack between events; each is a separate study.
BETWEEN = ("carry", "reseed")
#: Schemes of the MPM, the thesis's first; each is a separate study.
SCHEMES: tuple[str, ...] = get_args(Scheme)
#: The panel's friction, which the thesis does not print. Of 0.3 to 0.8, which were tried on some of
#: the panels, it gives ratios of height to length nearest to Table 5.3.1.
FRICTION = 0.8
#: Damping rate of PIC, 1/s. It corresponds to the thesis's share of 0.01 in each step, with cells
#: of 1 cm and the calibrated snow in 2D (steps of 0.054 ms; in 3D it would be 211 1/s). The rate
#: holds for cells of any size. Schemes other than the thesis's have a rate of their own.
DAMPING_RATE = 190.0
#: Number of seeds of the shortest panels for each seed of panels up to some length, m. Stacks of
#: short panels scatter most, and long panels take longest. With these shares, one more stack of
#: any panel reduces the scatter of the rows by about as much per computing time.
SHARES: Mapping[float, int] = {1.0: 1, 2.0: 3, 4.0: 6, inf: 16}
DESCRIPTION = "The geometry data set: 122 panels, 5 events each, 610 rows (Tables 5.1.1 and 5.2.1)."


@checked
def geometry_study(
    between: str = "carry",
    *,
    friction: float = FRICTION,
    dx: float = 0.01,
    seeds: int = 1,
    scheme: str = SCHEMES[0],
    settings: Optional[Mapping[str, object]] = None,
    name: str = "",
    trial: bool = False,
) -> Study:
    """Return the study of the geometry data set, Tables 5.1.1 and 5.2.1.

    At 40 degrees 7 heights x 11 lengths x 5 events are 385 rows; 3 tilts x 3 heights x 5 lengths x
    5 events are another 225.

    Parameters
    ----------
    between
        "carry": the stack's particles stay unchanged; "reseed": the stack is filled with new
        particles, as in the thesis.
    friction
        Coulomb coefficient of the panel.
    dx
        Size of the grid cells, m. The trial has its own.
    seeds
        Number of stacks for each panel up to 1 m, with different random seedings. Longer panels
        take more time and scatter less: panels up to 2 m have a third as many, up to 4 m a sixth,
        the others a sixteenth, rounded up.
    scheme
        Scheme of the MPM, "thesis" or "objective".
    settings
        Further values by dotted paths. They override `between`, `dx` and `scheme`.
    name
        Name of the study. [default: from its treatment of the stack, and its scheme]
    trial
        Whether to return a trial: a few panels on a coarse grid, which take seconds; its numbers
        are meaningless.

    Raises
    ------
    InputError
        If `between` or `scheme` is unknown, or the scene has no such setting.

    Examples
    --------
    >>> len(geometry_study("reseed").runs())  # panels
    122
    """
    changes = dict(settings or {})
    if trial and changes:
        raise InputError("settings: the trial has its own; allowed: none")
    between = str(changes.pop("events.between", between))
    scheme = str(changes.pop("numerics.scheme", scheme))
    check_between(between)
    check_scheme(scheme)
    snow = Snow.preset("calibrated").to_data()
    scene = Scene.preset("geometry").update({"snow": snow, "numerics.scheme": scheme})
    if trial:
        return _trial(scene, between, friction, seeds)
    has_rate = scheme == SCHEMES[0] and "numerics.flip_ratio" not in changes
    scene.update(
        {
            "dimension": 2,
            "events.count": 5,
            "events.max_time": 30.0,  # s; 10 m at 40 degrees take 9 s
            "seeding.particles_per_voxel": 4,  # the fewest in 2D (A.3.2)
            "numerics.dx": dx,
            **({"numerics.damping_rate": DAMPING_RATE} if has_rate else {}),
            **changes,
        }
    )
    shown = {"panel.friction": friction, "events.between": between}
    shown.update({path: value for path, value in changes.items() if path not in ACCURACY.values()})
    common = [axis(path, [value]) for path, value in shown.items()]  # which the table shows
    parts = [
        [*common, *_panels(tilts, heights, some), axis(SEED, _seeds(seeds, share))]
        for tilts, heights, lengths in GRIDS
        for share in SHARES.values()
        if (some := [length for length in lengths if _share(length) == share])
    ]
    return Study(scene, parts, name or rows_name(between, scheme), description=DESCRIPTION)


def _trial(scene: Scene, between: str, friction: float, seeds: int) -> Study:
    """Return 9 panels on a coarse grid, 3 events each."""
    scene.update(
        {
            "dimension": 2,
            "events": {"count": 3, "between": between},
            "panel.friction": friction,
            "numerics.dx": 0.05,
        }
    )
    heights = (0.5, 1.0, 1.5)
    parts = [_panels((40.0,), heights, (0.5, 1.0)), _panels((50.0,), heights, (1.0,))]
    return Study(
        scene,
        parts,
        f"geometry-trial-{between}",
        range(1, seeds + 1),
        "A trial of the geometry data set: 9 panels on a coarse grid, 3 events each, 27 rows. "
        "It shows the steps from study to prediction; its numbers are meaningless.",
    )


def _panels(
    tilts: Sequence[float], heights: Sequence[float], lengths: Sequence[float]
) -> list[Factor]:
    return [
        axis("panel.tilt", tilts),
        axis("panel.height", heights),
        axis("panel.length", lengths),
    ]


def check_between(between: str) -> None:
    """Raise an InputError for an unknown treatment between events."""
    if between not in BETWEEN:
        raise InputError(f"between: {between!r} is unknown; allowed: {', '.join(BETWEEN)}")


def check_scheme(scheme: str) -> None:
    """Raise an InputError for an unknown scheme."""
    if scheme not in SCHEMES:
        raise InputError(f"scheme: {scheme!r} is unknown; allowed: {', '.join(SCHEMES)}")


def rows_name(between: str, scheme: str) -> str:
    """Return the name of the study, and of its table; that of the thesis's scheme has no scheme.

    Examples
    --------
    >>> rows_name("carry", "thesis"), rows_name("carry", "objective")
    ('geometry-carry', 'geometry-carry-objective')
    """
    return "-".join(["geometry", between, *([scheme] if scheme != SCHEMES[0] else [])])


def _share(length: float) -> int:
    """Return the number of seeds of a short panel per seed of a panel of this length, m."""
    return next(share for longest, share in SHARES.items() if length <= longest)


def _seeds(count: int, share: int) -> list[int]:
    return list(range(1, ceil(count / share) + 1))
