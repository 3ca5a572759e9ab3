"""Measured stacks: the CSV file or DataFrame, read and checked, and its empty template."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Optional, Union

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.formatting import number_in
from snowshed.base.messages import quoted
from snowshed.base.notes import issue_note
from snowshed.base.paths import PathLike
from snowshed.io.csv_table import TableRow, TextTable, frame_as_text, read_text_table
from snowshed.snow.stack.quantities import QUANTITIES

if TYPE_CHECKING:
    import pandas as pd

POSITIVE_QUANTITIES = ("height", "length")
KEYS = ("tilt_deg", "event")
ROUND = "round"
MAX_TILT = 90.0  # degrees; a tilt must be smaller
UNUSUAL_TILT = 3.0  # degrees; snow stays on flatter panels, and smaller numbers may be radians
UNUSUAL_LENGTH = 3.0  # m; stacks of experiments are lower and shorter
MAX_DISTANCE = 100.0  # m, of all measured lengths and positions
MAX_LENGTH_DEVIATIONS = (
    3.0  # largest difference between length and tail - head, in standard deviations
)

TEMPLATE_TILTS = (40, 50)
TEMPLATE_EVENTS = 5
TEMPLATE_HEADER = """\
# Measured stacks, one row per panel tilt and event, for `snowshed calibrate`. SI units, degrees.
#
# tilt_deg       panel from the horizontal
# event          slide-offs so far: 1 is the first
# round          repetition of the experiment (the column may be left out)
# height_m       highest point of the stack above the ground
# length_m       tail - head, along the slide-off
# head_m         end of the stack nearest to the panel, from the panel's centre
# tail_m         the other end, from the panel's centre
# ..._std_m      uncertainty of each: one standard deviation, greater than 0
#
# Leave empty what was not measured. Lines that begin with # and rows without a measurement are
# ignored.
"""


def measured_column(quantity: str) -> str:
    """Return the column of a measured quantity.

    Examples
    --------
    >>> measured_column("height"), uncertainty_column("height")
    ('height_m', 'height_std_m')
    """
    return f"{quantity}_m"


def uncertainty_column(quantity: str) -> str:
    """Return the column of a quantity's standard deviation."""
    return f"{quantity}_std_m"


MAX_EVENT_NUMBER = 1000  # largest number of an event (as in scenes) or a round

COLUMNS = (
    *KEYS,
    ROUND,
    *(name(q) for q in QUANTITIES for name in (measured_column, uncertainty_column)),
)


@checked
@dataclass(frozen=True)
class Measurement:
    """One measured length of one stack.

    Attributes
    ----------
    tilt
        Tilt of the panel, degrees.
    event
        Number of slide-offs so far, from 1.
    round
        Repetition of the experiment, from 1.
    quantity
        One of `QUANTITIES`.
    value, uncertainty
        The measured value and its standard deviation, m.
    line
        Line in the file, or row of the DataFrame, from 1.
    place
        The same for messages, such as "line 3" or "row 2".

    Raises
    ------
    InputError
        If a value is not allowed.
    """

    tilt: float
    event: int
    round: int
    quantity: str
    value: float
    uncertainty: float
    line: int = 0
    place: str = ""

    def __post_init__(self) -> None:
        if self.quantity not in QUANTITIES:
            allowed = ", ".join(QUANTITIES)
            raise InputError(f"quantity: {quoted(self.quantity)}; allowed: {allowed}")
        _check_tilt("tilt", self.tilt)
        _check_count("event", self.event)
        _check_count("round", self.round)
        where = f"{self.quantity} after event {self.event} at {self.tilt:g} degrees"
        if not (math.isfinite(self.value) and 0.0 < self.uncertainty < math.inf):
            raise InputError(
                f"{where}: {self.value:g} m with an uncertainty of {self.uncertainty:g} m; needed "
                "are finite numbers, and a positive uncertainty"
            )
        if self.value <= 0 and self.quantity in POSITIVE_QUANTITIES:
            raise InputError(f"{where}: {self.value:g} m is not positive")
        if self.tilt < UNUSUAL_TILT:
            issue_note(f"tilt: {self.tilt:g} degrees is unusual; is it in radians?")
        if abs(self.value) > UNUSUAL_LENGTH:
            issue_note(f"{where}: {self.value:g} m is unusual; is it in centimetres?")
        if self.uncertainty > abs(self.value) and self.quantity in POSITIVE_QUANTITIES:
            issue_note(
                f"{where}: its uncertainty of {self.uncertainty:g} m is larger than the value of "
                f"{self.value:g} m; is it in another unit, or in percent?"
            )


def _check_tilt(name: str, tilt: float) -> None:
    """Refuse a tilt that no panel of an experiment has."""
    if not 0 <= tilt < MAX_TILT:
        raise InputError(f"{name}: {tilt:g} is outside the allowed range (0 to 90 degrees)")


def _check_count(name: str, number: float) -> None:
    """Refuse what cannot be the number of an event or of a round."""
    if not 1 <= number <= MAX_EVENT_NUMBER or number % 1:
        raise InputError(f"{name}: {number:g} is not a whole number from 1 to {MAX_EVENT_NUMBER}")


def measurements_template() -> str:
    """Return an empty measurements file for the tilts and events of the thesis's calibration.

    Examples
    --------
    >>> measurements_template().splitlines()[-1]
    '50,5,1,,,,,,,,'
    """
    rows = [
        ",".join([str(tilt), str(event), "1", *[""] * (len(COLUMNS) - 3)])
        for tilt in TEMPLATE_TILTS
        for event in range(1, TEMPLATE_EVENTS + 1)
    ]
    return "\n".join([TEMPLATE_HEADER + ",".join(COLUMNS), *rows, ""])


@checked
def read_measurements(file: Union[PathLike, pd.DataFrame]) -> list[Measurement]:
    r"""Read measured stacks from a CSV file; `measurements_template` describes its content.

    Parameters
    ----------
    file
        The file, or a DataFrame with the columns of such a file. Tilt, event and round may be in
        its index; missing values were not measured.

    Raises
    ------
    InputError
        If the file is wrong; the message has file, line (in a DataFrame the row), column, error
        and allowed values.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "stacks.csv"
    ...     _ = file.write_text("tilt_deg,event,height_m,height_std_m\n40,1,0.05,0.005\n")
    ...     [(one.quantity, one.value, one.line) for one in read_measurements(file)]
    [('height', 0.05, 2)]
    """
    table, name = _text_table(file)
    measurements: list[Measurement] = []
    seen: dict[tuple[float, int, int], str] = {}
    for row in table.rows:
        if any(row.cells.values()):
            measurements += _Row(row).measurements(seen)
    if not measurements:
        raise InputError(f"{name}: no measurement in it: all cells for measured values are empty")
    return measurements


def _text_table(file: Union[PathLike, pd.DataFrame]) -> tuple[TextTable, str]:
    """Return the checked table of texts and its name."""
    if isinstance(file, (str, os.PathLike)):
        hint = "`snowshed calibrate --template FILE` writes one to fill in"
        return read_text_table(Path(file), hint, _check_header), str(file)
    name = "the measurements"
    levels = [level for level in file.index.names if level in (*KEYS, ROUND)]
    table = frame_as_text(file.reset_index(levels) if levels else file, name)
    _check_header(table.columns, name)
    return table, name


def to_table(measurements: Sequence[Measurement]) -> pd.DataFrame:
    """Return measurements as a table, one row each: the fields of `Measurement`."""
    import pandas as pd

    return pd.DataFrame([vars(measurement) for measurement in measurements])


def _check_header(names: Sequence[str], where: str) -> None:
    for name in names:
        if name not in COLUMNS:
            raise InputError(
                f"{where}: {quoted(name)} is not a column; allowed: {', '.join(COLUMNS)} "
                "(separated by commas)"
            )
    for name in KEYS:
        if name not in names:
            raise InputError(f"{where}: no column {name}")
    measured = [q for q in QUANTITIES if measured_column(q) in names]
    if not measured:
        wanted = ", ".join(measured_column(quantity) for quantity in QUANTITIES)
        raise InputError(f"{where}: no column of a measured value; allowed: {wanted}")
    for quantity in measured:
        if uncertainty_column(quantity) not in names:
            raise InputError(
                f"{where}: no column {uncertainty_column(quantity)}, the uncertainty of "
                f"{measured_column(quantity)} (one standard deviation)"
            )


@dataclass(frozen=True)
class _Row:
    """One row of the file or the DataFrame, as measurements."""

    row: TableRow

    @property
    def cells(self) -> Mapping[str, str]:
        return self.row.cells

    def measurements(self, seen: dict[tuple[float, int, int], str]) -> list[Measurement]:
        """Return the measurements of the row; `seen` holds the place of every stack so far."""
        key = self._tilt(), self._whole_number("event"), self._whole_number(ROUND, 1)
        values = {quantity: self._value(quantity) for quantity in QUANTITIES}
        measurements = [
            Measurement(*key, quantity, *value, self.row.number, self.row.place)
            for quantity, value in values.items()
            if value is not None
        ]
        if measurements:
            earlier = seen.setdefault(key, self.row.place)
            if earlier != self.row.place:
                raise self._error(
                    f"tilt {key[0]:g}, event {key[1]}, round {key[2]} is in {earlier} "
                    "already; give repetitions another round"
                )
            self._check_ends(values)
        return measurements

    def _value(self, quantity: str) -> Optional[tuple[float, float]]:
        """Return the measured value and its uncertainty, or None if it was not measured."""
        column, uncertain = measured_column(quantity), uncertainty_column(quantity)
        if not self.cells.get(column):
            if self.cells.get(uncertain):
                raise self._error(f"{uncertain}: an uncertainty, although {column} is empty")
            return None
        value = self._number(column)
        if quantity in POSITIVE_QUANTITIES and value <= 0:
            raise self._error(f"{column}: {value:g} is not positive")
        if abs(value) > MAX_DISTANCE:
            raise self._error(f"{column}: {value:g} m; at most {MAX_DISTANCE:g} m are allowed")
        if not self.cells.get(uncertain):
            raise self._error(f"{uncertain}: missing; give one standard deviation of {column}")
        uncertainty = self._number(uncertain)
        if uncertainty <= 0:
            raise self._error(f"{uncertain}: {uncertainty:g} is not positive")
        return value, uncertainty

    def _check_ends(self, values: Mapping[str, Optional[tuple[float, float]]]) -> None:
        head, tail, length = values["head"], values["tail"], values["length"]
        if head is None or tail is None:
            return
        if tail[0] <= head[0]:
            raise self._error(f"tail_m: {tail[0]:g} is not beyond head_m, {head[0]:g}")
        if length is not None:
            between = tail[0] - head[0]
            if abs(between - length[0]) > MAX_LENGTH_DEVIATIONS * math.hypot(
                head[1], tail[1], length[1]
            ):
                raise self._error(
                    f"length_m: {length[0]:g} is not tail_m - head_m = {between:.4g}, even within "
                    f"{MAX_LENGTH_DEVIATIONS:g} standard deviations"
                )

    def _tilt(self) -> float:
        tilt = self._number("tilt_deg")
        with self._in_place():
            _check_tilt("tilt_deg", tilt)
        return tilt

    def _whole_number(self, column: str, default: int = 0) -> int:
        if default and not self.cells.get(column):
            return default
        number = self._number(column)
        with self._in_place():
            _check_count(column, number)
        return int(number)

    def _number(self, column: str) -> float:
        cell = self.cells[column]
        number = number_in(cell)
        if math.isnan(number):
            raise self._error(f"{column}: {quoted(cell)} is not a number")
        return number

    @contextmanager
    def _in_place(self) -> Iterator[None]:
        """Put the place of the row before the message of an error."""
        try:
            yield
        except InputError as error:
            raise self._error(str(error)) from None

    def _error(self, message: str) -> InputError:
        return InputError(f"{self.row.where}: {message}")
