"""The curve of a loading test, and the stresses and strains of its stages."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.base.core_simulation import AnySimulation, core_of
from snowshed.base.missing_result import MissingResultError
from snowshed.base.paths import PathLike
from snowshed.base.units import with_units
from snowshed.io.csv_table import parse_csv, read_csv
from snowshed.io.run_files import check_run_file

if TYPE_CHECKING:
    import pandas as pd

CURVE = "curve.csv"  # in the results folder
#: Columns of every curve; energies follow if they are recorded.
COLUMNS = (
    "time_s",
    "stage",
    "axial_strain",
    "shear_strain",
    "top_stress_pa",
    "bottom_stress_pa",
    "side_stress_pa",
    "shear_stress_pa",
    "cone_force_n",
    "bonds",
    "broken_in_tension",
    "broken_in_shear",
    "contacts",
    "coordination",
    "solid_fraction",
)
#: Columns with a second column, named `PEAK` and the name. It holds the value in the step since the
#: row before in which the sample carried most. Curves of earlier versions lack it.
PEAK_COLUMNS = (
    "axial_strain",
    "shear_strain",
    "top_stress_pa",
    "bottom_stress_pa",
    "side_stress_pa",
    "shear_stress_pa",
    "cone_force_n",
)
PEAK = "peak_"
#: Columns of whole numbers.
COUNTS = ("stage", "bonds", "broken_in_tension", "broken_in_shear", "contacts")


@checked
@dataclass(frozen=True)
class LoadingCurve:
    """Measurements of a loading test, row by row.

    Attributes
    ----------
    columns
        Arrays of equal length by name: `COLUMNS`, `PEAK_COLUMNS` of the peaks between rows, and
        energies in joules if they were recorded. Stages count from 1; a row at the end of a stage
        belongs to that stage. Stresses are positive in compression.
    """

    columns: Mapping[str, Floats]

    def __getitem__(self, name: str) -> Floats:
        return self.columns[name]

    def __len__(self) -> int:
        return len(self.columns["time_s"])

    @property
    def broken(self) -> Floats:
        """Bonds broken so far."""
        broken: Floats = self["broken_in_tension"] + self["broken_in_shear"]
        return broken

    @property
    def energies(self) -> tuple[str, ...]:
        """Names of the energies, if they were recorded."""
        return tuple(name for name in self.columns if name.endswith("_j"))

    def of_stage(self, stage: int) -> LoadingCurve:
        """Return the rows of a stage, counted from 1, and the row before them.

        Examples
        --------
        >>> curve = LoadingCurve({name: np.array([1.0, 1.0, 2.0]) for name in COLUMNS})
        >>> len(curve.of_stage(2))
        2
        """
        own = np.flatnonzero(self["stage"] == stage)
        rows = np.arange(max(own[0] - 1, 0), own[-1] + 1) if own.size else own
        columns = {name: values[rows] for name, values in self.columns.items()}
        for name in PEAK_COLUMNS:
            if own.size and own[0] > 0 and PEAK + name in columns:
                columns[PEAK + name][0] = columns[name][0]  # from the stage before
        return LoadingCurve(columns)

    @property
    def peaks(self) -> LoadingCurve:
        """The same rows with the strains and stresses of the peaks since the row before.

        Rows of earlier versions have no peaks and are unchanged.

        Examples
        --------
        >>> columns = {name: np.zeros(2) for name in COLUMNS}
        >>> curve = LoadingCurve({**columns, "peak_top_stress_pa": np.array([0.0, 5.0])})
        >>> curve.peaks["top_stress_pa"].tolist()
        [0.0, 5.0]
        """
        peaks = {name: self.columns.get(PEAK + name, self.columns[name]) for name in PEAK_COLUMNS}
        return LoadingCurve({**self.columns, **peaks})

    @classmethod
    def read(cls, path: PathLike) -> LoadingCurve:
        """Read ``curve.csv``.

        Raises
        ------
        InputError
            If the file is not such a table, or not the one that the run beside it wrote.
        OSError
            If it cannot be read.
        """
        check_run_file(Path(path))
        table = read_csv(Path(path), as_text=True)  # pandas rounds numbers
        return cls.from_table(table, str(path))

    @classmethod
    def parse(cls, text: str, where: str) -> LoadingCurve:
        """Return the curve from the text of a ``curve.csv``; errors name `where`.

        Raises
        ------
        InputError
            If it is not such a table.
        """
        return cls.from_table(parse_csv(text, where, as_text=True), where)

    @classmethod
    def from_table(cls, table: pd.DataFrame, where: str = "the table") -> LoadingCurve:
        """Return the curve from a table, such as `snowshed.Results.curve`; errors name `where`.

        Raises
        ------
        InputError
            If a column is missing, or holds texts.
        """
        missing = [name for name in COLUMNS if name not in table]
        if missing:
            raise InputError(
                f"{where}: not a curve of a loading test; the column {missing[0]} is missing"
            )
        try:
            return cls({str(name): table[name].to_numpy().astype(np.float64) for name in table})
        except ValueError as error:
            raise InputError(f"{where}: {error}") from None

    def table(self) -> pd.DataFrame:
        """Return the columns as a table; ``attrs["units"]`` has their units."""
        import pandas as pd

        return with_units(pd.DataFrame(dict(self.columns)))

    def text(self) -> str:
        """Return the table as CSV; a number that is read back has the same bits."""
        is_count = [name in COUNTS for name in self.columns]
        lines = [",".join(self.columns)]
        for row in zip(*(values.tolist() for values in self.columns.values())):
            cells = (str(int(cell)) if count else repr(cell) for cell, count in zip(row, is_count))
            lines.append(",".join(cells))
        return "\n".join(lines) + "\n"


def loading_curve(simulation: AnySimulation) -> LoadingCurve:
    """Return the measurements of a loading test so far.

    Parameters
    ----------
    simulation
        A `snowshed.Simulation`.

    Raises
    ------
    InputError
        If the scene's method is another.
    """
    return LoadingCurve(core_of(simulation).grains_curve())


def read_curve(folder: Path) -> pd.DataFrame:
    """Read the curve of a loading test from its results folder.

    Returns
    -------
    pandas.DataFrame
        The columns of `LoadingCurve`; ``attrs["units"]`` has their units.

    Raises
    ------
    MissingResultError
        If it is missing.
    InputError
        If it is damaged.
    """
    file = folder / CURVE
    if not file.is_file():
        raise MissingResultError(f"{file}: missing; a run writes it while it advances")
    return LoadingCurve.read(file).table()


def present_curve(core: _core.Simulation, scene: Mapping[str, Any]) -> pd.DataFrame:
    """Return the curve of a loading test so far, as `read_curve` does."""
    return loading_curve(core).table()


def stage_stress(curve: LoadingCurve, kind: str) -> Floats:
    """Return the stress that a stage of some kind builds up, Pa; a growing stress is positive."""
    if kind == "shear":
        return np.asarray(np.abs(curve["shear_stress_pa"]))
    stress = curve["top_stress_pa"]
    return -stress if kind == "stretch" else stress


def carried_stress(curve: LoadingCurve, kind: str) -> Floats:
    """Return the stress that a sample carries from plate to plate, Pa.

    Between plates it is the smaller of the two stresses: a plate that starts fast hits the grains
    next to it, and that stress is not the sample's strength.
    """
    stress = stage_stress(curve, kind)
    if kind in ("shear", "penetrate"):
        return stress
    other = curve["bottom_stress_pa"]
    return np.asarray(np.minimum(stress, -other if kind == "stretch" else other))


def no_contact_text(curve: LoadingCurve, kind: str) -> str:
    """Return a phrase if the load of a stage never touched the snow; else "".

    Examples
    --------
    >>> curve = LoadingCurve({name: np.zeros(3) for name in COLUMNS})
    >>> no_contact_text(curve, "compress")
    'the plates never touched the snow'
    """

    def is_felt(name: str) -> bool:
        return bool(np.any(curve[name] != 0.0) or np.any(curve.peaks[name] != 0.0))

    if kind in ("hold", "unload"):
        return ""
    if kind == "penetrate":
        return "" if is_felt("cone_force_n") else "the cone never touched the snow"
    plates = ("top_stress_pa", "bottom_stress_pa")
    idle = [name.partition("_")[0] for name in plates if not is_felt(name)]
    if len(idle) == len(plates):
        return "the plates never touched the snow"
    if idle:
        return f"the {idle[0]} plate never touched the snow"
    if kind == "shear" and not is_felt("shear_stress_pa"):
        return "the top plate never dragged the snow along"
    return ""


def stage_strain(curve: LoadingCurve, kind: str) -> Floats:
    """Return the strain of a stage from its beginning, positive."""
    strain = curve["shear_strain" if kind == "shear" else "axial_strain"]
    return np.asarray(np.abs(strain - strain[0]))
