"""All stages of the reproduction of the thesis."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Optional

from reproduction.stage import Stage, StudyStage

from snowshed.analysis.regression.dataset import geometry_table
from thesis import studies
from thesis.folder import ReproductionFolder
from thesis.regression_stage import GeometryRows, RegressionStage
from thesis.size import Size

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
