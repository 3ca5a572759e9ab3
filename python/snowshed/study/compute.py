"""Computing one run in the process of a worker."""

from __future__ import annotations

import platform
import shutil
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Optional

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.build import build_id
from snowshed.base.interrupt import Interrupted
from snowshed.base.notes import SnowshedNote
from snowshed.base.progress import Progress, Reporter
from snowshed.io.locks import holding
from snowshed.methods.registry import method_of
from snowshed.results.folder import RunFolder
from snowshed.running.laws import Laws
from snowshed.running.run import run
from snowshed.scene.resolved import ResolvedScene, scene_data
from snowshed.study.aged_scene import split_ageing
from snowshed.study.named_laws import laws_of_run
from snowshed.study.outcome import RunOutcome, RunTask
from snowshed.study.scene_hash import content_hash

FractionReporter = Callable[[float], None]


def compute(task: RunTask, report: Optional[FractionReporter] = None) -> RunOutcome:
    """Compute a run, or resume an earlier attempt in its folder, and return the outcome.

    Parameters
    ----------
    task
        The run. If the parent of its folder does not exist, as on a cluster without shared files, a
        temporary folder is used.
    report
        Called about twice a second with the fraction of the work that is done.

    Returns
    -------
    Outcome
        The outcome; errors are outcomes, too.
    """
    try:
        with _working_folder(Path(task.folder)) as folder:
            return _compute(task, folder / "results", report)
    except OSError as error:
        name = f"{error.filename}: " if error.filename else ""
        return RunOutcome(task.hash, "unable", error=f"{name}{error.strerror or error}")


def _compute(task: RunTask, folder: Path, report: Optional[FractionReporter]) -> RunOutcome:
    if reason := _mismatch(task):
        return RunOutcome(task.hash, "unable", error=reason)
    earlier = RunFolder(folder).read_run()
    if earlier.get("status") == "failed":  # the earlier process was killed before its report
        return _outcome(task, folder, earlier["error"])
    try:
        laws = laws_of_run(scene_data(task.scene))
    except InputError as error:
        return RunOutcome(task.hash, "unable", error=str(error))
    try:
        with warnings.catch_warnings():  # warnings of a worker are lost: the outcome has its notes
            warnings.simplefilter("ignore", SnowshedNote)
            _run_or_resume(task, folder, laws, _work_reporter(report))
    except Interrupted:
        return RunOutcome(task.hash, "interrupted")
    except OSError:
        raise
    except MemoryError:  # with fewer runs at once it may fit; the folder has a failure
        shutil.rmtree(folder, ignore_errors=True)
        return RunOutcome(task.hash, "lost", error="out of memory")
    except Exception as error:  # no error of one run may stop the others
        return _outcome(task, folder, f"{_kind(error)}{error}")
    return _outcome(task, folder, None)


def _mismatch(task: RunTask) -> str:
    """Return why this worker cannot compute the registered run; empty if it can."""
    if content_hash(scene_data(task.scene)) != task.hash:
        return (
            f"run {task.hash} differs from the registered one: a file of its scene has changed, "
            f"or this is another version of snowshed ({_core.version})"
        )
    if task.build not in ("", build_id()):
        return (
            f"this worker has another build of snowshed ({build_id()}) than the study "
            f"({task.build}); give all workers the same one"
        )
    return ""


def _run_or_resume(
    task: RunTask, folder: Path, laws: Optional[Laws], report: Optional[Reporter]
) -> None:
    """Run the events; an earlier attempt without a checkpoint is removed."""
    data, ageing = split_ageing(task.scene)
    options: dict[str, Any] = {
        "ageing": ageing, "laws": laws, "progress": report, "pictures": False, "compact": True,
    }  # fmt: skip
    if (folder / "scene.json").is_file():
        try:
            scene = ResolvedScene.load(folder / "scene.json")  # with its number of threads
            run(scene, folder, resume=True, **options)
            return
        except InputError:
            pass
    shutil.rmtree(folder, ignore_errors=True)
    scene = ResolvedScene.from_data(data).with_threads(task.threads)
    run(scene, folder, **options)


def _outcome(task: RunTask, folder: Path, error: Optional[str]) -> RunOutcome:
    """Return the outcome recorded in the results folder."""
    results = RunFolder(folder)
    runs = method_of(split_ageing(task.scene)[0]).run_class()
    events = runs.rows(folder)
    status = "done" if error is None else "failed"
    begun = (folder / "scene.json").is_file()  # else it failed before it wrote anything
    particles = dict(runs.stored_data(folder)) if task.keep_particles and begun else {}
    facts = results.read_run()
    notes = tuple(facts.get("notes", ()))
    return RunOutcome(task.hash, status, events, _timing(facts), error, particles, notes)


def _timing(facts: dict[str, Any]) -> dict[str, Any]:
    return {
        "run_wall_s": facts.get("wall_s"),
        "threads": facts.get("threads"),
        "particles": facts.get("particles"),
        "particle_updates": facts.get("particle_updates"),
        "peak_memory_mb": facts.get("peak_memory_mb"),
        "host": platform.node(),
        "cpu": facts.get("cpu"),
        "finished": datetime.now(timezone.utc).isoformat(timespec="seconds"),
    }


def _kind(error: Exception) -> str:
    """Return the type of an unforeseen error as text; empty for errors of the core."""
    expected = isinstance(error, (InputError, _core.SimulationError))
    return "" if expected else f"{type(error).__name__}: "


def _work_reporter(report: Optional[FractionReporter]) -> Optional[Reporter]:
    """Return a reporter of a run's progress as a share of its work; event k moves k slabs."""
    if report is None:
        return None

    def report_progress(progress: Progress) -> None:
        event, count = progress.event, progress.count
        within = progress.fraction * count - (event - 1)  # part of this event
        done = event * (event - 1) / 2 + within * event
        report(done / (count * (count + 1) / 2))

    return report_progress


@contextmanager
def _working_folder(folder: Path) -> Iterator[Path]:
    """Yield the folder, locked against other processes, or a temporary one."""
    if folder.parent.is_dir():
        with holding(folder, _make):
            yield folder
    else:
        with tempfile.TemporaryDirectory(prefix="snowshed-") as temporary:
            yield Path(temporary)


def _make(folder: Path) -> None:
    folder.mkdir(exist_ok=True)
