"""The stage of section 5.3: its rows, and their regression."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Optional

from reproductions.common.folder import ReproductionFolder
from reproductions.common.stage import StageReporter, State, StudyStage
from reproductions.frischholz2023.settings import Settings
from reproductions.frischholz2023.studies import PANELS
from snowshed._core import InputError, available_cores
from snowshed.analysis.regression.folds import CrossValidation
from snowshed.analysis.regression.rows import StackRows, read_rows
from snowshed.base.progress import Progress, Reporter

KINDS = ("linear", "rbf")
TARGET = "ratio"
NAME = "regression"
#: Numbers of rows and of inner folds for which the cost of a fold is known.
KNOWN_ROWS, KNOWN_INNER = 610, 5


GEOMETRY_ROWS = "geometry.csv"  # the rows that were simulated for chapter 5


class GeometryRows:
    """The rows of chapter 5, from a table or from the simulated panels."""

    def __init__(
        self, folder: ReproductionFolder, table: Optional[Path], panels: Optional[StudyStage]
    ) -> None:
        self._folder = folder
        self.table = table
        self._panels = panels

    @property
    def file(self) -> Path:
        """The table of the rows."""
        return self._folder.path / GEOMETRY_ROWS if self.table is None else self.table

    def count(self) -> int:
        """Return the number of rows, computed or not."""
        if self._panels is None:
            return len(self.read())
        return self._panels.state().count * 5

    def read(self) -> StackRows:
        """Return the rows.

        Raises
        ------
        InputError
            If the table is invalid, or not all panels are simulated.
        """
        if self.table is not None:
            return read_rows(self.table)
        assert self._panels is not None
        state = self._panels.state()
        if not state.finished:
            raise InputError(f"stage geometry: {state.text()}")
        from snowshed.study.formats import export

        export(self._folder.runs, self.file, study=PANELS)
        return read_rows(self.file)


@dataclass(frozen=True)
class Part:
    """A regression of some rows.

    Attributes
    ----------
    rows, folder, scheme
        The rows, the folder of the results, and the folds.
    """

    rows: StackRows
    folder: Path
    scheme: CrossValidation

    @property
    def count(self) -> int:
        """Number of its outer folds."""
        return self.scheme.rounds * self.scheme.folds * len(KINDS)

    @property
    def done(self) -> int:
        """Number of computed folds; less than `count` until the tables are written."""
        done = len(list(self.folder.glob("folds/*/*/*.npz")))
        written = (self.folder / TARGET / "errors.csv").is_file()
        return done if written else min(done, self.count - 1)


class RegressionStage:
    """Nested cross-validation of the linear and the RBF kernel.

    If a row is the mean of several seeds, the rows of a single seed are regressed as well: the
    thesis has one stack for each row, and means scatter less.
    """

    name = NAME

    def __init__(self, folder: ReproductionFolder, settings: Settings, rows: GeometryRows) -> None:
        self._folder = folder
        self._settings = settings
        self._rows = rows

    def parts(self) -> list[Part]:
        """Return the regressions: of the rows of one seed, and of the means if there are any.

        Raises
        ------
        InputError
            If the rows are missing.
        """
        rows, scheme = self._rows.read(), self._settings.folds
        if rows.most_seeds == 1:
            return [self._part(rows, scheme)]
        fewer = replace(scheme, rounds=self._settings.one_seed_rounds)
        return [self._part(rows.of_one_seed(), fewer), self._part(rows, scheme)]

    def state(self) -> State:
        """Return its progress."""
        try:
            parts = self.parts()
        except InputError:
            scheme = self._settings.folds
            return State(0, 0, scheme.rounds * scheme.folds * len(KINDS), "folds")
        return State(
            sum(part.done for part in parts), 0, sum(part.count for part in parts), "folds"
        )

    def expected_s(self, jobs: Optional[int]) -> float:
        """Return the expected remaining time, s."""
        from snowshed.analysis.regression.kinds import kinds_named

        state = self.state()
        if state.finished:
            return 0.0
        per_fold = sum(kind.cost_s for kind in kinds_named(KINDS).values()) / len(KINDS)
        inner = self._settings.folds.inner_folds
        scale = inner / KNOWN_INNER * (self._rows.count() / KNOWN_ROWS) ** 2
        return (state.count - state.done) * per_fold * scale / (jobs or available_cores())

    def compute(self, jobs: Optional[int], report: StageReporter) -> None:
        """Compute the remaining folds; raises RegressionInterrupted after Ctrl-C.

        Raises
        ------
        InputError
            If the rows are missing.
        """
        from snowshed.analysis.regression.pipeline import regress

        parts = self.parts()
        total = sum(part.count for part in parts)
        for number, part in enumerate(parts):
            if part.done == part.count:
                continue
            before = sum(part.count for part in parts[:number])
            regress(
                part.rows,
                part.folder,
                targets=[TARGET],
                models=KINDS,
                scheme=part.scheme,
                jobs=jobs,
                progress=_folds_reporter(report, before, part.count, total),
            )

    def failure(self) -> str:
        """Return an empty text, because a fold that fails ends the command."""
        return ""

    def _part(self, rows: StackRows, scheme: CrossValidation) -> Part:
        """Return a part, whose folder depends on its rows and folds."""
        name = f"{NAME}-{rows.digest[:8]}"
        return Part(rows, self._folder.of_stage(name), scheme)


def _folds_reporter(report: StageReporter, before: int, count: int, total: int) -> Reporter:
    def report_folds(progress: Progress) -> None:
        done = before + progress.done
        report((before + progress.fraction * count) / total, f"{NAME}: {done}/{total} folds")

    return report_folds
