"""Particles as an xarray Dataset, with units and meanings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import snowshed._core as _core
from snowshed.base.arrays import Numbers
from snowshed.base.extras import require

if TYPE_CHECKING:
    import xarray

AXES = ("x", "y", "z")
#: Quantities in the Dataset of a simulation, if the method has them.
DATASET = (
    "id",
    "position",
    "velocity",
    "mass",
    "thickness",
    "density",
    "pressure",
    "deviatoric_stress",
    "preconsolidation_pressure",
    "volumetric_plastic_strain",
    "event",
    "material_id",
)
#: Names of quantities in files of earlier versions.
DATASET_NAMES = {"snow": "material_id"}


def particle_dataset(values: Mapping[str, Numbers], event: int, time: float) -> xarray.Dataset:
    """Return quantities of particles as a Dataset.

    Parameters
    ----------
    values : (n,) or (n, 3) each
        Quantities by name, including ``id``.
    event
        The event of the quantities.
    time
        Time in that event, s.

    Returns
    -------
    xarray.Dataset
        Dimensions ``particle``, with the ids as coordinate, and ``component``; each variable
        has its ``units`` and ``long_name`` in `attrs`.

    Raises
    ------
    InputError
        If xarray (extra ``study``) is not installed.
    """
    library = require("xarray", "study", "a Dataset of particles")
    meanings = {name: (unit, meaning) for name, unit, meaning in _core.quantities()}
    named = {DATASET_NAMES.get(name, name): array for name, array in values.items()}
    dimensions = ("particle", "component")
    dataset: xarray.Dataset = library.Dataset(
        {name: (dimensions[: array.ndim], array) for name, array in named.items() if name != "id"},
        coords={
            "particle": named["id"],
            "component": list(AXES),
            "event_number": event,
            "time": ((), time, {"units": "s", "long_name": "Time in the event"}),
        },
    )
    for name in meanings.keys() & dataset.data_vars.keys():
        unit, meaning = meanings[name]
        dataset[name].attrs.update(units=unit, long_name=meaning)
    dataset["particle"].attrs.update(long_name=meanings["id"][1])
    return dataset
