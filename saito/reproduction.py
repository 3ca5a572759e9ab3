"""All cases of the reproduction, in its folder.

==================== ========================================================================
saito.html           the report
claims.csv           one row per claim: source, claim, rule, verdict, finding
cases/               the snow of each case at all times, and a checkpoint
==================== ========================================================================
"""

from __future__ import annotations

from pathlib import Path

from saito.cases import cases
from saito.claims import Courses
from saito.measures import Course
from saito.runs import CaseStage
from saito.size import Size


class Reproduction:
    """The cases of a reproduction.

    Parameters
    ----------
    folder, size
        Where, and how much.
    """

    def __init__(self, folder: Path, size: Size) -> None:
        self.folder = folder
        self.size = size
        made = [CaseStage(case, folder / "cases") for case in cases(size)]
        self.stages = {stage.name: stage for stage in made}

    def courses(self) -> Courses:
        """Return the cases that are complete."""
        return Courses(
            {
                stage.case.name: Course.of(stage.case, stage.snow())
                for stage in self.stages.values()
                if stage.state().done == stage.state().count
            }
        )

    def failures(self) -> list[str]:
        """Return what failed, and why."""
        return [
            f"{stage.case.name}: {stage.failure()}"
            for stage in self.stages.values()
            if stage.failure()
        ]
