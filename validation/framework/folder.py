"""Folder of a validation while its cases are measured.

==================== ========================================================================
measurements.jsonl   every measurement, written as soon as it is made
stress.json          the runs of the stress suite, once it has ended
==================== ========================================================================

`validation.report` adds the report.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

from snowshed import _core
from snowshed._core import InputError
from snowshed.io.atomic import remove_leftovers, write_text
from snowshed.io.folders import check_empty
from snowshed.io.json_file import check_values, read_object
from validation.framework.measurement_file import MeasurementFile

if TYPE_CHECKING:
    import pandas as pd


class ValidationFolder:
    """Folder of a validation; `create` and `reopen` return one.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as path:
    ...     ValidationFolder.create(Path(path)).measurements.read()
    []
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.measurements = MeasurementFile(path / "measurements.jsonl")
        self._stress = path / "stress.json"

    @classmethod
    def create(cls, path: Path) -> ValidationFolder:
        """Make a new folder and return it; raise InputError if the folder is not empty."""
        check_empty(path)
        path.mkdir(parents=True, exist_ok=True)
        folder = cls(path)
        folder.measurements.path.touch()
        return folder

    @classmethod
    def reopen(cls, path: Path) -> ValidationFolder:
        """Return the folder of an earlier validation; raise InputError if there is none."""
        folder = cls(path)
        remove_leftovers(path)
        if not folder.measurements.path.is_file():
            raise InputError(f"{path}: nothing to resume; it holds no measurements.jsonl")
        return folder

    def keep_stress(self, runs: pd.DataFrame, *, full: bool, seed: int) -> None:
        """Write the runs of a stress suite."""
        records = json.loads(runs.to_json(orient="records", double_precision=15))
        stored = {**_identity(full, seed), "digest": _digest(records), "runs": records}
        write_text(self._stress, json.dumps(stored) + "\n")

    def kept_stress(self, *, full: bool, seed: int) -> Optional[pd.DataFrame]:
        """Return the stored runs of this stress suite, or None without stored runs.

        Raises
        ------
        InputError
            If the file does not hold what `keep_stress` wrote.
        """
        import pandas as pd

        if not self._stress.exists():
            return None
        stored = read_object(self._stress)
        check_values(stored, {"runs": list}, str(self._stress))
        digest, runs = stored.pop("digest", None), stored.pop("runs")
        if stored != _identity(full, seed) or digest is None:  # other suite or version
            return None
        if digest != _digest(runs):
            raise InputError(f"{self._stress}: damaged: /runs is not what was written")
        return pd.DataFrame(runs)


def _digest(records: list[dict[str, Any]]) -> str:
    """Return the checksum of runs, which reveals damage."""
    return hashlib.sha256(json.dumps(records, sort_keys=True).encode()).hexdigest()


def _identity(full: bool, seed: int) -> dict[str, Any]:
    return {"version": _core.version, "full": full, "seed": seed}
