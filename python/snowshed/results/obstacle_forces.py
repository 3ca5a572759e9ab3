"""The forces between the snow and its obstacles: over time, of each event, and on faces.

forces.csv has a row for each obstacle and interval of time, loads.csv for each obstacle and event,
and ``pressures/event_NNN.vtp`` the pressed faces after each event. A force is that of the snow on
the obstacle; z points upwards, so that a weight is negative. In 2D all are per metre of width.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, TypedDict, TypeVar

import numpy as np
from numpy.typing import NDArray

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.extras import require
from snowshed.base.missing_result import MissingResultError
from snowshed.base.units import with_units
from snowshed.io.csv_table import read_csv
from snowshed.io.run_files import check_run_file

if TYPE_CHECKING:
    import pandas as pd
    import xarray

DataT = TypeVar("DataT", "xarray.Dataset", "xarray.DataArray")

FORCES, LOADS = "forces.csv", "loads.csv"
#: The row of forces.csv for the change of momentum that no obstacle and not gravity explains.
UNBALANCED = "unbalanced"
AXES = ("x", "y", "z")
#: Variables of a Dataset of forces by their columns, with units and meanings.
VECTORS = {
    "force": ("f{}_n", "N", "Force of the snow on the obstacle"),
    "moment": ("m{}_nm", "N m", "Moment about the origin of the scene"),
    "center": ("c{}_m", "m", "Centre of pressure"),
}
SCALARS = {
    "normal": ("normal_n", "N", "Sum of the forces normal to the faces"),
    "tangential": ("tangential_n", "N", "Norm of the sum of the forces along the faces"),
    "area": ("area_m2", "m2", "Pressed area"),
    "pressure": ("pressure_pa", "Pa", "Largest mean pressure of a patch"),
}


class FacePressures(TypedDict):
    """Pressures on the patches of faces.

    Attributes
    ----------
    corners : (n, k, 3)
        The corners of each patch, m: k is 2 in 2D and 4 in 3D.
    obstacle : (n,)
        Names of the obstacles.
    area : (n,)
        Areas, m2; in 2D m per metre of width.
    rest_pressure, peak_pressure : (n,)
        Pressure at rest, and the largest mean over 10 ms, Pa.
    peak_time : (n,)
        Ends of the windows of the peaks, s.
    """

    corners: Floats
    obstacle: NDArray[np.str_]
    area: Floats
    rest_pressure: Floats
    peak_pressure: Floats
    peak_time: Floats


def on_obstacles(forces: DataT) -> DataT:
    """Return the forces on obstacles, without the change of momentum that is unexplained."""
    return forces.sel(obstacle=forces.obstacle != UNBALANCED)


def read_forces(folder: Path) -> xarray.Dataset:
    """Read the forces of a run over time, from forces.csv.

    Returns
    -------
    xarray.Dataset
        Dimensions ``time`` (s, through all events: the ends of the intervals), ``obstacle`` and
        ``component``. Each value is a mean over the interval, of ``duration`` (s).

    Raises
    ------
    MissingResultError
        If the run did not record forces.
    InputError
        If the table is damaged.
    """
    table = _table(folder, FORCES, ("event", "time_s", "duration_s", "obstacle"))
    library = require("xarray", "study", "a Dataset of forces")
    names = list(dict.fromkeys(table["obstacle"]))
    if len(table) % max(len(names), 1) or (
        names and table["obstacle"].tolist() != names * (len(table) // len(names))
    ):
        raise InputError(f"{folder / FORCES}: damaged: its rows are not those of all obstacles")
    first = table.iloc[:: max(len(names), 1)]
    times = len(first)
    variables: dict[str, Any] = {
        "event": ("time", first["event"].to_numpy(int)),
        "duration": ("time", first["duration_s"].to_numpy(float)),
    }
    for name, (column, _, _) in VECTORS.items():
        vectors = table[[column.format(axis) for axis in AXES]].to_numpy(float)
        variables[name] = (("time", "obstacle", "component"), vectors.reshape(times, -1, 3))
    for name, (column, _, _) in SCALARS.items():
        numbers = table[column].to_numpy(float)
        variables[name] = (("time", "obstacle"), numbers.reshape(times, -1))
    coordinates = {"time": first["time_s"].to_numpy(float), "obstacle": names}
    dataset: xarray.Dataset = library.Dataset(variables, {**coordinates, "component": list(AXES)})
    for name, (_, unit, meaning) in {**VECTORS, **SCALARS}.items():
        dataset[name].attrs.update(units=unit, long_name=meaning)
    dataset["time"].attrs["units"] = dataset["duration"].attrs["units"] = "s"
    return dataset


def read_loads(folder: Path) -> pd.DataFrame:
    """Read the loads of each event, from loads.csv.

    Returns
    -------
    pandas.DataFrame
        A row for each event and obstacle: the force at rest, the peaks of running means over 1, 10
        and 100 ms, and the impulse of the event. ``attrs["units"]`` has the units.

    Raises
    ------
    MissingResultError
        If the run did not record forces.
    InputError
        If the table is damaged.
    """
    return with_units(_table(folder, LOADS, ("event", "obstacle", "at_rest", "rest_fz_n")))


def pressed_events(folder: Path) -> list[int]:
    """Return the numbers of the events with pressures on faces."""
    return [event for event, _ in _pressure_files(folder)]


def _pressure_files(folder: Path) -> list[tuple[int, Path]]:
    files = (folder / "pressures").glob("event_*.vtp")
    numbered = ((file.stem.removeprefix("event_"), file) for file in files)
    return sorted((int(number), file) for number, file in numbered if number.isdecimal())


def read_pressures(folder: Path, event: Optional[int] = None) -> FacePressures:
    """Read the pressures on faces after an event.

    Parameters
    ----------
    folder
        The results folder.
    event
        Its number, from 1; None: the last event with pressures.

    Returns
    -------
    FacePressures
        The pressures.

    Raises
    ------
    MissingResultError
        If the run wrote no pressures.
    InputError
        If the file is damaged.
    """
    from snowshed.io.vtk.vtp import read_cells

    files = _pressure_files(folder)
    wanted = [file for number, file in files if event in (None, number)]
    if not wanted:
        raise MissingResultError(
            f"{folder / 'pressures'}: no pressures; a run with output.forces = true writes them"
        )
    points, arrays = read_cells(wanted[-1])
    if lacking := {*FacePressures.__annotations__} - {"corners", *arrays}:
        raise InputError(f"{wanted[-1]}: damaged: has no {', '.join(sorted(lacking))}")
    count = len(arrays["area"])
    if not count or len(points) % count:
        raise InputError(f"{wanted[-1]}: damaged: its faces differ in their number of corners")
    names = list(dict.fromkeys(read_loads(folder)["obstacle"]))
    indices = arrays["obstacle"]
    if indices.min() < 0 or indices.max() >= len(names):
        raise InputError(f"{wanted[-1]}: damaged: a face belongs to no obstacle")
    return {
        "corners": points.reshape(count, -1, 3),
        "obstacle": np.array(names)[indices],
        "area": arrays["area"],
        "rest_pressure": arrays["rest_pressure"],
        "peak_pressure": arrays["peak_pressure"],
        "peak_time": arrays["peak_time"],
    }


def present_forces(core: _core.Simulation, scene: Mapping[str, Any]) -> xarray.Dataset:
    """Return the forces on the obstacles now: means over the last tenth of a second.

    Returns
    -------
    xarray.Dataset
        Dimensions ``obstacle`` and ``component``; ``impulse`` (N s) is that since the start.

    Raises
    ------
    InputError
        If the scene does not record forces (``output.forces``).
    """
    library = require("xarray", "study", "a Dataset of forces")
    now = core.obstacle_forces()
    vectors = ("force", "moment", "center", "impulse")
    dataset: xarray.Dataset = library.Dataset(
        {
            **{name: (("obstacle", "component"), now[name]) for name in vectors},
            **{name: ("obstacle", now[name]) for name in ("normal", "tangential")},
        },
        {"obstacle": now["obstacle"], "component": list(AXES)},
    )
    for name, (_, unit, meaning) in {**VECTORS, **SCALARS}.items():
        if name in dataset:
            dataset[name].attrs.update(units=unit, long_name=meaning)
    dataset["impulse"].attrs.update(units="N s", long_name="Impulse on the obstacle so far")
    return dataset


def _table(folder: Path, name: str, columns: tuple[str, ...]) -> pd.DataFrame:
    path = folder / name
    if not path.is_file():
        raise MissingResultError(f"{path}: missing; a run with output.forces = true writes it")
    check_run_file(path)
    table = read_csv(path)
    if missing := [column for column in columns if column not in table]:
        raise InputError(f"{path}: no column {', '.join(missing)}")
    for column in table.columns.drop("obstacle"):
        if len(table) and (
            table[column].dtype.kind not in "if" or not np.isfinite(table[column]).all()
        ):
            raise InputError(f"{path}: no finite numbers in the column {column}")
    return table.astype({"obstacle": str})
