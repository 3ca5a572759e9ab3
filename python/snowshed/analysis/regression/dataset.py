"""The data set that comes with snowshed: 122 panels, both ways between events, and its model.

``data/README.md`` describes its computation.
"""

from __future__ import annotations

from pathlib import Path

from snowshed.analysis.regression.geometry import check_between
from snowshed.analysis.regression.rows import StackRows, read_rows
from snowshed.base.arguments import checked

FOLDER = Path(__file__).with_name("data")
#: Models of the data set's rows, the default of ``snowshed predict``.
MODEL = FOLDER / "geometry-model.npz"
#: Treatment of the stack between events in the models: the one nearest to Table 5.3.1.
MODEL_BETWEEN = "carry"


@checked
def geometry_table(between: str = MODEL_BETWEEN) -> Path:
    """Return the file of the computed rows, a CSV table as ``snowshed study export`` writes it.

    Parameters
    ----------
    between
        "carry" or "reseed", as for `geometry_study`.

    Examples
    --------
    >>> geometry_table("carry").name
    'geometry-carry.csv'
    """
    check_between(between)
    return FOLDER / f"geometry-{between}.csv"


@checked
def geometry_rows(between: str = MODEL_BETWEEN, measure: str = "stack") -> StackRows:
    """Return the computed rows.

    Parameters
    ----------
    between, measure
        As for `geometry_study` and `read_rows`.

    Examples
    --------
    >>> rows = geometry_rows()
    >>> len(rows), rows.inputs[-1].tolist()  # event, panel's height, length and tilt
    (610, [5.0, 4.0, 8.0, 70.0])
    """
    return read_rows(geometry_table(between), measure)
