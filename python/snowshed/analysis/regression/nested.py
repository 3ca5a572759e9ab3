"""The nested cross-validation, fold by fold: in parallel, kept on disk, resumable."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.analysis.regression.fold_result import FoldResult
from snowshed.analysis.regression.folds import CrossValidation
from snowshed.analysis.regression.kinds import Kind
from snowshed.analysis.regression.rows import StackRows
from snowshed.analysis.regression.scaling import Scaling
from snowshed.analysis.regression.task import FoldTask, compute
from snowshed.analysis.regression.threads import one_thread
from snowshed.base.interrupt import InterruptRequest, deferred_interrupts
from snowshed.base.pool.pool import Pool, TaskEnd
from snowshed.base.progress import Progress, Reporter
from snowshed.io.atomic import remove_leftovers
from snowshed.io.folders import claim_folder
from snowshed.io.locks import holding, is_held

IDENTITY = "regression.json"
FORMAT = 2  # of stored folds; those of another format are computed again
POLL_S = 0.25  # s between checks of interrupts


Results = dict[FoldTask, FoldResult]


class RegressionInterrupted(KeyboardInterrupt):
    """A regression was interrupted; the folds that were done are kept in its folder."""

    def __init__(self, folder: Path) -> None:
        super().__init__(f"interrupted; the same command resumes from {folder}")


def cross_validate(
    rows: StackRows,
    folder: Path,
    *,
    targets: Sequence[str],
    kinds: dict[str, Kind],
    scheme: CrossValidation,
    jobs: int = 1,
    progress: Optional[Reporter] = None,
) -> Results:
    """Compute the outer folds that the folder does not hold, and return all of them.

    Parameters
    ----------
    rows
        The data set.
    folder
        Folder for each fold's result, written as soon as it is done.
    targets, kinds
        Quantities to predict, and kinds of model.
    scheme
        Rounds and folds.
    jobs
        Processes; each uses one thread.
    progress
        Called after each fold.

    Raises
    ------
    InputError
        If the folder holds results of other rows or other folds.
    RegressionInterrupted
        On Ctrl-C or SIGTERM; results of finished folds are kept.
    """
    scheme.check(rows)
    if is_held(folder):
        raise InputError(f"{folder}: in use: another regression writes into this folder")
    _claim(folder, rows, scheme)
    points = Scaling.of(rows.inputs).scaled(rows.inputs)
    tasks = [
        FoldTask(target, kind, round_, fold)
        for target in targets
        for kind in kinds
        for round_ in range(scheme.rounds)
        for fold in range(scheme.folds)
    ]
    results = {task: FoldResult.load(folder / task.file, points) for task in tasks}
    missing = [task for task, result in results.items() if result is None]
    tracker = _Tracker(missing, len(tasks), kinds, progress)
    with holding(folder, _make), deferred_interrupts() as request:
        remove_leftovers(folder)
        for task in _compute_tasks(missing, rows, scheme, folder, jobs, request):
            results[task] = FoldResult.load(folder / task.file, points)
            tracker.advance(task)
        if request.requested:
            raise RegressionInterrupted(folder)
    return {task: result for task, result in results.items() if result is not None}


def _make(folder: Path) -> None:
    folder.mkdir(exist_ok=True)


class _Tracker:
    """Turns finished tasks into progress; kinds of model take different times."""

    def __init__(
        self,
        missing: Sequence[FoldTask],
        count: int,
        kinds: dict[str, Kind],
        report: Optional[Reporter],
    ) -> None:
        self._cost = {name: kind.cost_s for name, kind in kinds.items()}
        self._title = {name: kind.title for name, kind in kinds.items()}
        self._work = sum(self._cost[task.kind] for task in missing)
        self._count, self._done = count, count - len(missing)
        self._finished = 0.0
        self._report = report
        if missing:
            self._report_fold(missing[0])

    def advance(self, task: FoldTask) -> None:
        self._done += 1
        self._finished += self._cost[task.kind]
        self._report_fold(task)

    def _report_fold(self, task: FoldTask) -> None:
        if self._report is not None:
            doing = f"{task.target}, {self._title[task.kind]}"
            fraction = self._finished / self._work
            self._report(Progress(fraction, self._done, self._count, "folds", doing))


def _claim(folder: Path, rows: StackRows, scheme: CrossValidation) -> None:
    """Record the subject of the folder's results, or refuse a folder with other results.

    The number of rounds may grow, because each round splits the rows by itself.
    """
    folds = asdict(scheme)
    del folds["rounds"]
    identity = {"format": FORMAT, "rows": rows.digest, "folds": folds}
    others = "of another table, with other folds, or by another version of snowshed"
    claim_folder(folder, IDENTITY, identity, "regression", others)


def _compute_tasks(
    tasks: Sequence[FoldTask],
    rows: StackRows,
    scheme: CrossValidation,
    folder: Path,
    jobs: int,
    request: InterruptRequest,
) -> Iterator[FoldTask]:
    """Compute tasks and store their results; yield each when it is stored."""
    if jobs == 1 or len(tasks) < 2:
        with one_thread():
            for task in tasks:
                if request.requested:
                    return
                compute(task, rows, scheme).save(folder / task.file)
                yield task
        return
    waiting = list(reversed(tasks))
    with Pool(min(jobs, len(tasks)), partial(_work, rows, scheme, folder.absolute())) as pool:
        try:
            while (waiting or pool.fractions) and not request.requested:
                while waiting and len(pool.fractions) < pool.capacity:
                    pool.submit(waiting.pop())
                for ended in pool.collect(POLL_S):
                    yield _outcome(ended)
        finally:
            _end(pool, folder)


def _outcome(ended: TaskEnd[FoldTask, None]) -> FoldTask:
    if ended.error is not None:
        raise ended.error
    if ended.death:
        raise OSError(None, f"a process {ended.death}, perhaps for lack of memory")
    return ended.task


def _end(pool: Pool[FoldTask, None], folder: Path) -> None:
    """End the processes immediately, and remove their unfinished files."""
    pool.close()
    remove_leftovers(folder)


def _work(
    rows: StackRows,
    scheme: CrossValidation,
    folder: Path,
    task: FoldTask,
    report: Callable[[float], None],
) -> None:
    """Compute a fold in a process of its own and store its result."""
    with one_thread():
        result = compute(task, rows, scheme)
    result.save(folder / task.file)
