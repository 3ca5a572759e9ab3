"""Running a scene of any method into a results folder.

The core runs the events and writes the results folder. The `MethodRun` of the scene's method
measures, writes tables and draws; the observer here calls it while the core runs.
"""

from __future__ import annotations

import os
import shutil
import weakref
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Any, Literal, Optional, Union

import snowshed._core as _core
from snowshed.base.arguments import checked
from snowshed.base.callers import either
from snowshed.base.extras import require
from snowshed.base.interrupt import Interrupted, InterruptRequest, deferred_interrupts
from snowshed.base.log import LOGGER
from snowshed.base.machine import machine_facts
from snowshed.base.notes import issue_note
from snowshed.base.paths import PathLike
from snowshed.base.progress import Progress, Reporter
from snowshed.io.folders import check_empty
from snowshed.io.raster.output import MapFormat
from snowshed.methods.method import Method
from snowshed.methods.registry import method_of
from snowshed.results.folder import RunFolder
from snowshed.results.reader import Results
from snowshed.results.replacement import new_results
from snowshed.running.ageing.ageing import Ageing
from snowshed.running.kept_inputs import kept_inputs
from snowshed.running.law_errors import law_errors
from snowshed.running.laws import Laws
from snowshed.running.method_run import MethodRun, RunOptions
from snowshed.running.recorded_run import RecordedRun, note_run_beside, recorded_run
from snowshed.running.sequence import open_sequence, record_note, run_sequence
from snowshed.scene.resolved import ResolvedScene
from snowshed.scene.scene import SceneLike, resolve_scene

if TYPE_CHECKING:
    import pandas as pd


@checked
def run(
    scene: SceneLike,
    folder: Optional[PathLike] = None,
    *,
    resume: Union[bool, Literal["auto"]] = False,
    overwrite: bool = False,
    ageing: Optional[Ageing] = None,
    laws: Optional[Laws] = None,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
    compact: bool = False,
    map_format: MapFormat = "ascii",
) -> Results:
    """Simulate a scene of any method, and write a results folder.

    Parameters
    ----------
    scene
        A scene, its JSON data, or the path of a scene file or of a run.json, which repeats that
        run.
    folder
        The results folder (see ``snowshed.results.folder``); new or empty, unless resuming or
        overwriting. None: a temporary folder, which is removed with the results.
    resume
        Resume from the checkpoint in `folder`, also one of ``snowshed-run``; the particles are
        those of an uninterrupted run. "auto": resume if the folder holds a run, else begin; a
        finished run of the same scene is returned, so that a cell of a notebook may be run again.
        Events that are missing in the tables are measured from their
        stored particles, in single precision.
    overwrite
        Replace the results of an earlier run in `folder`. They stay if the new run cannot begin.
    ageing
        Ageing of the stack between the events; None: none, or that of a run.json. It must be the
        same when resuming.
    laws
        Laws of one's own (`snowshed.running.Laws`); None: those of the scene. They must have the
        same name when resuming.
    progress
        Called with a `Progress` about twice a second.
    pictures
        Whether to draw the pictures and pages of the method at the end.
    compact
        Whether to leave out large files that follow from smaller ones, as in a study of many runs:
        for a slide, ``peaks.npz`` replaces the rasters.
    map_format
        Format of the maps of a slide: "ascii" or "geotiff". GeoTIFF is compressed and exact; it
        needs the extra ``terrain``.

    Returns
    -------
    Results
        The results folder.

    Raises
    ------
    InputError
        If the scene is wrong, the folder is not empty, there is nothing to resume, the method has
        no stack that could age or no maps, or rasterio is missing for GeoTIFF; nothing has been
        written then.
    SimulationError
        If the simulation cannot continue; a checkpoint holds its last good state.
    Interrupted
        After Ctrl-C; a checkpoint holds the state to resume from.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}})
    >>> with TemporaryDirectory() as folder:
    ...     results = run(tiny, folder, pictures=False)
    ...     results.events.event.tolist()
    [1]
    """
    if folder is None:
        if resume or overwrite:
            raise _core.InputError("folder: missing; resume and overwrite need it")
        return _run_in_temporary_folder(
            scene, ageing=ageing, laws=laws, progress=progress, pictures=pictures, compact=compact,
            map_format=map_format,
        )  # fmt: skip
    resolved, recorded = resolve_scene(scene), recorded_run(scene)
    if recorded is None:
        note_run_beside(scene, as_it_was=resume is True or ageing is not None or laws is not None)
    if resume and overwrite:
        raise _core.InputError("resume, overwrite: give one of the two")
    options = RunOptions(_resumes(resume, Path(folder)), ageing, pictures, compact, map_format)
    return run_resolved(
        resolved, folder, options, recorded, overwrite=overwrite, laws=laws, progress=progress
    )


def run_resolved(
    resolved: ResolvedScene,
    folder: PathLike,
    options: RunOptions,
    recorded: Optional[RecordedRun] = None,
    *,
    overwrite: bool = False,
    laws: Optional[Laws] = None,
    progress: Optional[Reporter] = None,
) -> Results:
    """Run a complete scene as `run` does; `recorded` is the earlier run that it repeats."""
    method = method_of(resolved.data)
    if recorded is not None:
        options = replace(options, ageing=options.ageing or recorded.ageing)
        recorded.check_laws(laws)
    if options.ageing is not None and not method.ages:
        raise _core.InputError(f'ageing: the snow of the method "{method.name}" does not age')
    if options.ageing is not None and resolved.data["events"]["between"] != "carry":
        raise _core.InputError(
            '/events/between: "reseed" replaces the snow, so that it cannot age; use "carry"'
        )
    resume = options.resume
    if not resume and not overwrite:
        check_empty(folder, instead_of_full())
    if options.map_format != "ascii":
        _check_maps(method, options.map_format)
    starting = nullcontext(_nothing) if resume else new_results(folder, overwrite=overwrite)
    with starting as begin:
        with kept_inputs(resolved, folder) as resolved:
            sequence = open_sequence(resolved, folder, resume=resume, laws=laws)
        verb = "resuming" if resume else "running"
        LOGGER.info("%s %s in %s", verb, _title(resolved), folder)
        with sequence, deferred_interrupts() as interrupt, law_errors(laws) as check_laws:
            method_run: MethodRun = method.run_class()(sequence, resolved, Path(folder), options)
            method_run.begin()
            sequence.describe_machine(machine_facts())
            for note in [] if recorded is None else recorded.differences(laws):
                record_note(sequence, note)
            observer = _Observer(method_run, interrupt, progress, begin, check_laws)
            try:
                run_sequence(sequence, observer, resolved, folder)
            except Interrupted:
                method_run.interrupted()
                raise
            method_run.finish()
    LOGGER.info("finished in %s", folder)
    if options.pictures:
        method_run.draw()
    return Results.of_run(folder, resolved)


def _nothing() -> None:
    """Do nothing: a resumed run has begun long since."""


def _check_maps(method: Method, map_format: MapFormat) -> None:
    """Refuse a format of maps that the run could not write at its end."""
    if "maps" not in method.results:
        raise _core.InputError(f'map_format: the method "{method.name}" has no maps')
    require("rasterio", "terrain", f"the format {map_format} of maps")


def _resumes(resume: Union[bool, Literal["auto"]], folder: Path) -> bool:
    """Return whether to resume the run in a folder."""
    if isinstance(resume, str):
        if resume != "auto":
            raise _core.InputError(f'resume: {resume!r}; allowed: True, False, "auto"')
        return RunFolder(folder).scene.is_file()
    return resume


def _title(scene: ResolvedScene) -> str:
    return str(scene.data.get("title") or f"a scene of the method {method_of(scene.data).name}")


def _run_in_temporary_folder(scene: SceneLike, **options: Any) -> Results:
    """Run a scene in a folder that is removed with its results."""
    folder = mkdtemp(prefix="snowshed-")
    try:
        results = run(scene, Path(folder) / "results", **options)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    weakref.finalize(results, shutil.rmtree, folder, ignore_errors=True)
    return results


@checked
def run_events(
    scene: SceneLike,
    folder: Optional[PathLike] = None,
    *,
    resume: Union[bool, Literal["auto"]] = False,
    overwrite: bool = False,
    ageing: Optional[Ageing] = None,
    laws: Optional[Laws] = None,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
) -> pd.DataFrame:
    """Simulate slide-off after slide-off, and return the measures of the stack after each event.

    Parameters and errors are those of `run`; the table of events takes the place of all results.

    Returns
    -------
    pandas.DataFrame
        One row per event, as in ``events.csv``.

    Raises
    ------
    InputError
        Also if the snow of the scene's method makes no stack.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}})
    >>> with TemporaryDirectory() as folder:
    ...     table = run_events(tiny, folder, pictures=False)
    >>> table.event.tolist()
    [1]
    """
    resolved = resolve_scene(scene)
    method = method_of(resolved.data)
    if "stack" not in method.results:
        raise _core.InputError(
            f'/method: the snow of "{method.name}" makes no stack; use snowshed.run'
        )
    return run(
        scene if isinstance(scene, (str, os.PathLike)) else resolved,
        folder,
        resume=resume,
        overwrite=overwrite,
        ageing=ageing,
        laws=laws,
        progress=progress,
        pictures=pictures,
    ).events


class _Observer:
    """Observer of the core's loop: calls the method's steps, and reports the progress."""

    def __init__(
        self,
        method_run: MethodRun,
        interrupt: InterruptRequest,
        report: Optional[Reporter],
        begin: Callable[[], None],
        check_laws: Callable[[], None],
    ) -> None:
        self.method_run = method_run
        self.interrupt = interrupt
        self.report = report
        self.begin = begin  # called once the run can be resumed
        self.check_laws = check_laws  # raises an error of a law of one's own

    def between_events(self) -> None:
        """Let the method change the snow between two events."""
        self.method_run.between_events()

    def event_begun(self, reseeding: Optional[dict[str, Any]]) -> None:
        """Report an event that begins, or resumes after a pause."""
        self.method_run.event_begun(reseeding)
        self._report_progress(self.method_run.simulation.time_s, 0.0)

    def noted(self, note: str) -> None:
        """Issue a note of the core; run.json has it already."""
        issue_note(note)

    def progress(self, report: dict[str, Any]) -> None:
        """Report the progress of the event."""
        self.check_laws()
        self.method_run.progress()
        self._report_progress(report["time_s"], report["progress"], report["updates_per_s"])

    def event_ended(self, facts: dict[str, Any]) -> None:
        """Let the method write the results of the event."""
        self.check_laws()
        self.method_run.event_ended(facts)
        LOGGER.info("event %d ended (%s) after %.4g s", facts["event"], facts["ended"],
                    facts["sim_time_s"])  # fmt: skip
        self._report_progress(facts["sim_time_s"], 1.0)

    def before_checkpoint(self) -> None:
        """Let the method write the files that belong to the checkpoint."""
        self.method_run.before_checkpoint()
        self.begin()

    def stop_requested(self) -> bool:
        """Return whether to stop at the next safe point."""
        return self.interrupt.requested

    def _report_progress(self, time_s: float, fraction: float, updates_per_s: float = 0.0) -> None:
        """Report the progress of the run; `fraction` is the finished share of the event."""
        if self.report is None:
            return
        event, count = self.method_run.simulation.event, self.method_run.simulation.event_count
        self.report(
            Progress(
                (event - 1 + fraction) / count,
                event - 1 + int(fraction == 1.0),
                count,
                self.method_run.UNIT,
                self.method_run.status_line(time_s),
                event=event,
                time=time_s,
                updates_per_s=updates_per_s,
            )
        )


def instead_of_full(work: str = "run") -> str:
    """Return the end of the message on a folder of some work that is not empty.

    Examples
    --------
    >>> print(instead_of_full("season"))
    ; choose a new folder, resume the season with `resume=True`, or replace its results with \
`overwrite=True`
    """
    return either(
        f"; choose a new folder, resume the {work} with `resume=True`, or replace its results with "
        "`overwrite=True`",
        f"; choose a new folder, or resume the {work} with --resume",
    )
