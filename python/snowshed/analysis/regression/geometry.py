"""The study of section 5.1: the data set of 610 rows, as files for ``snowshed study``."""

from __future__ import annotations

from math import ceil

from snowshed._core import InputError
from snowshed.io.formatting import exact
from snowshed.study.template import filled

#: How snow goes from one event to the next; each is a study of its own.
BETWEEN = ("carry", "reseed")
#: The panel's friction, which the thesis does not print. Of 0.3 to 0.8, which were tried on some of
#: the panels, it gives ratios of height to length nearest to Table 5.3.1.
FRICTION = 0.8
#: Panels up to 1 m have all seeds; those up to 2 m one for so many, up to 4 m, and beyond. What one
#: more stack takes from the scatter of the rows for its time asks for about as many.
TO_2_M, TO_4_M, BEYOND = 3, 6, 16


def geometry_study(
    between: str = "carry",
    *,
    friction: float = FRICTION,
    dx: float = 0.01,
    seeds: int = 1,
    trial: bool = False,
) -> str:
    """Return the study file of the geometry data set, Tables 5.1.1 and 5.2.1.

    At 40 degrees 7 heights x 11 lengths x 5 events are 385 rows; 3 tilts x 3 heights x 5 lengths x
    5 events are another 225.

    Parameters
    ----------
    between
        "carry": the stack's particles stay as they are; "reseed": the stack is filled anew, as the
        thesis does.
    friction
        Coulomb coefficient of the panel.
    dx
        Size of the grid cells, m. The trial has its own.
    seeds
        How many stacks for each panel up to 1 m; they differ in the chance placement of the
        particles. Longer panels take more time and scatter less: those up to 2 m have a third as
        many, up to 4 m a sixth, the others a sixteenth, rounded up.
    trial
        A few panels on a coarse grid, which take seconds, to try the way from study to prediction;
        its numbers mean nothing.

    Examples
    --------
    >>> geometry_study("reseed").splitlines()[0]
    '# The geometry data set: 122 panels, 5 events each, 610 rows (Tables 5.1.1 and 5.2.1).'
    """
    check_between(between)
    values = {
        "between": between,
        "friction": exact(friction),
        "dx": exact(dx),
        "seeds_to_1_m": _seeds(seeds),
        "seeds_to_2_m": _seeds(ceil(seeds / TO_2_M)),
        "seeds_to_4_m": _seeds(ceil(seeds / TO_4_M)),
        "seeds_beyond": _seeds(ceil(seeds / BEYOND)),
    }
    return filled("snowshed.analysis.regression", "geometry-trial" if trial else "geometry", values)


def check_between(between: str) -> None:
    """Raise an InputError unless there is such a way between events."""
    if between not in BETWEEN:
        raise InputError(f"between: {between!r} is unknown; allowed: {', '.join(BETWEEN)}")


def _seeds(count: int) -> str:
    """Return the first seeds as a list of TOML."""
    return str(list(range(1, count + 1)))
