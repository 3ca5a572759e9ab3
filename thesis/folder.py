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

from dataclasses import dataclass
from pathlib import Path

from reproduction.folder import claim_folder


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
        identity = {"publication": "thesis", "size": size, "condition": condition}
        claim_folder(path, identity, {"publication": "thesis", "condition": "separate"})
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
