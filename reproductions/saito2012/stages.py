"""The stages of the reproduction in its folder, one for each case.

==================== ========================================================================
saito.html           the report
claims.csv           one row per claim: source, claim, rule, verdict, finding
cases/               the snow of each case at all times, and a checkpoint
==================== ========================================================================
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

from reproductions.saito2012.cases import Resolution, cases
from reproductions.saito2012.claims import CaseHistories
from reproductions.saito2012.measures import CaseHistory
from reproductions.saito2012.runs import CaseStage


class AvalancheComputation:
    """The cases of a reproduction in its folder.

    Parameters
    ----------
    folder, resolution
        The folder, and the resolution of the cases.
    """

    def __init__(self, folder: Path, resolution: Resolution) -> None:
        self.stages = [CaseStage(case, folder / "cases") for case in cases(resolution)]

    @cached_property
    def histories(self) -> CaseHistories:
        """The complete cases; read it when everything is computed."""
        return CaseHistories(
            {
                stage.case.name: CaseHistory.of(stage.case, stage.snow())
                for stage in self.stages
                if stage.state().complete
            }
        )
