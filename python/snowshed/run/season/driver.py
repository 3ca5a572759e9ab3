"""A whole season: from a season file to a table, a figure and the event that buries the panel."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Optional, Union

from snowshed._core import InputError
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import read_csv
from snowshed.methods.registry import resolution_of
from snowshed.run.events import run_events
from snowshed.run.progress import Reporter
from snowshed.run.results import EVENT_COLUMNS, check_empty
from snowshed.run.season.accumulation import Day, accumulate, pauses
from snowshed.run.season.clearance import first_reached, panel_ends
from snowshed.run.season.results import SeasonFolder
from snowshed.run.season.settings import SeasonSettings
from snowshed.run.season.slabs import season_scene
from snowshed.run.season.table import season_table
from snowshed.run.season.weather import Season, read_season
from snowshed.scene.scene import PathLike, ResolvedScene, Scene

if TYPE_CHECKING:
    import pandas as pd

# Part of a slab that may stay on the panel; beyond it the core lays the next slab on top.
STAYING = 0.02


@dataclass(frozen=True)
class SeasonResult:
    """What a season came to.

    Attributes
    ----------
    table
        As in season.csv.
    releases, simulated
        Number of releases, and of those that were simulated.
    burial_event
        First event after which the snow below the panel's lower edge reaches it; None: none.
    crest_event
        First event after which the stack is as high as the lower edge, wherever; None: none.
    staying_event
        First event after which snow stayed on the panel; None: none.
    notes
        What a reader of the table has to know.
    """

    table: pd.DataFrame
    releases: int
    simulated: int
    burial_event: Optional[int]
    crest_event: Optional[int]
    staying_event: Optional[int]
    notes: Sequence[str]


def run_season(
    season: Season,
    scene: Union[Scene, ResolvedScene],
    out_dir: PathLike,
    *,
    settings: Optional[SeasonSettings] = None,
    resume: bool = False,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
) -> SeasonResult:
    """Let the snow of a season gather on a panel, let go, and pile up below it.

    Parameters
    ----------
    season
        A season file or a pandas DataFrame (see `read_season`), or rows of `Weather`.
    scene
        Panel, ground, obstacles, snow and method (`season_scene` says what holds of it). The
        panel's friction is that of snow that slides.
    out_dir
        The results folder (``snowshed.run.season.results``); new or empty, unless resuming.
    settings
        Release, density and settling; None: the defaults.
    resume
        Go on with an interrupted season in `out_dir`.
    progress
        Called about twice a second while a slide-off runs.
    pictures
        Whether to draw the figure.

    Raises
    ------
    InputError
        If the file or the scene is wrong, or the folder is not empty; nothing has been written.
    SimulationError, Interrupted
        As from `run_events`.

    Examples
    --------
    >>> from datetime import datetime
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.run.season import Weather
    >>> row = Weather(2, datetime(2024, 12, 1), 0.1, 100.0, -4.0)
    >>> with TemporaryDirectory() as folder:
    ...     flat = Scene.preset("lab-40").set("panel.tilt", 20)
    ...     run_season([row], flat, folder, pictures=False).releases
    0
    """
    settings = settings or SeasonSettings()
    rows = read_season(season)
    ready = scene.resolve() if isinstance(scene, Scene) else scene
    data: dict[str, Any] = ready.data
    if "panel" not in data:
        raise InputError("/panel: missing; a season needs a panel for the snow to gather on")
    days = accumulate(rows, settings, data["panel"]["tilt"], data["gravity"])
    folder = SeasonFolder(out_dir)
    if not resume:
        check_empty(folder.folder)
    slides = season_scene(ready, days) if any(day.event for day in days) else None
    if slides is not None:
        run_events(
            slides,
            folder.run.folder,
            resume=resume and folder.run.scene.is_file(),
            ageing=settings.ageing(pauses(days)) if settings.ages else None,
            progress=progress,
            pictures=pictures,
        )
    folder.folder.mkdir(parents=True, exist_ok=True)
    result = _result(slides or ready, days, settings, folder)
    _write(result, slides or ready, settings, folder, pictures=pictures)
    return result


def _result(
    scene: ResolvedScene,
    days: Sequence[Day],
    settings: SeasonSettings,
    folder: SeasonFolder,
) -> SeasonResult:
    import pandas as pd

    events = _table_or_empty(folder.run.events.path, EVENT_COLUMNS)
    outlines = _table_or_empty(folder.run.outlines.path, ("event", "x", "z"))
    table = season_table(scene.data, days, settings, events, outlines)
    simulated = table[pd.notna(table["event"]) & pd.notna(table["stack_height_m"])]
    dx = resolution_of(scene.data)
    staying = _first_staying(events)
    return SeasonResult(
        table,
        releases=int(pd.notna(table["event"]).sum()),
        simulated=len(simulated),
        burial_event=first_reached(simulated["clearance_m"].tolist(), dx),
        crest_event=first_reached(simulated["crest_clearance_m"].tolist(), dx),
        staying_event=staying,
        notes=[*_notes(scene.data, days, settings, staying), *_cut_short(events)],
    )


def _first_staying(events: pd.DataFrame) -> Optional[int]:
    """Return the first event after which much of what it brought still lies on the panel."""
    total = events["mass_kg"] + events["on_panel_kg"]
    brought = total.diff().fillna(total)
    stayed = events["event"][events["on_panel_kg"] > STAYING * brought]
    return int(stayed.iloc[0]) if len(stayed) else None


def _cut_short(events: pd.DataFrame) -> list[str]:
    """Say how many slide-offs were measured before the snow had come to rest."""
    count = int((events["ended"] == "time_limit").sum())
    if not count:
        return []
    return [
        f"{count} of {len(events)} slide-offs ended before the snow rested; "
        "allow a longer --max-time"
    ]


def _table_or_empty(path: Any, columns: Sequence[str]) -> pd.DataFrame:
    import pandas as pd

    return read_csv(path) if path.is_file() else pd.DataFrame(columns=list(columns))


def _notes(
    scene: dict[str, Any], days: Sequence[Day], settings: SeasonSettings, staying: Optional[int]
) -> list[str]:
    notes = []
    released = [day for day in days if day.event is not None]
    estimated = sum(day.density is not None and day.weather.density is None for day in days)
    if estimated:
        notes.append(f"{estimated} densities are estimates ({settings.density})")
    if released:
        dx = resolution_of(scene)
        thinnest = min(day.thickness for day in released)
        if thinnest < 2.0 * dx:
            notes.append(
                f"the thinnest slab has {1000 * thinnest:.1f} mm, less than two cells of "
                f"{1000 * dx:g} mm: its stack is coarse"
            )
    else:
        notes.append("no snow let go: friction and adhesion held all of it")
    if settings.settling:
        notes.append(
            f"the stack settles between events ({settings.settling}), for which a factor of 4 and "
            "more is published; settled heights are estimates for the time until the next"
        )
    if settings.sintering:
        notes.append(
            f"broken bonds regain strength ({settings.sintering}), all of it in "
            f"{settings.strength_age:g} hours"
        )
    if staying is not None:
        notes.append(
            f"from event {staying} on, snow that should have left stayed on the panel; later slabs "
            "are laid on top of it"
        )
    return notes


def _write(
    result: SeasonResult,
    scene: ResolvedScene,
    settings: SeasonSettings,
    folder: SeasonFolder,
    *,
    pictures: bool,
) -> None:
    summary = {name: value for name, value in vars(result).items() if name != "table"}
    text = json.dumps({"settings": asdict(settings), **summary}, indent=2, default=list)
    write_text(folder.table, result.table.to_csv(index=False, float_format="%.6g"))
    write_text(folder.summary, text + "\n")
    if pictures:
        from snowshed.plot.figure_style import save
        from snowshed.plot.season_figure import season_figure

        figure = season_figure(
            result.table,
            _table_or_empty(folder.run.outlines.path, ("event", "x", "z")),
            scene.data,
            panel=panel_ends(scene.data),
            burial_event=result.burial_event,
            title=f"{result.releases} releases{_verdict(result)}",
        )
        save(figure, folder.figure)


def _verdict(result: SeasonResult) -> str:
    if result.burial_event is not None:
        return f"; the stack reaches the panel's lower edge with event {result.burial_event}"
    if result.simulated:
        return "; the stack does not reach the panel's lower edge"
    return ""
