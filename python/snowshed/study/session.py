"""Computing the runs of studies that are missing in the store."""

from __future__ import annotations

import math
import os
import shutil
import time
from collections import Counter, deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Optional

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.build import build_id
from snowshed.base.callers import STUDY_RUN, argument, either
from snowshed.base.formatting import plural
from snowshed.base.interrupt import InterruptRequest, deferred_interrupts
from snowshed.base.log import LOGGER
from snowshed.base.notes import ResultNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.base.progress import Progress, Reporter
from snowshed.io.locks import is_held
from snowshed.snow.accuracy.stack_errors import BEGINNING
from snowshed.study import cost_estimate
from snowshed.study.errors import StudyError, StudyInterrupted
from snowshed.study.locks import is_owner
from snowshed.study.outcome import RunOutcome, RunTask
from snowshed.study.owner import ownership, release_dead
from snowshed.study.resources import Resources
from snowshed.study.scene_hash import RunKey, is_hash
from snowshed.study.store import Store, StoredRun
from snowshed.study.study_record import renew_notes
from snowshed.study.workers import Workers

POLL_S = 0.25  # s between checks of interrupts and progress
ELSEWHERE_S = 1.0  # s between checks of what other processes compute
MAX_NOTES = 10  # notes issued after a session, each once
MAX_DEATHS = 3  # deaths of workers after which a run counts as failed


def compute_runs(
    folder: PathLike,
    study: str,
    axes: Sequence[str],
    runs: Sequence[RunKey],
    *,
    jobs: Optional[int] = None,
    threads: Optional[int] = None,
    scheduler: object = None,
    retry_failed: bool = False,
    keep_particles: bool = False,
    same_version: bool = False,
    progress: Optional[Reporter] = None,
) -> None:
    """Enter a study's runs into the store in a folder, and compute the missing ones.

    Parameters
    ----------
    study, axes, runs
        Name of the study, paths of the parameters that vary, and runs.
    folder, jobs, threads, scheduler, retry_failed, keep_particles, same_version, progress
        As for `Study.compute`.
    """
    resources = Resources(jobs, threads, scheduler)
    with Store.create(folder) as store:
        if study in store.studies() and (other := _difference(store, study, axes, runs)):
            issue_note(
                f"{study}: replaces a study of that name with {other}; its results stay in the "
                "store"
            )
        aside = store.register(
            study, axes, runs, keep_particles=keep_particles, same_version=same_version
        )
        if aside:
            issue_note(
                f"{plural(aside, 'run')} of {study}: computed by another build of snowshed "
                f"{_core.version}, and now again; the earlier results stay in the store, and "
                f"{_same_version()} uses them"
            )
        _compute(store, [study], resources, retry_failed, progress)


def _difference(store: Store, study: str, axes: Sequence[str], runs: Sequence[RunKey]) -> str:
    """Return in what a study differs from the stored one of its name; "" if it may extend it."""
    if store.axes(study) != list(axes):
        return "other parameters"
    stored = {run.hash for run in store.runs(study)}
    return (
        "" if stored & {run.hash for run in runs} or not stored else "another scene or other values"
    )


@checked
def resume(
    folder: PathLike,
    study: Optional[str] = None,
    *,
    jobs: Optional[int] = None,
    threads: Optional[int] = None,
    scheduler: object = None,
    retry_failed: bool = False,
    same_version: bool = False,
    progress: Optional[Reporter] = None,
) -> None:
    """Compute the missing runs of a study, or of all studies, in a store.

    Parameters
    ----------
    folder
        Folder of the store.
    study
        Name of the study; None: all.
    jobs, threads, scheduler, retry_failed, progress
        As for `Study.run`.
    same_version
        Whether to compute runs that another build of the same version has registered.

    Raises
    ------
    InputError
        If there is no such study, or another version or build of snowshed has registered its runs.
    StudyError, StudyInterrupted
        As for `Study.run`.
    """
    resources = Resources(jobs, threads, scheduler)
    with Store.open(folder) as store:
        names = store.studies() if study is None and store.studies() else [store.named(study)]
        for name in names:
            _adopt(store, name, same_version=same_version)
        _compute(store, names, resources, retry_failed, progress)
    for name in names:
        renew_notes(folder, name)


def expected_duration(scenes: Sequence[str], *, jobs: Optional[int] = None) -> tuple[float, int]:
    """Return the expected time of runs on this machine, s, and the number of runs at once.

    The machine's speed is measured for a fraction of a second.

    Parameters
    ----------
    scenes
        The complete scenes of the runs, as JSON.
    jobs
        As for `Study.compute`.
    """
    workers, at_once = Resources(jobs).workers(scenes)
    works = [cost_estimate.work(scene) for scene in scenes]
    threads = workers.threads(len(scenes))
    return cost_estimate.expected_time(scenes, works, at_once, threads), at_once


def _compute(
    store: Store,
    studies: Sequence[str],
    resources: Resources,
    retry_failed: bool,
    progress: Optional[Reporter],
) -> None:
    runs = {run.hash: run for name in studies for run in store.runs(name)}
    _remove_leftovers(store)  # before failed runs are reset: their folders may hold the failure
    if retry_failed:
        store.reset(hash_ for hash_, run in runs.items() if run.status == "failed")
        runs = {run.hash: run for name in studies for run in store.runs(name)}
    pending = [run for run in runs.values() if run.status == "pending"]
    _check_version(store, pending)
    notes = Counter(note for run in runs.values() for note in run.notes)
    if not pending:
        _issue_run_notes(notes)
        return
    workers, at_once = resources.workers([run.scene for run in pending])
    try:
        with ownership(store) as owner, deferred_interrupts() as interrupt:
            session = _Session(store, owner, workers, list(runs.values()), interrupt, notes)
            try:
                session.run(_Narrator(session, progress, at_once) if progress else None)
            finally:
                _issue_run_notes(session.notes)
    finally:
        workers.close()


def _issue_run_notes(notes: Counter[str]) -> None:
    """Issue the notes on runs, the most frequent first, and at last one on the errors of stacks."""
    errors = Counter({note: n for note, n in notes.items() if note.startswith(BEGINNING)})
    others = notes - errors
    for note, runs in others.most_common(MAX_NOTES):
        issue_note(f"{plural(runs, 'run')}: {note}", ResultNote)
    if len(others) > MAX_NOTES:
        issue_note(f"{len(others) - MAX_NOTES} further notes on runs", ResultNote)
    for note, runs in errors.most_common(1):
        rest = "" if len(errors) == 1 else f"; {sum(errors.values()) - runs} more have other errors"
        issue_note(f"{plural(runs, 'run')}: {note}{rest}", ResultNote)


def _check_version(store: Store, pending: Sequence[StoredRun]) -> None:
    for run in pending:
        if run.version != _core.version:
            raise InputError(
                f"{store.folder}: its runs are for snowshed {run.version}, but this is "
                f"{_core.version}; start the study again with {either(*STUDY_RUN)}, "
                "which computes all its runs with this version"
            )


def _same_version() -> str:
    return argument("same_version", True, option="same-version-is-enough")


def _adopt(store: Store, study: str, *, same_version: bool) -> None:
    """Make this build that of the pending runs of a study."""
    pending = [run for run in store.runs(study) if run.status == "pending"]
    _check_version(store, pending)
    others = {run.build for run in pending} - {build_id()}
    if not others:
        return
    if not same_version:
        raise InputError(
            f"{store.folder}: its runs are for another build of snowshed {_core.version}; "
            f"{_same_version()} goes on with this one, and {either(*STUDY_RUN)} computes all runs "
            "with it"
        )
    runs = [RunKey(run.hash, run.scene) for run in store.runs(study)]
    store.register(study, store.axes(study), runs, same_version=True)


def _remove_leftovers(store: Store) -> None:
    """Remove files of killed processes that no run needs to resume; foreign files stay."""
    for path in store.running.iterdir():
        if path.is_symlink():
            continue
        lock = path.is_file() and path.suffix == ".lock" and is_owner(path.stem)
        ended = path.is_dir() and is_hash(path.name) and store.state(path.name)[0] != "pending"
        if (lock or ended) and not is_held(path):
            path.unlink(missing_ok=True) if lock else _remove(path)


def _remove(folder: Path) -> None:
    """Remove the folder of a run with the files that a run writes."""
    if not folder.is_symlink():
        shutil.rmtree(folder, ignore_errors=True)


class _Session:
    """The computation of the missing runs of some studies."""

    def __init__(
        self,
        store: Store,
        owner: str,
        workers: Workers,
        runs: Sequence[StoredRun],
        interrupt: InterruptRequest,
        notes: Counter[str],
    ) -> None:
        self.store = store
        self.owner = owner
        self.workers = workers
        self.interrupt = interrupt
        self.counts = Counter(run.status for run in runs)
        pending = [run for run in runs if run.status == "pending"]
        self.work = {run.hash: cost_estimate.work(run.scene) for run in pending}
        # The longest first, so that no long run is left alone at the end.
        self.waiting = deque(sorted(pending, key=lambda run: -self.work[run.hash]))
        self.running: dict[str, StoredRun] = {}
        self.elsewhere: list[StoredRun] = []
        self.looked = -math.inf
        self.deaths: Counter[str] = Counter()
        self.notes = notes  # number of runs by note, those of earlier results among them

    def run(self, report: Optional[Callable[[], None]]) -> None:
        """Compute until no run is missing."""
        try:
            self._compute(report)
        except StudyError:
            with suppress(StudyError):  # the store itself may have failed
                self._stop()
            raise

    def _compute(self, report: Optional[Callable[[], None]]) -> None:
        while self.waiting or self.running or self.elsewhere:
            if self.interrupt.requested:
                self._stop()
                raise StudyInterrupted(self.store.folder)
            self._look_elsewhere()
            self._hand_out()
            if report:
                report()
            ended = self._wait()
            self._hand_out()  # before anything is stored: no worker need wait for the disk
            ended.sort(key=lambda pair: pair[1].status == "unable")  # raises: store the rest first
            for run, outcome in ended:
                self._settle(run, outcome)
        if report:
            report()

    def _hand_out(self) -> None:
        while self.waiting and not self.interrupt.requested and self._has_room():
            threads = self.workers.threads(len(self.waiting) + len(self.running))
            run = self.waiting.popleft()
            if self.store.claim(run.hash, self.owner):
                self.running[run.hash] = run
                folder = os.fspath(self._folder(run.hash))
                keep = run.keep_particles
                self.workers.submit(RunTask(run.hash, run.scene, folder, threads, keep, run.build))
            else:
                self.elsewhere.append(run)

    def _has_room(self) -> bool:
        return len(self.running) < self.workers.capacity

    def _look_elsewhere(self) -> None:
        """Take over runs of dead processes, and count the runs that others have done."""
        if not self.elsewhere or time.monotonic() < self.looked + ELSEWHERE_S:
            return
        self.looked = time.monotonic()
        release_dead(self.store)
        still = []
        for run in self.elsewhere:
            status, owner = self.store.state(run.hash)
            if status != "pending":
                self.notes.update(self.store.find(run.hash).notes)
                self._count(run.hash, status)
            elif owner is None:
                self.waiting.append(run)
            else:
                still.append(run)
        self.elsewhere = still

    def _wait(self) -> list[tuple[StoredRun, RunOutcome]]:
        """Wait a moment for runs to end; return those that have ended."""
        if self.running:
            ended = self.workers.collect(POLL_S)
            return [(self.running.pop(outcome.hash), outcome) for outcome in ended]
        time.sleep(POLL_S)
        return []

    def _settle(self, run: StoredRun, outcome: RunOutcome) -> None:
        if outcome.status == "unable":
            raise StudyError(str(outcome.error))
        if outcome.status == "lost":
            outcome = self._after_death(outcome)
        if outcome.status in ("done", "failed"):
            self._store(outcome)
        else:
            self.waiting.appendleft(run)

    def _after_death(self, outcome: RunOutcome) -> RunOutcome:
        """Return the outcome of a run whose worker died; a run fails after several deaths."""
        self.deaths[outcome.hash] += 1
        if self.deaths[outcome.hash] < MAX_DEATHS:
            return outcome
        error = f"gave up after {MAX_DEATHS} attempts: {outcome.error}"
        return RunOutcome(outcome.hash, "failed", error=error)

    def _store(self, outcome: RunOutcome) -> None:
        self.store.record(outcome)
        LOGGER.info("run %s %s", outcome.hash[:12], outcome.status)
        self.notes.update(outcome.notes)
        _remove(self._folder(outcome.hash))
        self._count(outcome.hash, outcome.status)

    def _count(self, hash_: str, status: str) -> None:
        self.counts["pending"] -= 1
        self.counts[status] += 1
        del self.work[hash_]

    def _stop(self) -> None:
        """Stop all workers at checkpoints, and store the runs that have ended."""
        for outcome in self.workers.stop():
            if outcome.status in ("done", "failed"):
                self._store(outcome)

    def _folder(self, hash_: str) -> Path:
        return self.store.running / hash_


class _Narrator:
    """Reports the progress of a session."""

    def __init__(self, session: _Session, report: Reporter, at_once: int) -> None:
        self._session = session
        self._report = report
        self._at_once = at_once
        scenes = [run.scene for run in session.waiting]
        works = [session.work[run.hash] for run in session.waiting]
        threads = session.workers.threads(len(works))
        self._work = sum(works) or 1.0
        self._expected = cost_estimate.expected_time(scenes, works, at_once, threads)

    def __call__(self) -> None:
        session = self._session
        left = sum(session.work.values())
        for hash_, fraction in session.workers.fractions.items():
            left -= session.work.get(hash_, 0.0) * fraction
        self._report(
            Progress(
                min(1.0, max(0.0, 1.0 - left / self._work)),
                session.counts["done"],
                sum(session.counts.values()),
                "runs",
                failed=session.counts["failed"],
                running=len(session.running),
                elsewhere=len(session.elsewhere),
                at_once=self._at_once,
                expected_s=self._expected,
            )
        )
