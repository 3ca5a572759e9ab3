"""All stages of the reproduction, in its folder.

==================== ========================================================================
hagenmuller.html     the report
claims.csv           one row per claim: source, claim, rule, verdict, finding
samples/             the labels of the synthetic snow
runs/                the store of all loading tests
sensitivity/         tests, table and figure of what matters
==================== ========================================================================
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from reproduction.stage import StudyStage

from hagenmuller.size import Size
from hagenmuller.studies import MAKERS, Comparisons
from snowshed._core import InputError
from snowshed.study.definition import Study

if TYPE_CHECKING:
    import pandas as pd


class Reproduction:
    """The stages of a reproduction.

    Parameters
    ----------
    folder, size
        Where, and how much.
    """

    def __init__(self, folder: Path, size: Size) -> None:
        self.folder = folder
        self.size = size
        self.comparisons = Comparisons(size, folder / "samples")
        self.stages = {
            name: StudyStage(name, self.runs, self._maker(name), keep_particles=name == "elastic")
            for name in MAKERS
        }

    @property
    def runs(self) -> Path:
        """The store."""
        return self.folder / "runs"

    def tests(self) -> pd.DataFrame:
        """Return all computed tests; those of the base once.

        Raises
        ------
        InputError
            If none of the base is computed.
        """
        import pandas as pd

        for stage in self.stages.values():
            stage.state()  # enters its study, also if another stage was asked for
        tables = [self.comparisons[name].table(self.runs) for name in MAKERS]
        rows = pd.concat([one for one in tables if len(one)] or tables[:1])
        if "base" not in set(rows["variant"]):
            raise InputError("no test of the base is computed yet")
        return rows.drop_duplicates(["variant", "sample", "hash"], ignore_index=True)

    def _maker(self, name: str) -> Callable[[], list[Study]]:
        return lambda: [self.comparisons[name].study()]
