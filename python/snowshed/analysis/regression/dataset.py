"""The data set that comes with snowshed: stacks below 122 panels, and models of them.

``data/README.md`` describes its computation.
"""

from __future__ import annotations

from pathlib import Path

from snowshed._core import InputError
from snowshed.analysis.regression.geometry import SCHEMES, check_between, check_scheme, rows_name
from snowshed.analysis.regression.rows import StackRows, read_rows
from snowshed.base.arguments import checked

FOLDER = Path(__file__).with_name("data")
#: Treatment of the stack between events in the models: the one nearest to Table 5.3.1.
MODEL_BETWEEN = "carry"


@checked
def geometry_table(between: str = MODEL_BETWEEN, scheme: str = SCHEMES[0]) -> Path:
    """Return the file of the computed rows, a CSV table as ``snowshed study export`` writes it.

    Parameters
    ----------
    between, scheme
        As for `geometry_study`. The rows of "reseed" were computed with the scheme "thesis" only.

    Raises
    ------
    InputError
        If there are no such rows.

    Examples
    --------
    >>> geometry_table("carry").name
    'geometry-carry.csv'
    >>> geometry_table("carry", "objective").name
    'geometry-carry-objective.csv'
    """
    check_between(between)
    check_scheme(scheme)
    if between != MODEL_BETWEEN and scheme != SCHEMES[0]:
        raise InputError(
            f"scheme: the rows of {between} were computed with the scheme {SCHEMES[0]} only"
        )
    return FOLDER / f"{rows_name(between, scheme)}.csv"


@checked
def geometry_rows(
    between: str = MODEL_BETWEEN, measure: str = "stack", scheme: str = SCHEMES[0]
) -> StackRows:
    """Return the computed rows.

    Parameters
    ----------
    between, scheme
        As for `geometry_table`.
    measure
        As for `read_rows`.

    Examples
    --------
    >>> rows = geometry_rows()
    >>> len(rows), rows.inputs[-1].tolist()  # event, panel's height, length and tilt
    (610, [5.0, 4.0, 8.0, 70.0])
    """
    return read_rows(geometry_table(between, scheme), measure)


def model_file(scheme: str = SCHEMES[0]) -> Path:
    """Return the file with the models of the rows of a scheme, the default of ``predict``.

    Raises
    ------
    InputError
        If the scheme is unknown.
    """
    return geometry_table(scheme=scheme).with_suffix(".npz")
