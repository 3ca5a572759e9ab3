"""Settings of the method, by which a problem is solved; all other settings define the problem.

Only solutions of the same problem are compared with each other, because a smaller error of an
easier problem does not show a better scheme.
"""

from __future__ import annotations

from collections.abc import Iterable

from snowshed.scene.accuracy_settings import ACCURACY
from snowshed.snow.accuracy.measurements import CaseSettings
from snowshed.snow.accuracy.solutions import SEEDING_SETTINGS
from validation.framework.case import Case


def problem_of(case: Case, settings: CaseSettings) -> CaseSettings:
    """Return the settings that define the problem.

    Examples
    --------
    >>> from validation.framework.cases import load_cases
    >>> case = load_cases(["panel_edge"])[0]
    >>> problem_of(case, {"dx": 0.01, "transfer": "apic", "friction": 0.3})
    {'friction': 0.3}
    """
    sizes = {quantity.order_in for quantity in case.quantities}
    solution_settings = {*ACCURACY, *SEEDING_SETTINGS, *sizes}
    return {name: value for name, value in settings.items() if name not in solution_settings}


def varying(settings: Iterable[CaseSettings]) -> list[str]:
    """Return the names of settings in which some choices differ, in order of appearance.

    Examples
    --------
    >>> varying([{"dx": 0.1, "basis": "cubic"}, {"dx": 0.2, "basis": "cubic"}])
    ['dx']
    """
    settings_list = list(settings)
    names = dict.fromkeys(name for settings in settings_list for name in settings)
    return [name for name in names if len({settings.get(name) for settings in settings_list}) > 1]
