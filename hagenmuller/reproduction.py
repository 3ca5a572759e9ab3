"""All stages of the reproduction, in its folder.

==================== ========================================================================
hagenmuller.html     the report
claims.csv           one row per claim: source, claim, rule, verdict, finding
samples/             the labels of the synthetic snow
runs/                the store of all loading tests
sensitivity/         tests, table and figure of what matters in the brittle phase
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
from snowshed.analysis.grains.variants import BASE
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

    def tests(self) -> list[pd.DataFrame]:
        """Return the computed tests of each stage, those that load further first.

        Raises
        ------
        InputError
            If none of a base is computed.
        """
        for stage in self.stages.values():
            stage.state()  # enters its study, also if another stage was asked for
        tables = [self.comparisons[name].table(self.runs) for name in reversed(list(MAKERS))]
        if not any(BASE in set(table["variant"]) for table in tables):
            raise InputError("no test of the base is computed yet")
        return tables

    def _maker(self, name: str) -> Callable[[], list[Study]]:
        return lambda: [self.comparisons[name].study()]
