"""File of measurements, to which lines are appended.

Every measurement is written as soon as it is made, so an interrupted suite neither loses nor
repeats a measurement.
"""

from __future__ import annotations

import json
from pathlib import Path

from snowshed.io.input_file import read_regular
from snowshed.io.json_file import parse_object
from snowshed.snow.accuracy.measurements import MeasuredSolution


class MeasurementFile:
    """Measurements as JSON lines; a last line that a crash has truncated is ignored.

    Parameters
    ----------
    path
        The file; it need not exist.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.snow.accuracy.measurements import Measured
    >>> with TemporaryDirectory() as folder:
    ...     file = MeasurementFile(Path(folder) / "m.jsonl")
    ...     file.append(MeasuredSolution("bar", {"dx": 0.1}, [Measured("height", 0.9, 1.0, -0.1)]))
    ...     [measurement.case for measurement in file.read()]
    ['bar']
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    def read(self) -> list[MeasuredSolution]:
        """Return all measurements, in the order in which they were made.

        Raises
        ------
        InputError
            If a complete line is not a measurement; the error names file and line.
        """
        lines = self._content().split(b"\n")[:-1]
        locations = [f"{self.path}:{number}" for number in range(1, len(lines) + 1)]
        return [
            MeasuredSolution.from_json(parse_object(line, where), where)
            for line, where in zip(lines, locations)
        ]

    def append(self, measurement: MeasuredSolution) -> None:
        """Append a measurement to the file on disk."""
        line = json.dumps(measurement.to_json(), allow_nan=False) + "\n"
        try:
            with self.path.open("ab") as file:
                file.truncate(len(self._content()))
                file.write(line.encode())
        except OSError as error:  # errors of writing do not name the file
            error.filename = error.filename or str(self.path)
            raise

    def _content(self) -> bytes:
        """Return the content of the file up to the end of its last complete line."""
        data = read_regular(self.path) if self.path.exists() else b""
        return data[: data.rfind(b"\n") + 1]
