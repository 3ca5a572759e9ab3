"""Recorded accuracy: measurements in the package from which ``--accuracy`` chooses.

They were made by the full suite of the folder ``validation`` in the source of snowshed::

    python -m validation --full --record python/snowshed/snow/accuracy/recorded.json -o out

Their durations also say how long a suite will take.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Optional

from snowshed.io.atomic import write_text
from snowshed.io.json_file import check_values, read_object
from snowshed.snow.accuracy.measurements import MeasuredSolution

PACKAGED_FILE = Path(__file__).with_name("recorded.json")


def load_recorded(path: Optional[Path] = None) -> list[MeasuredSolution]:
    """Return recorded measurements, by default those of the package; empty without a file.

    Raises
    ------
    InputError
        If the file holds anything else.

    Examples
    --------
    >>> load_recorded(Path("nowhere.json"))
    []
    """
    path = path or PACKAGED_FILE
    if not path.exists():
        return []
    data = read_object(path)
    check_values(data, {"measurements": list}, str(path))
    return [
        MeasuredSolution.from_json(measurement, f"{path}: /measurements/{i}")
        for i, measurement in enumerate(data["measurements"])
    ]


def record(measurements: Iterable[MeasuredSolution], path: Path) -> None:
    """Store measurements in a file; earlier ones of the same cases are replaced, others stay.

    Failed measurements are not kept.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "recorded.json"
    ...     for case, dx in (("bar", 0.2), ("disc", 0.1), ("bar", 0.1)):
    ...         record([MeasuredSolution(case, {"dx": dx}, [])], path)
    ...     [one.key for one in load_recorded(path)]
    ['disc {"dx": 0.1}', 'bar {"dx": 0.1}']
    """
    new = [measurement for measurement in measurements if not measurement.failure]
    cases = {measurement.case for measurement in new}
    earlier = [measurement for measurement in load_recorded(path) if measurement.case not in cases]
    lines = ",\n".join(
        json.dumps(measurement.to_json(), allow_nan=False) for measurement in earlier + new
    )
    write_text(path, f'{{"measurements": [\n{lines}\n]}}\n')
