"""All stages of the reproduction of the thesis, and computing them one after another."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Optional

from snowshed.analysis.regression.dataset import geometry_table
from snowshed.run.progress import Progress, Reporter
from thesis import studies
from thesis.folder import ReproductionFolder
from thesis.regression_stage import GeometryRows, RegressionStage
from thesis.size import Size
from thesis.stage import Stage, StudyStage

#: Stages of panels, whose measure is in doubt: their particles are kept.
KEPT = ("deviations", "variations", "geometry")
MAKERS = {
    "lab": studies.lab,
    "s-index": studies.index,
    "fixation": studies.fixation,
    "calibration": studies.calibration,
    "deviations": studies.deviations,
    "variations": studies.variations,
    "geometry": studies.geometry,
}


class Reproduction:
    """The stages of a reproduction in its folder.

    Parameters
    ----------
    folder, size
        Where, and how much.
    table
        Rows of panels to use for chapter 5 instead of simulating them. Without it, a quick
        reproduction takes the table that comes with snowshed.
    """

    def __init__(self, folder: ReproductionFolder, size: Size, table: Optional[Path]) -> None:
        self.folder = folder
        self.size = size
        if table is None and not size.simulates_panels:
            table = geometry_table()
        self.table = table
        self.study_stages = {
            name: StudyStage(name, folder.runs, partial(make, size), keep_particles=name in KEPT)
            for name, make in MAKERS.items()
            if name != "geometry" or table is None
        }
        self.rows = GeometryRows(folder, table, self.study_stages.get("geometry"))
        self.regression = RegressionStage(folder, size, self.rows)

    @property
    def stages(self) -> list[Stage]:
        """All stages, in order."""
        return [*self.study_stages.values(), self.regression]


def compute(
    stages: Sequence[Stage], *, jobs: Optional[int] = None, progress: Optional[Reporter] = None
) -> None:
    """Compute what is left of some stages.

    Parameters
    ----------
    stages
        From `thesis.stage.choose`.
    jobs
        Processes at once; None: as many as there are cores.
    progress
        Called a few times a second.

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C (StudyInterrupted, RegressionInterrupted); what is done is kept.
    InputError, StudyError
        If a stage cannot be computed.
    """
    expected = [stage.expected_s(jobs) for stage in stages]
    whole = sum(expected) or 1.0
    for number, stage in enumerate(stages):
        before = sum(expected[:number])

        def tell(fraction: float, doing: str, number: int = number, before: float = before) -> None:
            if progress is not None:
                done = (before + fraction * expected[number]) / whole
                count = len(stages)
                progress(Progress(done, number, count, "stages", doing, expected_s=whole))

        stage.compute(jobs, tell)
