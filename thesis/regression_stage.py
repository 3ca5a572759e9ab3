"""The stage of section 5.3: where its rows come from, and the regression of them."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.analysis.regression.rows import StackRows, read_rows
from snowshed.run.pool import available_cores
from snowshed.run.progress import Progress, Reporter
from thesis.folder import ReproductionFolder
from thesis.size import Size
from thesis.stage import StageReporter, State, StudyStage
from thesis.studies import PANELS

KINDS = ("linear", "rbf")
TARGET = "ratio"
NAME = "regression"
#: For the estimate of costs: rows for which the cost of a fold is known, and its inner folds.
KNOWN_ROWS, KNOWN_INNER = 610, 5


class GeometryRows:
    """The rows of chapter 5: out of a table, or of the panels that were simulated."""

    def __init__(
        self, folder: ReproductionFolder, table: Optional[Path], panels: Optional[StudyStage]
    ) -> None:
        self._folder = folder
        self.table = table
        self._panels = panels

    @property
    def file(self) -> Path:
        """The table of the rows."""
        return self._folder.geometry_rows if self.table is None else self.table

    def count(self) -> int:
        """Return how many rows there are, or will be."""
        if self._panels is None:
            return len(self.read())
        return self._panels.state().count * 5

    def read(self) -> StackRows:
        """Return the rows.

        Raises
        ------
        InputError
            If the table is wrong, or not all panels are simulated.
        """
        if self.table is not None:
            return read_rows(self.table)
        assert self._panels is not None
        state = self._panels.state()
        if not state.finished:
            raise InputError(f"stage geometry: {state.in_words()}")
        from snowshed.study.formats import export

        export(self._folder.runs, self._folder.geometry_rows, study=PANELS)
        return read_rows(self._folder.geometry_rows)


class RegressionStage:
    """Nested cross-validation of the linear and the RBF kernel."""

    name = NAME

    def __init__(self, folder: ReproductionFolder, size: Size, rows: GeometryRows) -> None:
        self._folder = folder
        self._size = size
        self._rows = rows

    def results(self) -> Path:
        """Return where the results of these rows are; other rows have another folder.

        Raises
        ------
        InputError
            If the rows are not there.
        """
        return self._folder.of_stage(f"{NAME}-{self._rows.read().digest[:8]}")

    def state(self) -> State:
        """Return how far it is."""
        scheme = self._size.folds
        count = scheme.rounds * scheme.folds * len(KINDS)
        try:
            folder = self.results()
        except InputError:
            return State(0, 0, count, "folds")
        done = len(list(folder.glob("folds/*/*/*.npz")))
        written = (folder / TARGET / "errors.csv").is_file()
        return State(done if written else min(done, count - 1), 0, count, "folds")

    def expected_s(self, jobs: Optional[int]) -> float:
        """Return how long what is left is expected to take, s."""
        from snowshed.analysis.regression.kinds import kinds_named

        state = self.state()
        if state.finished:
            return 0.0
        scheme = self._size.folds
        per_fold = sum(kind.cost_s for kind in kinds_named(KINDS).values())
        scale = scheme.inner_folds / KNOWN_INNER * (self._rows.count() / KNOWN_ROWS) ** 2
        left = 1 - state.done / state.count
        return left * per_fold * scale * scheme.rounds * scheme.folds / (jobs or available_cores())

    def compute(self, jobs: Optional[int], report: StageReporter) -> None:
        """Regress what is left; raises RegressionInterrupted after Ctrl-C.

        Raises
        ------
        InputError
            If the rows are not there.
        """
        if self.state().finished:
            return
        from snowshed.analysis.regression.pipeline import regress

        regress(
            self._rows.read(),
            self.results(),
            targets=[TARGET],
            models=KINDS,
            scheme=self._size.folds,
            jobs=jobs,
            progress=_told(report),
        )


def _told(report: StageReporter) -> Reporter:
    def tell(progress: Progress) -> None:
        report(progress.fraction, f"{NAME}: {progress.done}/{progress.count} folds")

    return tell
