"""The `attrs` of study tables: units of the columns, version and build of snowshed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Union

from snowshed.base.units import unit_of_column
from snowshed.io.run_files import UNKNOWN_BUILD
from snowshed.methods.registry import SETTINGS_KEY
from snowshed.scene.schema import parameter_units

if TYPE_CHECKING:
    import pandas as pd

#: Columns by their names in `attrs`.
ORIGIN = {"snowshed_version": "version", "snowshed_build": "build"}


def column_units(table: pd.DataFrame) -> dict[str, str]:
    """Return the units of columns: of parameters from the schema, of measures from their names."""
    units = dict(parameter_units())
    for path, unit in parameter_units().items():
        section, _, setting = path.partition(".")
        if section == SETTINGS_KEY:  # a table names settings without their section
            units[setting] = unit
    named = {str(name): units.get(str(name)) or unit_of_column(str(name)) for name in table}
    return {name: unit for name, unit in named.items() if unit}


def table_origin(table: pd.DataFrame) -> dict[str, Union[str, list[str]]]:
    """Return version and build of the runs in a table: a text each, or the list of several.

    Examples
    --------
    >>> import pandas as pd
    >>> table_origin(pd.DataFrame({"version": ["1.0", "1.0"], "build": ["a", "b"]}))
    {'snowshed_version': '1.0', 'snowshed_build': ['a', 'b']}
    """
    origin: dict[str, Union[str, list[str]]] = {}
    for name, column in ORIGIN.items():
        if column in table and len(table):
            values = sorted({str(value) or UNKNOWN_BUILD for value in table[column]})
            origin[name] = values if len(values) > 1 else values[0]
    return origin
