"""Which settings say how a problem is solved; all others make another problem.

An accuracy may be bought with a better scheme, not with an easier problem, so only ways of solving
the same problem are compared with each other.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from snowshed.scene.accuracy_settings import ACCURACY

if TYPE_CHECKING:
    from snowshed.analysis.verification.case import Case, Settings

#: Settings that make no other way of solving, only another sample of it.
SAMPLING = ("seed", "seedings")


def problem_of(case: Case, settings: Settings) -> Settings:
    """Return the settings that make the problem.

    Examples
    --------
    >>> from validation.suite import load_cases
    >>> case = load_cases(["panel_edge"])[0]
    >>> problem_of(case, {"dx": 0.01, "transfer": "apic", "friction": 0.3})
    {'friction': 0.3}
    """
    sizes = {quantity.order_in for quantity in case.quantities}
    ways = {*ACCURACY, *SAMPLING, *sizes}
    return {name: value for name, value in settings.items() if name not in ways}
