"""The table of a study: one row per run and event."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional

from snowshed.base.arguments import checked
from snowshed.base.messages import shortened
from snowshed.base.paths import PathLike
from snowshed.io.json_file import is_number
from snowshed.methods.registry import method_of
from snowshed.scene.accuracy_settings import NUMBERS, accuracy_of
from snowshed.scene.resolved import scene_data
from snowshed.scene.schema import current_path, with_current_names
from snowshed.snow.stack.quantities import MEASURES, QUANTITIES
from snowshed.study.database import MEASURE_COLUMNS, STORED_TYPES, TIMING
from snowshed.study.factors import SEED
from snowshed.study.store import Store, StoredRun
from snowshed.study.table_origin import column_units, table_origin

if TYPE_CHECKING:
    import pandas as pd

#: Trimming rule of A.4.2 in tables from before they named it.
FORMER_TRIMMING = "equal_pace"
FAILED = "failed"  # value of the column `ended` for the event at which a run failed
RUN_TIMING = tuple(TIMING)


@checked
def read_table(
    folder: PathLike, study: Optional[str] = None, *, timing: bool = False
) -> pd.DataFrame:
    """Read the table of a study; runs that are not computed yet are missing in it.

    The table depends on the runs alone. Their order, interruptions and the number of workers do not
    change it.

    Parameters
    ----------
    folder
        Folder of the store.
    study
        Name of the study; not needed if the store holds only one.
    timing
        Whether to add the columns that differ when a run is repeated: ``wall_s`` (of the event),
        ``run_wall_s``, ``threads``, ``particles``, ``particle_updates``, ``peak_memory_mb``,
        ``host``, ``cpu`` and ``finished``.

    Returns
    -------
    pandas.DataFrame
        One row per run and event, runs in the study's order: ``hash`` of the run; the parameters
        that vary, by their dotted paths; ``seed``; ``event``; the measures of the method, such as
        the columns of events.csv or the figures of a slide; ``error``; ``notes`` on the run, joined
        by "; "; ``version`` and ``build`` of snowshed; ``dimension``; and the accuracy settings
        (``dx``, ``precision``, ...). A run that failed has, after its completed events, a row
        without measures whose ``ended`` is "failed" and whose ``error`` says why. Its `attrs` have
        ``units`` by column, and ``snowshed_version`` and ``snowshed_build``, each a list if the
        runs have several.

    Raises
    ------
    InputError
        If there is no such study, or the store is damaged.
    """
    import pandas as pd

    with Store.open(folder) as store:
        name = store.named(study)
        rows = list(_rows(store, name))
        axes = store.axes(name)
        scenes = [scene_data(run.scene) for run in store.runs(name)] or [{}]
    measured = [column for scene in scenes for column in MEASURE_COLUMNS[method_of(scene).name]]
    settings = [column for scene in scenes for column in accuracy_of(scene)]
    columns = ["hash", *axes, "seed", "event", *measured, "error", "notes", "version", "build"]
    columns += ["dimension", *settings, *(("wall_s", *RUN_TIMING) if timing else ())]
    table = pd.DataFrame(rows, columns=list(dict.fromkeys(columns)))  # axes may be among them
    types: dict[str, Any] = {
        **dict.fromkeys(_columns_of_type("INTEGER"), "Int64"),
        **dict.fromkeys(NUMBERS, float),
    }
    for column in measured:
        if column not in types and table[column].isna().all():  # a table without any stack
            types[column] = float
    table = with_trimming(table.astype({k: v for k, v in types.items() if k in table}))
    table.attrs.update({"units": column_units(table), **table_origin(table)})
    return table


def with_trimming(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table whose rows all name their trimming rule of A.4.2.

    Rows from before there were two rules name none. They follow `FORMER_TRIMMING`, and their
    measures are copied into the columns of that rule. A run that failed has no measures, and no
    rule.

    Examples
    --------
    >>> import pandas as pd
    >>> table = with_trimming(pd.DataFrame({"height_m": [0.2], "length_m": [0.5]}))
    >>> table[["trimming", "equal_pace_length_m"]].values.tolist()
    [['equal_pace', 0.5]]
    """
    if "height_m" not in table:
        return table
    named = table["trimming"] if "trimming" in table else table["height_m"].map(lambda _: "")
    measured = table["height_m"].notna() & (table["height_m"].astype(str) != "")
    former = measured & (named.isna() | (named.astype(str) == ""))
    if not former.any():
        return table
    added = {"trimming": named.astype(object).where(~former, FORMER_TRIMMING)}
    for quantity in QUANTITIES:
        plain, own = f"{quantity}_m", MEASURES[FORMER_TRIMMING].column(quantity)
        if plain in table:
            there = table[own] if own in table else table[plain]
            added[own] = there.where(~former, table[plain])
    return table.assign(**added)


def _rows(store: Store, study: str) -> Iterator[dict[str, Any]]:
    axes = store.axes(study)
    events = _events(store, study)
    timings = {row[0]: dict(zip(RUN_TIMING, row[1:])) for row in _run_timings(store, study)}
    for run in store.runs(study):
        if run.status != "pending":
            store.check_results(run.hash)
        common = {**_facts(run, axes), **timings.get(run.hash, {})}
        yield from ({**common, **event} for event in events.get(run.hash, ()))
        if run.status == FAILED:
            at = len(events.get(run.hash, ())) + 1
            yield {**common, "event": at, "ended": FAILED, "error": run.error}


def _facts(run: StoredRun, axes: Sequence[str]) -> dict[str, Any]:
    """Return the columns that all events of a run share."""
    scene = with_current_names(scene_data(run.scene))
    facts = scene_columns(scene, axes)
    return {
        **facts,
        "hash": run.hash,
        "error": "",
        "notes": "; ".join(run.notes),
        "version": run.version,
        "build": run.build,
    }


def scene_columns(scene: Mapping[str, Any], axes: Sequence[str]) -> dict[str, Any]:
    """Return the columns that a scene fills: some axes, the seed, dimension and settings."""
    return {
        **{path: _cell(value_at(scene, path)) for path in axes},
        "seed": value_at(scene, SEED),
        "dimension": scene["dimension"],
        **{name: value_at(scene, path) for name, path in accuracy_of(scene).items()},
    }


def _events(store: Store, study: str) -> dict[str, list[dict[str, Any]]]:
    names = ("event", *STORED_TYPES, "wall_s")
    present = store.columns("event")
    measures = [name if name in present else f"NULL AS {name}" for name in STORED_TYPES]
    rows = store.read(
        f"SELECT event.hash, event.event, {', '.join(measures)}, wall_s"
        " FROM study_run JOIN event USING (hash) JOIN event_timing USING (hash, event)"
        " WHERE study = ? ORDER BY position, event.event",
        (study,),
    )
    texts = _columns_of_type("TEXT")
    events: dict[str, list[dict[str, Any]]] = {}
    for hash_, *values in rows:
        row = dict(zip(names, values))
        for name, value in row.items():
            right = isinstance(value, str) if name in texts else is_number(value)
            if not (right or value is None):
                raise store.damaged(f"run {hash_}, {name}: {shortened(repr(value))}")
        events.setdefault(hash_, []).append(row)
    return events


def _run_timings(store: Store, study: str) -> list[tuple[Any, ...]]:
    return store.read(
        f"SELECT hash, {', '.join(RUN_TIMING)} FROM study_run JOIN run_timing USING (hash)"
        " WHERE study = ?",
        (study,),
    )


def _columns_of_type(kind: str) -> list[str]:
    return [name for name, stored in STORED_TYPES.items() if stored == kind]


def value_at(scene: Mapping[str, Any], path: str) -> Any:
    """Return the value at a dotted path of a complete scene, or None if it has none there.

    Examples
    --------
    >>> value_at({"obstacles": [{"friction": 0.3}]}, "obstacles.0.friction")
    0.3
    """
    value: Any = scene
    for key in current_path(path).split("."):
        if isinstance(value, list) and key.isdigit() and int(key) < len(value):
            value = value[int(key)]
        elif isinstance(value, dict) and key in value:
            value = value[key]
        else:
            return None
    return value


def _cell(value: Any) -> Any:
    """Return a value as a cell of a table: vectors and objects are their JSON text."""
    return json.dumps(value) if isinstance(value, (list, dict)) else value
