"""A whole season: from a season file to a table, a figure, and the event that buries the panel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.notes import InputNote, ResultNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.base.progress import Reporter
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import Table, read_csv, write_csv
from snowshed.io.folders import check_empty
from snowshed.io.json_file import sealed
from snowshed.methods.registry import resolution_of
from snowshed.results.computed_record import SEASON, record_data
from snowshed.results.replacement import replaced_season
from snowshed.results.season_folder import SeasonFolder
from snowshed.running.run import instead_of_full, run_events
from snowshed.scene.named_files import named_files
from snowshed.scene.scene import ResolvedScene, SceneLike, resolve_scene
from snowshed.season.accumulation import WinterDay, snow_on_panel, stack_ageing
from snowshed.season.notes import assumptions, fall_notes, first_staying, notes
from snowshed.season.panel_contact import PanelContact, first_contact, first_reached, panel_ends
from snowshed.season.rows import check_rows, lying_snow_named
from snowshed.season.settings import SeasonSettings
from snowshed.season.slabs import season_scene
from snowshed.season.table import season_table
from snowshed.season.weather.quality import COVERAGE
from snowshed.season.weather.quality_table import caption
from snowshed.season.weather.reading import Season, input_files, read_record
from snowshed.season.weather.rows_data import weather_data
from snowshed.season.weather.season_record import SeasonRecord, WinterList
from snowshed.season.weather.source import AUTO

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class SeasonResult:
    """The results of a season.

    Attributes
    ----------
    table
        As in season.csv.
    releases, simulated
        Number of releases, and of those that were simulated.
    contact
        First contact of the stack or the snow cover with the panel, if any: the verdict.
    burial_event
        First event after which the snow below the panel's lower edge reaches it, if any.
    crest_event
        First event after which the stack is anywhere as high as the lower edge, if any.
    staying_event
        First event after which snow stayed on the panel, if any.
    winters
        Quality of the snow data of each winter of the season.
    notes
        Notes on the limits of the results.
    panels
        The upper and the lower edge of each row, (x, z) on levelled ground, m.
    """

    table: pd.DataFrame
    releases: int
    simulated: int
    contact: Optional[PanelContact]
    burial_event: Optional[int]
    crest_event: Optional[int]
    staying_event: Optional[int]
    winters: WinterList
    notes: Sequence[str]
    panels: Sequence[Sequence[Sequence[float]]]


@checked
def run_season(
    season: Season,
    scene: SceneLike,
    folder: PathLike,
    *,
    settings: Optional[SeasonSettings] = None,
    resume: bool = False,
    overwrite: bool = False,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
    coverage: float = COVERAGE,
    snow_from: str = AUTO,
    temperature: Optional[PathLike] = None,
) -> SeasonResult:
    """Simulate a season: snow accumulates on a panel, is released, and piles up below it.

    Notes on the weather come first, and those on the limits of the results last; the notes of the
    result have its assumptions, too.

    Parameters
    ----------
    season
        A season file or a pandas DataFrame (see `read_season`), or rows of `Weather`.
    scene
        A scene, its JSON data, or the path of a scene file. Its panel, ground, obstacles, snow and
        method are used; `season_scene` replaces its slab and its events. The panel's friction is
        that of sliding snow.
    folder
        The results folder (``snowshed.results.season_folder``); new or empty, unless resuming or
        overwriting.
    settings
        Settings of release, density and settling. [default: `SeasonSettings()`]
    resume
        Whether to resume an interrupted season in `folder`.
    overwrite
        Whether to replace an earlier season in `folder`. It stays if the new one cannot begin.
    progress
        Called about twice a second while a slide-off runs.
    pictures
        Whether to draw the figure.
    coverage
        Share of the days of the snow season on which snow should have been observed; a note names
        winters with a smaller share.
    snow_from, temperature
        The column of a station that observes snow, and another file of its temperatures; see
        `read_record`.

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
    >>> from snowshed import Scene
    >>> from snowshed.season import Weather
    >>> row = Weather(2, datetime(2024, 12, 1), 0.1, 100.0, -4.0)
    >>> with TemporaryDirectory() as folder:
    ...     flat = Scene.preset("lab-40").set("panel.tilt", 20)
    ...     run_season([row], flat, folder, pictures=False).releases
    0
    """
    settings = settings or SeasonSettings()
    plan = plan_season(
        season, scene, settings=settings, coverage=coverage, snow_from=snow_from,
        temperature=temperature,
    )  # fmt: skip
    earlier = [*plan.record.notes, *plan.winters.shortfalls]
    for note in earlier:
        issue_note(note, InputNote)
    result = simulate_season(
        plan, folder, settings=settings, resume=resume, overwrite=overwrite, progress=progress,
        pictures=pictures,
    )  # fmt: skip
    issued = {*earlier, *settings.notes, *assumptions(result.table, plan.days, settings)}
    for note in result.notes:
        if note not in issued:
            issue_note(note, ResultNote)
    return result


def simulate_season(
    plan: SeasonPlan,
    folder: PathLike,
    *,
    settings: SeasonSettings,
    resume: bool = False,
    overwrite: bool = False,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
) -> SeasonResult:
    """Simulate a planned season; its notes are in the result, and are not issued.

    Parameters and errors are those of `run_season`.
    """
    files = SeasonFolder(folder)
    if resume and overwrite:
        raise InputError("resume, overwrite: give one of the two")
    if not resume and not overwrite:
        check_empty(files.folder, instead_of_full("season"))
    with replaced_season(folder) if overwrite else nullcontext():
        _slide(plan, settings, files, resume=resume, progress=progress, pictures=pictures)
    files.folder.mkdir(parents=True, exist_ok=True)
    result = _result(plan, settings, files)
    _write(result, plan, settings, files, pictures=pictures)
    return result


def _slide(
    plan: SeasonPlan,
    settings: SeasonSettings,
    files: SeasonFolder,
    *,
    resume: bool,
    progress: Optional[Reporter],
    pictures: bool,
) -> None:
    """Simulate the slide-offs of a season, if there are any."""
    if plan.slides is not None:
        with lying_snow_named(settings.rows):
            run_events(
                plan.slides,
                files.run.folder,
                resume=resume and files.run.scene.is_file(),
                ageing=stack_ageing(plan.days, settings),
                progress=progress,
                pictures=pictures,
            )
    elif files.run.scene.is_file():
        raise InputError(
            f"{files.folder}: it holds slide-offs, but in this season nothing slides; give another "
            "folder"
        )


@dataclass(frozen=True)
class SeasonPlan:
    """A season before its simulation.

    Attributes
    ----------
    record, winters
        The weather, and the quality of its winters.
    days
        The snow on the panel, row after row.
    panel
        The scene of the panel.
    slides
        The scene whose events are the releases; None without a release.
    coverage, files
        Share of the days on which snow should have been observed, and the files of the weather.
    """

    record: SeasonRecord
    winters: WinterList
    days: Sequence[WinterDay]
    panel: ResolvedScene
    slides: Optional[ResolvedScene]
    coverage: float = COVERAGE
    files: Sequence[str] = ()

    def record_data(self, settings: SeasonSettings) -> dict[str, Any]:
        """Return what makes the season: enough to simulate it again (`snowshed.repeat`)."""
        inputs: dict[str, Any] = {
            "settings": asdict(settings),
            "scene": self.panel.copied_data(),  # with absolute paths of files
            "coverage": self.coverage,
            "weather": weather_data(self.record),
        }
        return record_data(SEASON, inputs, [*self.files, *named_files(inputs["scene"])])

    @property
    def scene(self) -> Mapping[str, Any]:
        """The scene of the slide-offs, with the panel at its height above the ground."""
        slides = self.slides or self.panel
        return {**slides.data, "panel": self.panel.data["panel"]}


def plan_season(
    season: Season,
    scene: SceneLike,
    *,
    settings: SeasonSettings,
    coverage: float = COVERAGE,
    snow_from: str = AUTO,
    temperature: Optional[PathLike] = None,
) -> SeasonPlan:
    """Return the releases of a season and the scene of its slide-offs, without simulating them.

    Parameters and errors are those of `run_season`.
    """
    record = read_record(season, snow_from, temperature)
    files = input_files(season, temperature)
    return plan_record(record, resolve_scene(scene), settings, coverage, files)


def plan_record(
    record: SeasonRecord,
    panel: ResolvedScene,
    settings: SeasonSettings,
    coverage: float,
    files: Sequence[str] = (),
) -> SeasonPlan:
    """Return the plan of a season from weather that was read already; see `plan_season`.

    `files` are those of the weather, whose checksums the season records.
    """
    winters = record.winters(coverage)
    data = panel.data
    if "panel" not in data:
        raise InputError("/panel: missing; a season needs a panel for the snow to gather on")
    check_rows(settings.rows, data)
    days = snow_on_panel(record.rows, settings, data["panel"]["tilt"], data["gravity"])
    slides = season_scene(panel, days, settings) if any(day.event for day in days) else None
    return SeasonPlan(record, winters, days, panel, slides, coverage, files)


def _result(plan: SeasonPlan, settings: SeasonSettings, folder: SeasonFolder) -> SeasonResult:
    import pandas as pd

    scene, days = plan.scene, plan.days
    events = _table_or_empty(folder.run.events)
    outlines = _table_or_empty(folder.run.outlines)
    table = season_table(plan.panel.data, days, settings, events, outlines)
    simulated = table[pd.notna(table["event"]) & pd.notna(table["stack_height_m"])]
    dx = resolution_of(scene)
    first_staying_event = first_staying(events)
    return SeasonResult(
        table,
        releases=sum(day.released for day in days),
        simulated=len(simulated),
        contact=first_contact(table, dx),
        burial_event=first_reached(simulated["clearance_m"].tolist(), dx),
        crest_event=first_reached(simulated["crest_clearance_m"].tolist(), dx),
        staying_event=first_staying_event,
        winters=plan.winters,
        notes=[
            *plan.record.notes,
            *settings.notes,
            *plan.winters.shortfalls,
            *assumptions(table, days, settings),
            *fall_notes(plan.panel.data, table, days, settings),
            *notes(dx, days, settings, events, first_staying_event),
        ],
        panels=[
            [[x + away, z] for x, z in panel_ends(scene)] for away in settings.rows.distances(scene)
        ],
    )


def _table_or_empty(table: Table) -> pd.DataFrame:
    import pandas as pd

    return read_csv(table.path) if table.path.is_file() else pd.DataFrame(columns=table.columns)


def _write(
    result: SeasonResult,
    plan: SeasonPlan,
    settings: SeasonSettings,
    folder: SeasonFolder,
    *,
    pictures: bool,
) -> None:
    left_out = ("table", "panels")
    summary = {name: value for name, value in vars(result).items() if name not in left_out}
    summary["contact"] = None if result.contact is None else asdict(result.contact)
    summary["winters"] = result.winters.data()
    summary["notes"] = list(result.notes)
    write_csv(result.table, folder.table, float_format="%.6g")
    record = {"settings": asdict(settings), **summary, **plan.record_data(settings)}
    write_text(folder.summary, sealed(record))
    if pictures:
        from snowshed.plot.figure_style import save_figure

        outlines = _table_or_empty(folder.run.outlines)
        save_figure(season_result_figure(result, outlines, plan.scene), folder.figure)


def season_result_figure(
    result: SeasonResult, outlines: pd.DataFrame, scene: Mapping[str, Any]
) -> Figure:
    """Return the figure of a season.

    Parameters
    ----------
    result
        As from `run_season`.
    outlines
        The profiles of the stack, as in outline.csv; without rows if nothing slid.
    scene
        The complete scene of the slide-offs.
    """
    from snowshed.plot.season_figure import season_figure

    return season_figure(
        result.table,
        outlines,
        scene,
        panels=result.panels,
        contact=result.contact,
        title=f"{result.releases} releases; {verdict(result)}",
        snow=caption(result.winters),
    )


def verdict(result: SeasonResult) -> str:
    """Return a phrase on the first contact with the panel: cause, date and event, or none."""
    contact = result.contact
    if contact is not None:
        after = "before any slide-off" if contact.event is None else f"event {contact.event}"
        return f"{contact.text}, {contact.date[:10]} ({after})"
    if result.simulated:
        return f"nothing reaches the panel within {result.simulated} slide-offs"
    return "nothing slid"
