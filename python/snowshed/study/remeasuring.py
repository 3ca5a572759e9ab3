"""Measuring the stacks of a study again, from the particles in its store."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.field_type import shown
from snowshed.base.paths import PathLike
from snowshed.results.event_particles import EventParticles
from snowshed.results.folder import measured_columns
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, check_trimming
from snowshed.study.store import Store
from snowshed.study.table import read_table

if TYPE_CHECKING:
    import pandas as pd

#: Function from the particles after an event to columns of the table.
Measuring = Callable[[EventParticles], Mapping[str, object]]


@checked
def remeasure(
    folder: PathLike,
    study: Optional[str] = None,
    *,
    trimming: str = DEFAULT_TRIMMING,
    measure: Optional[Measuring] = None,
) -> pd.DataFrame:
    """Measure the stacks of a study again, and return its table.

    Particles are stored in single precision, so that the last digits of a measure may differ from
    the measure during the run.

    Parameters
    ----------
    folder
        Folder of the store.
    study
        Name of the study; not needed if the store holds a single one.
    trimming
        Trimming rule of A.4.2 for the columns without a prefix.
    measure
        Function that returns further columns for an event, or replaces some.

    Returns
    -------
    pandas.DataFrame
        As `read_table` returns it.

    Raises
    ------
    InputError
        If there is no such study or trimming rule, the store is damaged, or particles of a stack
        are missing because the study was computed without `keep_particles`.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene
    >>> from snowshed.study import Study
    >>> scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.03})
    >>> scene = scene.update({"events": {"count": 1, "max_time": 0.5}})
    >>> with TemporaryDirectory() as folder:
    ...     _ = Study(scene).run(folder, jobs=1, keep_particles=True)
    ...     table = remeasure(folder, measure=lambda found: {"count": len(found.masses)})
    >>> bool(table["count"][0] > 0), table["trimming"][0]
    (True, 'outermost_first')
    """
    check_trimming(trimming)
    table = read_table(folder, study)
    if "trimming" not in table:
        raise InputError(f"{folder}: the runs of this study make no stacks")
    rows = {
        (row["hash"], int(row["event"])): index
        for index, row in table.iterrows()
        if isinstance(row["trimming"], str)  # a run that failed has a row without a stack
    }
    measures: dict[Any, dict[str, Any]] = {}
    with Store.open(folder) as store:
        for hash_ in table["hash"].unique():
            for event, data in store.particles(hash_).items():
                if (hash_, event) in rows:
                    particles = _unpacked(store, hash_, event, data)
                    more = measure(particles) if measure else {}
                    if not isinstance(more, Mapping):
                        raise InputError(
                            f"measure: the function returned {shown(more)}; needed: a dict of "
                            "columns"
                        )
                    columns = measured_columns(particles.measure(trimming))
                    measures[rows[hash_, event]] = {**columns, **more}
    if len(measures) < len(rows):
        raise InputError(
            f"{folder}: no particles of {len(rows) - len(measures)} of {len(rows)} stacks; "
            "their runs were computed without keep_particles"
        )
    return _with_measures(table, measures)


def _unpacked(store: Store, hash_: str, event: int, data: bytes) -> EventParticles:
    try:
        return EventParticles.unpacked(data)
    except InputError as error:
        raise store.damaged(f"run {hash_}, event {event}: {error}") from None


def _with_measures(table: pd.DataFrame, measures: Mapping[Any, Mapping[str, Any]]) -> pd.DataFrame:
    """Return the table with the new measures of its rows."""
    import pandas as pd

    new = pd.DataFrame.from_dict(dict(measures), orient="index").reindex(table.index)
    return table.assign(**{str(name): new[name] for name in new})
