"""The stages of the reproduction in its folder.

==================== ========================================================================
hagenmuller.html     the report
claims.csv           one row per claim: source, claim, rule, verdict, finding
samples/             the labels of the synthetic snow
runs/                the store of all loading tests
sensitivity/         tests, table and figure of the sensitivity in the brittle phase
==================== ========================================================================
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from pathlib import Path

from reproductions.common.folder import ReproductionFolder
from reproductions.common.stage import StudyStage
from reproductions.hagenmuller2015.claims import LoadingTests
from reproductions.hagenmuller2015.snows import Samples
from reproductions.hagenmuller2015.studies import MAKERS, Comparisons
from snowshed._core import InputError
from snowshed.analysis.grains.variants import BASE
from snowshed.study.definition import Study


class GrainsComputation:
    """The stages of a reproduction in its folder.

    Parameters
    ----------
    path, samples
        The folder, and the size and number of the samples.
    """

    def __init__(self, path: Path, samples: Samples) -> None:
        self.folder = ReproductionFolder(path)
        self.comparisons = Comparisons(samples, path / "samples")
        self.stages = [
            StudyStage(name, self.folder.runs, self._maker(name), keep_particles=name == "elastic")
            for name in MAKERS
        ]

    @cached_property
    def tests(self) -> LoadingTests:
        """The computed tests of each stage; read it when everything is computed.

        Raises
        ------
        InputError
            If no test of the base is computed yet.
        """
        for stage in self.stages:
            stage.state()  # enters its study, even if another stage was requested
        runs = self.folder.runs
        tables = [self.comparisons[name].table(runs) for name in reversed(list(MAKERS))]
        if not any(BASE in set(table["variant"]) for table in tables):
            raise InputError("no test of the base is computed yet")
        return LoadingTests(tables)

    def _maker(self, name: str) -> Callable[[], list[Study]]:
        return lambda: [self.comparisons[name].study()]
