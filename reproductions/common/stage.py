"""Stages of a reproduction, and stages that compute studies."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Protocol

from snowshed._core import InputError
from snowshed.base.progress import Progress, Reporter
from snowshed.study import Study, cost_estimate
from snowshed.study.resources import Resources
from snowshed.study.session import resume
from snowshed.study.store import Store, StoredRun

#: Function that receives the finished part of a stage, 0 to 1, and its current step.
StageReporter = Callable[[float, str], None]


@dataclass(frozen=True)
class State:
    """Progress of a stage.

    Attributes
    ----------
    done, failed, count
        Units of work: simulations, or outer folds.
    unit
        Name of the units.
    reason
        Reason of the failures, if it is the same for all.
    """

    done: int
    failed: int
    count: int
    unit: str = "simulations"
    reason: str = ""

    @property
    def finished(self) -> bool:
        """True if nothing is left to compute."""
        return self.done + self.failed == self.count

    @property
    def complete(self) -> bool:
        """True if all is computed, and nothing failed."""
        return self.done == self.count

    def text(self) -> str:
        """Return the state as text.

        Examples
        --------
        >>> State(3, 1, 9).text()
        '3 of 9 simulations done, 1 failed'
        """
        failed = f", {self.failed} failed" if self.failed else ""
        failed += f" ({self.reason})" if self.reason else ""
        return f"{self.done} of {self.count} {self.unit} done{failed}"


class Stage(Protocol):
    """A part of the work, which `--stage` selects by its name."""

    @property
    def name(self) -> str:
        """The name for ``--stage``."""

    def state(self) -> State:
        """Return its progress."""

    def expected_s(self, jobs: Optional[int]) -> float:
        """Return the expected remaining time, s."""

    def compute(self, jobs: Optional[int], report: StageReporter) -> None:
        """Compute the rest."""

    def failure(self) -> str:
        """Return a text on the failures; empty if nothing failed."""


class StudyStage:
    """A stage that computes studies, in a store that stages share."""

    def __init__(
        self,
        name: str,
        runs: Path,
        make: Callable[[], Sequence[Study]],
        *,
        keep_particles: bool = False,
    ) -> None:
        self.name = name
        self._keep_particles = keep_particles
        self.runs = runs
        self._make = make
        self._names: Optional[list[str]] = None

    def state(self) -> State:
        """Return its progress."""
        counts = Counter(run.status for run in self._stored_runs())
        return State(counts["done"], counts["failed"], sum(counts.values()))

    def expected_s(self, jobs: Optional[int]) -> float:
        """Return the expected remaining time, s; measures the machine's speed."""
        pending = [run.scene for run in self._stored_runs() if run.status == "pending"]
        if not pending:
            return 0.0
        workers, at_once = Resources(jobs).workers(pending)
        try:
            threads = workers.threads(len(pending))
        finally:
            workers.close()
        return cost_estimate.expected_time(
            pending, [cost_estimate.work(scene) for scene in pending], at_once, threads
        )

    def compute(self, jobs: Optional[int], report: StageReporter) -> None:
        """Compute the rest; raises StudyInterrupted after Ctrl-C."""
        names = self._register_studies()
        for number, name in enumerate(names):

            def report_runs(progress: Progress, name: str = name, number: int = number) -> None:
                text = f"{name}: {progress.done}/{progress.count} simulations"
                report((number + progress.fraction) / len(names), text)

            resume(self.runs, name, jobs=jobs, same_version=True, progress=report_runs)

    def failure(self) -> str:
        """Return a text with the number of failed simulations; empty if none failed."""
        failed = self.state().failed
        return f"{failed} of {self.name}" if failed else ""

    def scenes(self, study: str) -> list[str]:
        """Return the complete scenes of a study, as JSON."""
        self._register_studies()
        with Store.open(self.runs) as store:
            return [run.scene for run in store.runs(study)]

    def _register_studies(self) -> list[str]:
        """Enter the studies into the store, once; return their names."""
        if self._names is None:
            studies = self._make()
            with Store.create(self.runs) as store:
                for study in studies:
                    store.register(
                        study.name, study.axes, study.runs(), keep_particles=self._keep_particles,
                        same_version=True,
                    )  # fmt: skip
            self._names = [study.name for study in studies]
        return self._names

    def _stored_runs(self) -> list[StoredRun]:
        names = self._register_studies()
        with Store.open(self.runs) as store:
            runs = {run.hash: run for name in names for run in store.runs(name)}
        return list(runs.values())


def choose(stages: Sequence[Stage], names: Sequence[str]) -> list[Stage]:
    """Return the stages with the given names, in their order; all stages if no name is given.

    Raises
    ------
    InputError
        If a name is unknown.
    """
    known = [stage.name for stage in stages]
    for name in names:
        if name not in known:
            raise InputError(f"stage: {name!r} is unknown; allowed: {', '.join(known)}")
    return [stage for stage in stages if not names or stage.name in names]


def compute(
    stages: Sequence[Stage], *, jobs: Optional[int] = None, progress: Optional[Reporter] = None
) -> None:
    """Compute the rest of some stages.

    Parameters
    ----------
    stages
        From `choose`.
    jobs
        Processes at once; None: as many as there are cores.
    progress
        Called a few times a second.

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C (such as StudyInterrupted); finished work is kept.
    InputError, StudyError
        If a stage cannot be computed.
    """
    expected = [stage.expected_s(jobs) for stage in stages]
    total_s = sum(expected) or 1.0
    for number, stage in enumerate(stages):
        before = sum(expected[:number])

        def report(
            fraction: float, doing: str, number: int = number, before: float = before
        ) -> None:
            if progress is not None:
                done = (before + fraction * expected[number]) / total_s
                count = len(stages)
                progress(Progress(done, number, count, "stages", doing, expected_s=total_s))

        stage.compute(jobs, report)
