"""The moving view of a results folder: its film, solids, measures and title."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.io.film import Film
from snowshed.io.json_file import read_object
from snowshed.io.run_files import read_run_record
from snowshed.methods.registry import method_of
from snowshed.plot.caption import scene_caption
from snowshed.plot.film_page import MeasureLine, ViewContent, write_view_page
from snowshed.plot.film_summary import summarise_film
from snowshed.plot.html_page import HtmlTable
from snowshed.plot.pressed_faces import PressurePicture, pressure_picture
from snowshed.plot.solids import Box, Solid, scene_solids
from snowshed.results.folder import event_table
from snowshed.results.obstacle_forces import pressed_events, read_pressures
from snowshed.results.reader import Results
from snowshed.results.season_folder import SeasonFolder
from snowshed.scene.panel_edge import ground_tilt
from snowshed.scene.scene import ResolvedScene
from snowshed.scene.terrain_grid import slide_terrain
from snowshed.snow.stack.measure import levelled_positions

if TYPE_CHECKING:
    import pandas as pd

PAGE = "view.html"


@checked
def write_view(results: PathLike, page: Optional[PathLike] = None) -> Path:
    """Write the moving view of a results folder as one page, and return its path.

    Parameters
    ----------
    results
        The folder of a run of any method, finished or not, or of a season.
    page
        The HTML file. [default: ``view.html`` in the folder]

    Raises
    ------
    InputError
        If it is not a results folder, or its film is missing or damaged.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene, run_events
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}})
    >>> with TemporaryDirectory() as folder:
    ...     _ = run_events(tiny, folder, pictures=False)
    ...     write_view(folder).name
    'view.html'
    """
    run = shown_results(results)
    file = Path(page) if page is not None else Path(results) / PAGE
    film = run.film
    content = view_content(run, film)
    notes = list(dict.fromkeys([*_season_notes(results), *content.notes]))
    write_view_page(file, film, replace(content, notes=notes))
    return file


@checked
class InlineView:
    """The moving view of a run for notebooks, which show it as the value of a cell.

    Parameters
    ----------
    results
        The results of a run, or their folder.
    height
        Height of the view, pixels.

    Raises
    ------
    InputError
        As `write_view`.
    """

    def __init__(self, results: Union[Results, PathLike], *, height: int = 640) -> None:
        folder = results.folder if isinstance(results, Results) else results
        with TemporaryDirectory() as temporary:
            page = write_view(folder, Path(temporary) / PAGE)
            self.page = page.read_text(encoding="utf-8")
        self.height = height

    def _repr_html_(self) -> str:
        page = escape(self.page, quote=True)
        return f'<iframe srcdoc="{page}" width="100%" height="{self.height}"></iframe>'


def shown_results(folder: PathLike) -> Results:
    """Return the results of a run, or those of the slide-offs of a season.

    Raises
    ------
    InputError
        If the folder holds neither.
    """
    season = SeasonFolder(folder)
    return Results(season.run.folder if season.summary.is_file() else season.folder)


def _season_notes(folder: PathLike) -> list[str]:
    """Return the notes of a season; none of the folder of a run."""
    summary = SeasonFolder(folder).summary
    notes = read_object(summary).get("notes", ()) if summary.is_file() else ()
    return [str(note) for note in notes]


def view_content(results: Results, film: Film) -> ViewContent:
    """Return the content of a page besides the film of a results folder."""
    scene = results.scene
    data = scene.data
    bounds = summarise_film(film).bounds
    terrain = slide_terrain(scene) if data.get("terrain") else None
    solids, focus = scene_solids(scene, bounds, terrain)
    table = _events(results)
    lines = [] if table is None else _measures(results, table, float(bounds.low[1]))
    pressures = _pressures(results.folder, solids, focus)
    return ViewContent(
        title=data.get("title") or method_of(data).title,
        sentence=_sentence(data, table, film),
        facts=_facts(scene, results.folder),
        solids=solids,
        focus=focus,
        notes=[*_notes(results, film), *([] if pressures is None else pressures.notes)],
        measures=lines,
        table=_table(table),
        events=int(data["events"]["count"]),
        pressures=pressures,
    )


def _events(results: Results) -> Optional[pd.DataFrame]:
    if not (results.folder / "events.csv").is_file():
        return None
    table = event_table(results.folder)
    return table if len(table) else None


def _sentence(data: Mapping[str, Any], table: Optional[pd.DataFrame], film: Film) -> str:
    count = film.frames[-1].event
    times = f"{film.frames[-1].time:.3g} s of the snow's time"
    if table is None:
        return f"The snow over {times}, as it was simulated."
    last = table.iloc[-1]
    slides = "One slide-off" if count == 1 else f"{count} slide-offs, one after the other"
    what = slides if data.get("panel") else f"The snow over {times}"
    if not last["height_m"] > 0:
        return f"{what}; at the end there is no stack."
    return (
        f"{what}; at the end the snow lies {last['height_m']:.2f} m high and "
        f"{last['length_m']:.2f} m long."
    )


def _facts(scene: ResolvedScene, folder: Path) -> list[tuple[str, str]]:
    data = scene.data
    facts = []
    if not data.get("terrain") and not data.get("sample"):
        names = ("scene", "snow", "method")
        facts += list(zip(names, scene_caption(data).splitlines()))
    elif data.get("terrain"):
        facts.append(("terrain", Path(data["terrain"]["file"]).name))
    else:
        facts.append(("sample", Path(data["sample"]["file"]).name))
    frame = scene.core.panel_frame()
    if frame is not None and frame["board_thickness"] > data["panel"]["thickness"]:
        thickness = 100.0 * frame["board_thickness"]
        facts.append(
            ("panel", f"a board of {thickness:.3g} cm below its face: three cells of the grid")
        )
    facts.append(("results", str(folder.resolve().name)))
    return facts


def _notes(results: Results, film: Film) -> list[str]:
    """Return sentences on the film and the notes of the run, as in run.json."""
    record = read_run_record(results.folder)
    status = record.get("status", "begun")
    notes = [str(note) for note in record.get("notes", ())]
    if status != "finished":
        notes.append(f"The run is not finished ({status}); the view ends where its film ends.")
    if film.frames[0].event > 1 or film.frames[0].time > 0:
        notes.append(f"The film begins {film.frames[0].time:.3g} s after the run did.")
    return notes


def _measures(results: Results, table: pd.DataFrame, front: float) -> list[MeasureLine]:
    """Return height, length and clearance after each event, if they are measured."""
    data = results.scene.data
    tilt = ground_tilt(data)
    profiles = _profiles(results)
    lines = []
    for row in table.to_dict("records"):
        event = int(row["event"])
        if row["height_m"] > 0:
            crest, head, tail = (float(row[k]) for k in ("crest_m", "head_m", "tail_m"))
            height = float(row["height_m"])
            ends = (
                [(crest, 0.0, 0.0), (crest, 0.0, height)],
                [(head, front, 0.0), (tail, front, 0.0)],
            )
            for points, label in zip(
                ends, (f"height {height:.3g} m", f"length {row['length_m']:.3g} m")
            ):
                start, end = levelled_positions(np.array(points), -tilt).tolist()
                lines.append(MeasureLine(event, start, end, label))
        if data.get("panel"):
            lines.append(_clearance(data, event, profiles.get(event), tilt))
    return lines


def _clearance(
    data: Mapping[str, Any], event: int, profile: Optional[np.ndarray], tilt: float
) -> MeasureLine:
    """Return the height between the panel's lower edge and the snow, or the ground, below it."""
    panel = data["panel"]
    x = 0.5 * panel["length"] * float(np.cos(np.radians(panel["tilt"])))
    ground = -x * float(np.tan(np.radians(tilt)))
    edge = ground + panel["height"]
    top = ground
    if profile is not None and len(profile):
        seen = levelled_positions(np.insert(profile, 1, 0.0, axis=1), -tilt)[:, [0, 2]]
        seen = seen[np.argsort(seen[:, 0])]
        if seen[0, 0] <= x <= seen[-1, 0]:
            top = max(ground, float(np.interp(x, seen[:, 0], seen[:, 1])))
    gap = edge - top
    label = f"free below the edge {gap:.3g} m" if gap > 0 else f"buried by {-gap:.3g} m"
    return MeasureLine(event, (x, 0.0, top), (x, 0.0, edge), label)


def _profiles(results: Results) -> dict[int, np.ndarray]:
    if not (results.folder / "outline.csv").is_file():
        return {}
    table = results.outline
    return {int(str(event)): rows[["x", "z"]].to_numpy() for event, rows in table.groupby("event")}


def _pressures(folder: Path, solids: Sequence[Solid], focus: Box) -> Optional[PressurePicture]:
    """Return the pressures on faces, if the run recorded forces."""
    events = reversed(pressed_events(folder))
    tables = ((event, read_pressures(folder, event)) for event in events)
    return pressure_picture(tables, solids, float(focus.size.max()))


def _table(table: Optional[pd.DataFrame]) -> Optional[HtmlTable]:
    if table is None:
        return None
    shown = {
        "event": ("event", "{:.0f}"),
        "height, m": ("height_m", "{:.3f}"),
        "length, m": ("length_m", "{:.3f}"),
        "head, m": ("head_m", "{:.3f}"),
        "tail, m": ("tail_m", "{:.3f}"),
        "on the panel, kg": ("on_panel_kg", "{:.2g}"),
        "ended": ("ended", "{}"),
    }
    known = {title: pair for title, pair in shown.items() if pair[0] in table}
    rows = [
        tuple(form.format(row[name]).replace("_", " ") for name, form in known.values())
        for row in table.to_dict("records")
    ]
    return HtmlTable(tuple(known), rows, "r" * (len(known) - 1) + "l")


__all__ = ["PAGE", "shown_results", "view_content", "write_view"]
