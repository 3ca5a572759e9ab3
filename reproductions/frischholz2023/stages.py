"""All stages of the reproduction of the thesis."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Optional

from reproductions.common.folder import ReproductionFolder
from reproductions.common.stage import Stage, StudyStage
from reproductions.frischholz2023 import studies
from reproductions.frischholz2023.regression_stage import GeometryRows, RegressionStage
from reproductions.frischholz2023.settings import Settings
from snowshed.analysis.regression.dataset import geometry_table
from snowshed.analysis.regression.rows import read_rows
from snowshed.methods.mpm.settings import Scheme
from snowshed.scene.components import Condition

#: Stages that are computed only with the scheme of the thesis.
THESIS_SCHEME_STAGES = ("deviations", "variations")
#: Stages of panels. Their particles are stored, so that stacks can be measured again.
PARTICLE_STAGES = ("deviations", "variations", "geometry")
MAKERS = {
    "lab": studies.lab,
    "s-index": studies.index,
    "fixation": studies.fixation,
    "calibration": studies.calibration,
    "deviations": studies.deviations,
    "variations": studies.variations,
    "geometry": studies.geometry,
}


class ThesisComputation:
    """The stages of a reproduction in its folder.

    Parameters
    ----------
    path, settings
        The folder, and the settings.
    table
        Rows of panels to use for chapter 5 instead of simulating them. Without it, a reproduction
        that simulates no panels takes the table of its scheme that comes with snowshed.
    """

    def __init__(self, path: Path, settings: Settings, table: Optional[Path]) -> None:
        self.folder = folder = ReproductionFolder(path)
        self.settings = settings
        if table is None and not settings.simulates_panels:
            table = geometry_table(scheme=settings.scheme)
        left_out = set() if settings.scheme == "thesis" else {*THESIS_SCHEME_STAGES}
        if table is not None:
            left_out.add("geometry")
        self.table = table
        self.study_stages = {
            name: StudyStage(
                name, folder.runs, partial(make, settings), keep_particles=name in PARTICLE_STAGES
            )
            for name, make in MAKERS.items()
            if name not in left_out
        }
        self.rows = GeometryRows(folder, table, self.study_stages.get("geometry"))
        self.regression = RegressionStage(folder, settings, self.rows)

    @property
    def stages(self) -> list[Stage]:
        """All stages, in order."""
        return [*self.study_stages.values(), self.regression]


def stages(
    folder: Path,
    settings: Settings,
    *,
    table: Optional[Path],
    condition: Condition,
    scheme: Scheme,
) -> ThesisComputation:
    """Return the computation with a contact condition of the panel and a scheme.

    Raises
    ------
    InputError
        If the table is wrong.
    """
    if table is not None:
        settings.folds.check(read_rows(table))
    settings = replace(settings, condition=condition, scheme=scheme)
    return ThesisComputation(folder, settings, table)
