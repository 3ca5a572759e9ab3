"""The folder of a reproduction.

==================== ========================================================================
thesis.html          the report
claims.csv           one row per claim: source, claim, rule, verdict, finding
reproduction.json    what the folder is for: quick, middle or full, and the panel's condition
runs/                the store of all simulations
s-index/ ...         tables and figures of the stages
geometry.csv         the rows that are regressed
==================== ========================================================================
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from snowshed._core import InputError
from snowshed.io.atomic import write_text
from snowshed.io.json_file import read_object

IDENTITY = "reproduction.json"


@dataclass(frozen=True)
class ReproductionFolder:
    """The files in a reproduction's folder; use `claim`."""

    path: Path

    @classmethod
    def claim(cls, path: Path, size: str, condition: str = "separate") -> ReproductionFolder:
        """Open a folder, old or new, for a reproduction of a size with a condition of the panel.

        Raises
        ------
        InputError
            If it holds a reproduction of another size or condition, or something else.
        """
        file = path / IDENTITY
        if file.is_file():
            there = {"condition": "separate", **read_object(file)}
            if there.get("size") != size:
                raise InputError(
                    f"{path}: holds a reproduction with --{there.get('size')}; "
                    f"take a new folder for --{size}"
                )
            if there["condition"] != condition:
                raise InputError(
                    f"{path}: holds a reproduction with --condition {there['condition']}; "
                    f"take a new folder for --condition {condition}"
                )
        elif path.exists() and (not path.is_dir() or any(path.iterdir())):
            raise InputError(f"{path}: not empty, and holds no reproduction")
        else:
            path.mkdir(parents=True, exist_ok=True)
            write_text(file, json.dumps({"size": size, "condition": condition}) + "\n")
        return cls(path)

    @property
    def runs(self) -> Path:
        """The store."""
        return self.path / "runs"

    @property
    def report(self) -> Path:
        """The report."""
        return self.path / "thesis.html"

    @property
    def claims(self) -> Path:
        """The claims as a table."""
        return self.path / "claims.csv"

    @property
    def geometry_rows(self) -> Path:
        """The rows that were simulated for chapter 5."""
        return self.path / "geometry.csv"

    def of_stage(self, name: str) -> Path:
        """Return the folder of a stage's tables and figures."""
        return self.path / name
