"""Measurements of errors against known answers, as JSON and as a table."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Union

from snowshed._core import InputError
from snowshed.base.messages import quoted, shortened
from snowshed.io.json_file import check_values, is_number
from snowshed.scene.accuracy_settings import FORMER_NAMES

if TYPE_CHECKING:
    import pandas as pd

Value = Union[str, int, float, bool]

#: One way of solving a problem: names of scene parameters without their section ("dx", "transfer",
#: "flip_ratio", "basis", "precision", "particles_per_voxel", "courant_factor", "between",
#: "dimension", "seed", ...) or of the problem's own parameters ("friction", "law"), and their
#: values.
CaseSettings = Mapping[str, Value]

#: Columns of the table before and after the settings.
IDENTITY = ("case", "quantity")
RESULTS = (
    "value",
    "exact",
    "error",
    "wall_s",
    "updates",
    "updates_per_s",
    "steps",
    "particles",
    "peak_memory_mb",
    "elapsed_s",
    "version",
    "machine",
    "date",
    "failure",
)
NUMBERS = RESULTS[: RESULTS.index("version")]

#: Keys of a measurement in a file, and of its results.
FORM = {
    "case": str,
    "settings": dict,
    "measured": list,
    **dict.fromkeys(("wall_s", "updates", "steps", "particles"), float),
    **dict.fromkeys(("peak_memory_mb", "elapsed_s"), float),
    **dict.fromkeys(("version", "machine", "date", "failure"), str),
}
NUMBERS_MEASURED = ("value", "exact", "error")


@dataclass(frozen=True)
class Measured:
    """One quantity of one solution: its value, the value it should have, and the error."""

    quantity: str
    value: float
    exact: float
    error: float


@dataclass(frozen=True)
class MeasuredSolution:
    """A solution of a problem with a known answer, by one choice of settings.

    Attributes
    ----------
    measured
        All quantities of the case; their numbers are NaN if the measurement failed.
    wall_s, updates, steps, particles
        Time of the solution alone (without seeding, imports or evaluation), s; number of particle
        updates, of steps and of particles. 0 if the measurement failed, or did not count them.
    peak_memory_mb
        Largest memory of its process, including Python and its libraries (20 to 100 MB).
    elapsed_s
        Duration including seeding and evaluation, s.
    failure
        Reason for a missing result; otherwise empty.
    """

    case: str
    settings: CaseSettings
    measured: Sequence[Measured]
    wall_s: float = 0.0
    updates: int = 0
    steps: int = 0
    particles: int = 0
    peak_memory_mb: float = 0.0
    elapsed_s: float = 0.0
    version: str = ""
    machine: str = ""
    date: str = ""
    failure: str = ""

    @property
    def key(self) -> str:
        """Key of a measurement: the case and its settings.

        Examples
        --------
        >>> MeasuredSolution("bar", {"dx": 0.1, "basis": "cubic"}, []).key
        'bar {"basis": "cubic", "dx": 0.1}'
        """
        return measurement_key(self.case, self.settings)

    @property
    def updates_per_s(self) -> float:
        """Particle updates per second of the solution; NaN if not measured."""
        return self.updates / self.wall_s if self.wall_s and self.updates else math.nan

    def to_json(self) -> dict[str, Any]:
        """Return the measurement as JSON data; numbers that are not finite are null."""
        data = asdict(self)
        data["settings"] = dict(self.settings)
        data["measured"] = [
            {name: _finite(value) for name, value in asdict(result).items()}
            for result in self.measured
        ]
        return data

    @classmethod
    def from_json(cls, data: Any, where: str) -> MeasuredSolution:
        """Return the measurement for the output of `to_json`.

        Raises
        ------
        InputError
            If the data is not such a measurement; the message names its place, `where`.
        """
        check_values(data, FORM, where)
        if unknown := sorted(data.keys() - FORM.keys()):
            raise InputError(f"{where}: damaged: unknown key {quoted(unknown[0])}")
        for name, value in data["settings"].items():
            valid = isinstance(value, (str, bool)) or is_number(value)
            if not valid or name in (*IDENTITY, *RESULTS):
                raise InputError(f"{where}: damaged: /settings/{shortened(name)}: not a setting")
        measured = [
            _read_measured(result, f"{where}: /measured/{i}")
            for i, result in enumerate(data["measured"])
        ]
        settings = {FORMER_NAMES.get(k, k): v for k, v in data["settings"].items()}
        return cls(**{**data, "settings": settings, "measured": measured})


def measurement_key(case: str, settings: CaseSettings) -> str:
    """Return the key under which a case with these settings is kept."""
    return f"{case} {json.dumps(dict(settings), sort_keys=True)}"


def to_table(measurements: Iterable[MeasuredSolution]) -> pd.DataFrame:
    """Return measurements as a table with one row per measured quantity.

    Returns
    -------
    pandas.DataFrame
        Columns: `IDENTITY`, every setting that any measurement has (else None),
        then `RESULTS`.

    Raises
    ------
    ValueError
        If a setting has the name of another column.

    Examples
    --------
    >>> one = MeasuredSolution("bar", {"dx": 0.1}, [Measured("height", 0.9, 1.0, -0.1)], wall_s=2.0)
    >>> to_table([one])[["case", "quantity", "dx", "error", "wall_s"]].values.tolist()
    [['bar', 'height', 0.1, -0.1, 2.0]]
    """
    import pandas as pd

    listed = list(measurements)
    settings = list(dict.fromkeys(name for measurement in listed for name in measurement.settings))
    if taken := sorted({*IDENTITY, *RESULTS} & set(settings)):
        raise ValueError(f"settings may not be called {', '.join(taken)}: columns of the results")
    rows = [row for measurement in listed for row in _rows(measurement)]
    table = pd.DataFrame(rows, columns=[*IDENTITY, *settings, *RESULTS], dtype=object)
    table[settings] = table[settings].where(table[settings].notna(), None)
    return table.astype(dict.fromkeys(NUMBERS, float))


def setting_names(table: pd.DataFrame) -> list[str]:
    """Return the settings that occur in a table of measurements."""
    fixed = {*IDENTITY, *RESULTS}
    return [str(name) for name in table if name not in fixed and table[name].notna().any()]


def _rows(measurement: MeasuredSolution) -> list[dict[str, Any]]:
    facts = asdict(measurement)
    del facts["settings"], facts["measured"]
    facts["updates_per_s"] = measurement.updates_per_s
    return [
        {**facts, **measurement.settings, **asdict(measured)} for measured in measurement.measured
    ]


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _read_measured(data: Any, where: str) -> Measured:
    check_values(data, {"quantity": str}, where)
    given = [name for name in NUMBERS_MEASURED if data.get(name, math.nan) is not None]
    check_values(data, dict.fromkeys(given, float), where)
    numbers = (math.nan if data[name] is None else data[name] for name in NUMBERS_MEASURED)
    return Measured(data["quantity"], *numbers)
