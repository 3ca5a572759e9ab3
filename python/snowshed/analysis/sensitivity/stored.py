"""A stored study for sensitivity analysis: points, and the stacks measured at each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.study.factors import SEED
from snowshed.study.stack_table import StackTable

if TYPE_CHECKING:
    import pandas as pd

TARGETS = ("height", "length")


@dataclass(frozen=True)
class StudyRuns:
    """The runs of a study.

    Attributes
    ----------
    name
        Name of the study.
    axes
        Dotted paths of the parameters with several values, in the study's order; with the seed only
        if it is an axis of the study.
    points
        One row per run in the study's order, computed or not: ``hash``, the axes, and
        ``seeding.seed``.
    rows
        One row per computed run and event: the columns of `points`, ``event``, and ``height`` and
        ``length`` of the stack in m.
    """

    name: str
    axes: Sequence[str]
    points: pd.DataFrame
    rows: pd.DataFrame

    @property
    def parameters(self) -> list[str]:
        """The axes with more than one value, without the seed."""
        return [path for path in self.axes if path != SEED and self.points[path].nunique() > 1]

    @property
    def incomplete(self) -> int:
        """Number of runs that lack the stack of some event."""
        measured = self.rows["hash"].value_counts().reindex(self.points["hash"], fill_value=0)
        return int((measured < len(self.events)).sum())

    @property
    def events(self) -> list[int]:
        """The events that were measured."""
        return sorted(int(event) for event in self.rows["event"].unique())


@checked
def read_study_runs(
    folder: PathLike, study: Optional[str] = None, measure: str = "stack"
) -> StudyRuns:
    """Read the computed runs of a study.

    Parameters
    ----------
    folder
        Folder of the store, or a table that ``snowshed study export`` wrote.
    study
        Name of the study; not needed if the store holds only one.
    measure
        "stack": height and length of 97 % of the snow, as the thesis measures; "body": of the
        largest connected body.

    Raises
    ------
    InputError
        If there is no such study, none of its runs is computed, or an axis does not hold numbers.
    """
    table = StackTable.read(folder, study)
    try:
        return stored_runs(table, measure)
    except InputError as error:
        raise InputError(f"{folder}: {table.name}: {error}") from None


def stored_runs(table: StackTable, measure: str = "stack") -> StudyRuns:
    """Return the runs in a table of stacks."""
    table.check_hashes()
    measured = table.measured(measure, TARGETS)[["hash", "event", *TARGETS]]
    varying = table.varying(table.axes, "sensitivity")
    axes = tuple(path for path in table.axes if path == SEED or path in varying)
    return StudyRuns(table.name, axes, table.points, table.points.merge(measured, on="hash"))
