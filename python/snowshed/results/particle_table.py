"""Particles as a pandas DataFrame, a row each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import snowshed._core as _core
from snowshed.base.arrays import Numbers
from snowshed.results.particle_dataset import AXES, DATASET, DATASET_NAMES

if TYPE_CHECKING:
    import pandas as pd


def particle_table(values: Mapping[str, Numbers]) -> pd.DataFrame:
    """Return quantities of particles as a table with their ids as index.

    Parameters
    ----------
    values : (n,) or (n, 3) each
        Quantities by name, including ``id``.

    Returns
    -------
    pandas.DataFrame
        A row for each particle. Vectors have the columns ``position_x``, ``position_y`` and
        ``position_z``, in 2D, too. Units by column are in ``attrs["units"]``.

    Examples
    --------
    >>> import numpy as np
    >>> table = particle_table({"id": np.array([7]), "position": np.array([[1.0, 0.0, 2.0]])})
    >>> table.loc[7].to_dict(), table.attrs["units"]["position_z"]
    ({'position_x': 1.0, 'position_y': 0.0, 'position_z': 2.0}, 'm')
    """
    import pandas as pd

    units = {name: unit for name, unit, _ in _core.quantities()}
    columns: dict[str, Numbers] = {}
    unit_of: dict[str, str] = {}
    for stored, array in values.items():
        name = DATASET_NAMES.get(stored, stored)
        if name not in DATASET or name == "id":
            continue
        parts = {name: array} if array.ndim == 1 else {
            f"{name}_{axis}": array[:, place] for place, axis in enumerate(AXES)
        }  # fmt: skip
        columns.update(parts)
        unit_of.update(dict.fromkeys(parts, units.get(name, "")))
    table = pd.DataFrame(columns, index=pd.Index(values["id"], name="particle"))
    table.attrs["units"] = unit_of
    return table
