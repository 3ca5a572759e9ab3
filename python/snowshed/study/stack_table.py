"""Tables of stacks: from the store of a study, from a results folder, or from an exported file.

Every analysis reads its stacks here. The columns are those of `snowshed.study.read_table`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Booleans, Floats
from snowshed.base.callers import STUDY_RESUME, argument, either
from snowshed.base.extras import require
from snowshed.base.formatting import number_in
from snowshed.base.messages import shortened
from snowshed.base.paths import PathLike
from snowshed.io.csv_table import read_csv
from snowshed.io.run_files import issue_unfinished_note
from snowshed.results.folder import event_table
from snowshed.scene.accuracy_settings import ACCURACY, FORMER_NAMES
from snowshed.scene.resolved import scene_data
from snowshed.scene.scene import ResolvedScene
from snowshed.snow.stack.quantities import Measure, measure_named
from snowshed.snow.stack.trimming import TRIMMINGS
from snowshed.study.database import FILE as STORE
from snowshed.study.factors import SEED

if TYPE_CHECKING:
    import pandas as pd

MAX_ROWS = 1_000_000  # rows of a Parquet file, which packs them well
#: Columns for physics and methods; rows that differ in them cannot be compared.
SETTINGS = ("version", "dimension", "trimming", *ACCURACY)


@dataclass(frozen=True)
class StackTable:
    """Stacks of some runs, one row per run and event.

    Attributes
    ----------
    frame
        The columns of a study's table: ``hash``, the axes by dotted paths, ``seed``, ``event``, the
        measures, and settings. All cells of a CSV file are texts.
    axes
        Dotted paths of the parameters that vary, or have a column with a single value.
    points
        One row per run, computed or not: ``hash``, the axes, and ``seeding.seed``.
    pending
        Number of runs that are not computed yet, if known.
    name
        Name of the study, or of the file.

    Examples
    --------
    >>> import pandas as pd
    >>> stacks = pd.DataFrame({"hash": ["a"], "seed": [1], "event": [1], "panel.tilt": [40.0],
    ...                        "height_m": [0.2], "length_m": [0.5]})
    >>> StackTable.of(stacks).measured("stack", ["height", "length"])[["height", "length"]]
       height  length
    0     0.2     0.5
    """

    frame: pd.DataFrame
    axes: Sequence[str]
    points: pd.DataFrame
    pending: int = 0
    name: str = "table"

    @classmethod
    def read(cls, source: PathLike, study: Optional[str] = None) -> StackTable:
        """Read stacks from wherever they are.

        Parameters
        ----------
        source
            The folder of a study's store, that of a command with such a store in ``runs``, the
            results folder of a single run, or a file of ``snowshed study export`` (CSV or Parquet).
        study
            Name of the study in a store; not needed if there is a single one.

        Raises
        ------
        InputError
            If the table is missing or damaged; the message names the source.
        """
        path = Path(source)
        if not path.is_dir():
            return cls.read_file(path)
        if (path / "events.csv").is_file():
            return cls._of_results(path)
        if not (path / STORE).is_file() and (path / "runs" / STORE).is_file():
            path = path / "runs"
        return cls.read_study(path, study)

    @classmethod
    def read_study(cls, folder: PathLike, study: Optional[str] = None) -> StackTable:
        """Read the computed runs of a study from its store.

        Raises
        ------
        InputError
            If there is no such study, or the store is damaged.
        """
        from snowshed.study.store import Store
        from snowshed.study.table import read_table

        with Store.open(folder) as store:
            name = store.named(study)
            axes = store.axes(name)
            runs = store.runs(name)
        scenes = {run.hash: scene_data(run.scene) for run in runs}
        pending = sum(run.status == "pending" for run in runs)
        return cls(read_table(folder, name), axes, _points(axes, scenes), pending, name)

    @classmethod
    def read_file(cls, path: Path) -> StackTable:
        """Read a table that ``snowshed study export`` wrote; a CSV file's cells are texts."""
        import pandas as pd

        try:
            if path.suffix != ".parquet":
                return cls.of(read_csv(path, as_text=True), path.stem)
            parquet = require("pyarrow.parquet", "study", "reading Parquet")
            count = parquet.read_metadata(path).num_rows
            if count > MAX_ROWS:
                raise InputError(f"{path}: {count} rows; at most {MAX_ROWS} are allowed")
            return cls.of(pd.read_parquet(path), path.stem)
        except InputError:
            raise
        except OSError as error:
            raise InputError(f"{path}: {error.strerror or error}") from None
        except ValueError as error:
            raise InputError(f"{path}: not a table: {error}") from None

    @classmethod
    def of(cls, frame: pd.DataFrame, name: str = "table") -> StackTable:
        """Return the table of a DataFrame that has the columns of a study's table."""
        from snowshed.study.table import with_trimming

        frame = with_trimming(frame.rename(columns=FORMER_NAMES))
        axes = [str(path) for path in frame if "." in str(path)]
        points = frame[[path for path in ("hash", *axes) if path in frame]]
        if "seed" in frame:
            points = points.assign(**{SEED: frame["seed"]})
        points = as_numbers(points, [*axes, SEED]).drop_duplicates(ignore_index=True)
        return cls(frame, axes, points, name=name)

    @classmethod
    def _of_results(cls, folder: Path) -> StackTable:
        """Read a results folder; all numbers and choices of its scene's panel are axes."""
        from snowshed.study.scene_hash import RunKey
        from snowshed.study.table import scene_columns

        issue_unfinished_note(folder)
        run = RunKey.of(ResolvedScene.load(folder / "scene.json"))
        scene = scene_data(run.scene)
        axes = [f"panel.{name}" for name in scene.get("panel", {})]
        facts = {"hash": run.hash, **scene_columns(scene, axes)}
        return cls.of(event_table(folder).assign(**facts), folder.name)

    def chosen(self, where: Mapping[str, str]) -> StackTable:
        """Return the rows that have some values in some columns.

        Raises
        ------
        InputError
            If there is no such column, or no row has the value.
        """
        frame = self.frame
        for given, value in where.items():
            column = FORMER_NAMES.get(given, given)
            if column not in frame:
                raise InputError(f"{column}: no such column; the table has {self.columns}")
            cells = frame[column].astype(str)
            equal = (cells == value) | cells.map(number_in).eq(number_in(value))
            if not equal.any():
                there = ", ".join(sorted(set(cells))[:8])
                raise InputError(f"{column}: no row has the value {value}; there are: {there}")
            frame = frame.loc[equal]
        return replace(self, frame=frame)

    @property
    def columns(self) -> str:
        """The names of the columns, for messages."""
        return shortened(", ".join(map(str, self.frame)), 300)

    def check_columns(self, needed: Sequence[str]) -> None:
        """Raise InputError unless there are these columns."""
        missing = [name for name in needed if name not in self.frame]
        if not missing:
            return
        hint = ""
        if any(name.startswith("panel.") for name in missing):
            hint = (
                "; a study's table has a column for each parameter in its axes, also with a single "
                "value: axes.panel.tilt = 40"
            )
        elif any(name.startswith(tuple(TRIMMINGS)) for name in missing):
            hint = "; its stacks were measured by a version without that trimming rule"
        raise InputError(f"no column {', '.join(missing)}; it has {self.columns}{hint}")

    def numbers(self, column: str, *, positive: bool = False) -> Floats:
        """Return a column as numbers; raises InputError with the line of a wrong cell."""
        import pandas as pd

        numbers = np.asarray(pd.to_numeric(self.frame[column], errors="coerce"), dtype=float)
        wrong = ~np.isfinite(numbers) | (numbers <= 0 if positive else False)
        self.refuse(column, wrong, "a positive number" if positive else "a number")
        return numbers

    def refuse(self, column: str, wrong: Booleans, expected: str) -> None:
        """Raise an error about the first wrong cell of a column, with its line in the file."""
        if wrong.any():
            row = int(np.argmax(wrong))
            cell = str(self.frame[column].iloc[row])
            raise InputError(f"line {self.line(row)}, {column}: {cell!r} is not {expected}")

    def line(self, row: int) -> int:
        """Return a row's line in its file: lines count from 1, and the first holds the names."""
        return int(self.frame.index[row]) + 2

    def without_stack(self, measure: Measure, quantities: Sequence[str]) -> Booleans:
        """Return for each row whether the run failed, or all its snow stayed on the panel."""
        import pandas as pd

        cells = self.frame[list(measure.columns(quantities))]
        nothing = cells.isna() | (cells.astype(str) == "")
        nothing |= cells.apply(pd.to_numeric, errors="coerce") == 0
        return np.asarray(nothing.any(axis=1))

    def measured(self, measure: str, quantities: Sequence[str]) -> pd.DataFrame:
        """Return the rows that have been measured, with the measures under plain names.

        Parameters
        ----------
        measure
            One of `snowshed.snow.stack.quantities.MEASURES`.
        quantities
            Names in `snowshed.snow.stack.quantities.QUANTITIES`.

        Raises
        ------
        InputError
            If the measure is unknown, there is no such row, a cell is neither empty nor a number,
            a stack is there twice, or the rows differ in their settings.
        """
        columns = measure_named(measure).columns(quantities)
        self.check_columns(["event", *columns])
        self._check_stacks()
        numbers = {
            quantity: self._numbers_or_nothing(column) for column, quantity in columns.items()
        }
        frame = self.frame.drop(columns=list(columns)).assign(**numbers)
        frame = frame.dropna(subset=list(quantities))
        frame = as_numbers(frame, [*self.axes, "seed", "event"])
        if frame.empty:
            raise InputError(
                f"none of its runs is computed yet; {either(*STUDY_RESUME)} computes them"
            )
        return frame

    def _numbers_or_nothing(self, column: str) -> pd.Series[float]:
        """Return a column as numbers, NaN for empty cells; refuse any other cell."""
        import pandas as pd

        cells = self.frame[column]
        numbers = pd.to_numeric(cells, errors="coerce")
        nothing = cells.isna() | cells.astype(str).str.strip().str.lower().isin(["", "nan"])
        self.refuse(column, np.asarray(numbers.isna() & ~nothing), "a number")
        return numbers

    def check_hashes(self) -> None:
        """Raise InputError unless each run has a hash of its own."""
        self.check_columns(["hash"])
        cells = self.frame["hash"]
        self.refuse("hash", np.asarray(cells.isna() | (cells.astype(str) == "")), "a run's hash")
        again = self.points["hash"].duplicated()
        if again.any():
            hash_ = self.points["hash"][again].iloc[0]
            raise InputError(
                f"hash {shortened(str(hash_), 40)}: the rows of this run differ in their "
                f"parameters ({self._columns_that_differ(hash_)}); needed: a hash of its own for "
                "each run"
            )

    def _check_stacks(self) -> None:
        """Refuse stacks that are there twice, and rows that differ in their settings.

        Tables that were put together by hand may have both. Copies of a run would pass for other
        seeds, and stacks of other settings for the scatter of the seeds.
        """
        names = [name for name in (*self.axes, "seed", "event") if name in self.frame]
        stacks = as_numbers(self.frame, names)[list(dict.fromkeys(names))]
        again = stacks.duplicated()
        if again.any():
            row = int(again.argmax())
            values = ", ".join(f"{name} = {stacks[name].iloc[row]}" for name in stacks)
            raise InputError(f"line {self.line(row)}: the stack of {values} is there twice")
        self._check_settings()

    def _columns_that_differ(self, hash_: object) -> str:
        """Return the names of the columns in which the points of a run differ."""
        points = self.points[self.points["hash"] == hash_]
        return ", ".join(str(name) for name in points if points[name].nunique(dropna=False) > 1)

    def _check_settings(self) -> None:
        """Refuse rows that differ in a setting that is not among the axes."""
        axes = {path.rpartition(".")[2] for path in self.axes}
        for name in SETTINGS:
            if name not in self.frame or name in axes:
                continue
            cells = as_numbers(self.frame, [name])[name]
            values = sorted(set(cells[cells.notna()].astype(str)) - {""})
            if len(values) > 1:
                raise InputError(
                    f"{name}: the rows have different values ({', '.join(values[:6])}), and their "
                    "stacks are not comparable; choose the rows of one of them"
                )

    def varying(self, paths: Sequence[str], purpose: str) -> list[str]:
        """Return the axes with several values; these must be numbers.

        Raises
        ------
        InputError
            If they are not; the message names the `purpose`, which needs numbers.
        """
        import pandas as pd

        varying = [path for path in paths if self.points[path].astype(str).nunique() > 1]
        for path in varying:
            values = self.points[path]
            if pd.to_numeric(values, errors="coerce").isna().any() or values.dtype == bool:
                raise InputError(f"{path}: holds {values.iloc[0]!r}; {purpose} needs numbers")
        return varying

    def common_settings(self, inputs: Sequence[str]) -> dict[str, str]:
        """Return the common settings of all rows, as text; refuse rows that differ otherwise.

        Parameters
        ----------
        inputs
            Columns in which rows may differ, besides the seed.
        """
        common = {}
        for name in map(str, self.frame):
            parameter = "." in name and name not in inputs and name != SEED
            if not (parameter or name in SETTINGS):
                continue
            values = sorted(set(self.frame[name].astype(str)))
            if len(values) > 1:
                raise InputError(
                    f"{name}: the rows have different values ({', '.join(values[:6])}), but it is "
                    f"not an input; select rows with {argument('where')}, such as "
                    f"{name}={values[0]}"
                )
            common[name] = values[0]
        return common


def as_numbers(frame: pd.DataFrame, columns: Sequence[str]) -> pd.DataFrame:
    """Return a table in which columns of texts that are all numbers are numbers."""
    import pandas as pd

    converted = {}
    for name in columns:
        if name in frame and not pd.api.types.is_numeric_dtype(frame[name]):
            numbers = pd.to_numeric(frame[name], errors="coerce")
            if not numbers.isna().any():
                converted[name] = numbers
    return frame.assign(**converted)


def _points(axes: Sequence[str], scenes: Mapping[str, Mapping[str, object]]) -> pd.DataFrame:
    import pandas as pd

    from snowshed.study.table import value_at

    paths = list(dict.fromkeys([*axes, SEED]))
    rows = [
        {"hash": hash_, **{path: value_at(scene, path) for path in paths}}
        for hash_, scene in scenes.items()
    ]
    return pd.DataFrame(rows, columns=["hash", *paths])
