"""Study tables as files for other programs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, cast

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.extras import require
from snowshed.base.paths import PathLike
from snowshed.io.atomic import replacing
from snowshed.io.csv_table import csv_text
from snowshed.study.database import STORED_TYPES
from snowshed.study.table import read_table
from snowshed.study.table_origin import column_units, table_origin

if TYPE_CHECKING:
    import pandas as pd
    import xarray

SUFFIXES = {".csv": "csv", ".parquet": "parquet", ".nc": "netcdf"}


@checked
def export(
    folder: PathLike,
    file: PathLike,
    *,
    study: Optional[str] = None,
    form: Optional[str] = None,
    timing: bool = False,
) -> None:
    """Write a study's table to a file.

    Parameters
    ----------
    folder, study, timing
        As for `read_table`.
    file
        The file to write; it appears whole or not at all.
    form
        "csv", "parquet" or "netcdf"; None: chosen by the ending of the file's name (.csv, .parquet,
        .nc).

    Raises
    ------
    InputError
        If the format is unknown, or the libraries for it (extra ``study``) are not installed.
    """
    write_table(lambda: read_table(folder, study, timing=timing), file, form)


def write_table(
    make: Callable[[], pd.DataFrame], file: PathLike, form: Optional[str] = None
) -> None:
    """Write the table that `make` returns; an unknown format is refused before it is called.

    Parameters
    ----------
    make
        Function that returns a table, as `read_table` does.
    file, form
        As for `export`.
    """
    write = _writer(Path(file), form)
    table = make()
    with replacing(file) as beside:
        write(table, beside)


@checked
def to_dataset(table: pd.DataFrame) -> xarray.Dataset:
    """Return a study's table as an xarray Dataset with the dimensions run and event.

    Columns that differ from event to event have both dimensions. All others (hash, parameters,
    settings) are coordinates along run. Events that a run has not reached hold NaN, 0 steps and
    empty texts. Its `attrs` have the version and the build of snowshed, lists if the runs have
    several, and those of its variables their units.

    Raises
    ------
    InputError
        If xarray (extra ``study``) is not installed, or the table has no rows.
    """
    library = require("xarray", "study", "the NetCDF form")
    if table.empty:
        raise InputError("no run is done yet; NetCDF needs at least one")
    per_event = [name for name in (*STORED_TYPES, "error", "wall_s") if name in table]
    grids = table.set_index(["hash", "event"])[per_event].unstack("event")
    runs = table.drop(columns=["event", *per_event]).drop_duplicates("hash")
    grids = grids.reindex(runs["hash"])
    data = {name: (("run", "event"), _plain_array(grids[name])) for name in per_event}
    coordinates = {name: ("run", _plain_array(runs[name])) for name in runs}
    coordinates["event"] = ("event", list(grids[per_event[0]].columns))
    dataset = library.Dataset(data, coordinates, table_origin(table))
    for name, unit in column_units(table).items():
        if name in dataset:
            dataset[name].attrs["units"] = unit
    return cast("xarray.Dataset", dataset)


def _writer(file: Path, form: Optional[str]) -> Callable[[pd.DataFrame, Path], None]:
    form = form or SUFFIXES.get(file.suffix, file.suffix or file.name)
    if form not in WRITERS:
        raise InputError(
            f"{file}: unknown format {form!r}; allowed: {', '.join(WRITERS)}, "
            f"by default the file's ending decides ({', '.join(SUFFIXES)})"
        )
    return WRITERS[form]


def _write_csv(table: pd.DataFrame, file: Path) -> None:
    file.write_text(csv_text(table), encoding="utf-8")


def _write_parquet(table: pd.DataFrame, file: Path) -> None:
    require("pyarrow", "study", "the Parquet format")
    table.to_parquet(file, engine="pyarrow", index=False)


def _write_netcdf(table: pd.DataFrame, file: Path) -> None:
    dataset = to_dataset(table)
    for name, value in dataset.attrs.items():  # NetCDF 3 knows no lists of texts
        dataset.attrs[name] = value if isinstance(value, str) else ", ".join(value)
    dataset.to_netcdf(file, engine="scipy")


WRITERS: Mapping[str, Callable[[pd.DataFrame, Path], None]] = {
    "csv": _write_csv,
    "parquet": _write_parquet,
    "netcdf": _write_netcdf,
}


def _plain_array(columns: Any) -> Any:
    """Return the values of columns as a plain array; NetCDF knows no missing texts or counts."""
    kinds = columns.dtypes if columns.ndim == 2 else [columns.dtype]
    if all(kind == "Int64" for kind in kinds):
        return columns.fillna(0).to_numpy(dtype="int64")
    if all(getattr(kind, "kind", "O") in "ifb" for kind in kinds):
        return columns.to_numpy()
    return columns.fillna("").astype(str).to_numpy(dtype=object)
