"""A stored study as sensitivity analysis reads it: points, and what was measured at each."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

from snowshed._core import InputError
from snowshed.scene.scene import PathLike
from snowshed.study.factors import SEED

if TYPE_CHECKING:
    import pandas as pd

TARGETS = ("height", "length")
#: Columns of a study's table by what counts as the stack.
MEASURES: Mapping[str, Mapping[str, str]] = {
    "stack": {"height": "height_m", "length": "length_m"},
    "body": {"height": "body_height_m", "length": "body_length_m"},
}


@dataclass(frozen=True)
class StoredRuns:
    """The runs of a study.

    Attributes
    ----------
    name
        Of the study.
    axes
        Dotted paths of what has several values, in the study's order; the seed only if it is
        among its axes.
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
        """The axes that have more than one value, the seed not among them."""
        return [path for path in self.axes if path != SEED and self.points[path].nunique() > 1]

    @property
    def incomplete(self) -> int:
        """How many runs lack the stack of some event."""
        measured = self.rows["hash"].value_counts().reindex(self.points["hash"], fill_value=0)
        return int((measured < len(self.events)).sum())

    @property
    def events(self) -> list[int]:
        """The events that were measured."""
        return sorted(int(event) for event in self.rows["event"].unique())


def read_stored(
    folder: PathLike, study: Optional[str] = None, measure: str = "stack"
) -> StoredRuns:
    """Read a study from its store, as far as it is computed.

    Parameters
    ----------
    folder
        Where the store is.
    study
        Name of the study; not needed if the store holds but one.
    measure
        "stack": height and length of 97 % of the snow, as the thesis measures; "body": of the
        largest connected body.

    Raises
    ------
    InputError
        If there is no such study, nothing of it is computed, or an axis does not hold numbers.
    """
    from snowshed.study.store import Store
    from snowshed.study.table import read_table

    if measure not in MEASURES:
        raise InputError(f"measure: {measure!r} is unknown; allowed: {', '.join(MEASURES)}")
    with Store.open(folder) as store:
        name = store.named(study)
        axes = store.axes(name)
        runs = store.runs(name)
    points = _points(axes, {run.hash: json.loads(run.scene) for run in runs})
    table = read_table(folder, name)
    try:
        return stored_runs(name, axes, points, table, measure)
    except InputError as error:
        raise InputError(f"{folder}: {name}: {error}") from None


def stored_runs(
    name: str, axes: Sequence[str], points: pd.DataFrame, table: pd.DataFrame, measure: str
) -> StoredRuns:
    """Return a study from its points and its table; for the columns see `StoredRuns`."""
    from snowshed.study.table import varying_numbers

    varying = varying_numbers(points, axes, "sensitivity")
    axes = [path for path in axes if path == SEED or path in varying]
    columns = {column: target for target, column in MEASURES[measure].items()}
    measured = table[["hash", "event", *columns]].rename(columns=columns).dropna()
    if measured.empty:
        raise InputError("nothing of it is computed yet; see `snowshed study status`")
    return StoredRuns(name, tuple(axes), points, points.merge(measured, on="hash"))


def _points(axes: Sequence[str], scenes: Mapping[str, Mapping[str, Any]]) -> pd.DataFrame:
    import pandas as pd

    from snowshed.study.table import value_at

    paths = list(dict.fromkeys([*axes, SEED]))
    rows = [
        {"hash": hash_, **{path: value_at(scene, path) for path in paths}}
        for hash_, scene in scenes.items()
    ]
    return pd.DataFrame(rows, columns=["hash", *paths])
