"""Computing a case, and storing its snow.

A case has a folder with a file for each time, and a checkpoint from which it resumes.
"""

from __future__ import annotations

import io
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

import numpy as np

from reproductions.common.stage import StageReporter, State
from reproductions.saito2012.cases import Case
from snowshed._core import SimulationError
from snowshed.base.arrays import Floats, Integers
from snowshed.io.atomic import replacing, write_text
from snowshed.running.simulation import Simulation
from snowshed.scene.scene import SceneLike

CHECKPOINT, FAILURE = "checkpoint.bin", "failed.txt"
# For estimates of run time.
PARTICLE_STEPS_PER_S = 1e5
SPEED_OVER_FREE_FALL = 0.3  # typical speed of the snow relative to free fall
PROGRESS_PARTS = 64  # progress reports between two stored times


@dataclass(frozen=True)
class Snow:
    """The snow at a time in s: positions in m, velocities in m/s, kinds (1 is erodible)."""

    time: float
    positions: Floats
    velocities: Floats
    kinds: Integers


class CaseStage:
    """The stage of a case.

    Parameters
    ----------
    case, folder
        The case, and the folder of all cases.
    """

    def __init__(self, case: Case, folder: Path) -> None:
        self.case = case
        self.folder = folder / case.file

    @property
    def name(self) -> str:
        """The name for ``--stage``."""
        return self.case.file

    def state(self) -> State:
        """Return its progress."""
        reason = self._failure_reason()
        done, count = len(self._stored_files()), len(self.case.times)
        return State(done, count - done if reason else 0, count, "times", reason)

    def failure(self) -> str:
        """Return the reason of its failure; empty if it did not fail."""
        reason = self._failure_reason()
        return f"{self.case.name}: {reason}" if reason else ""

    def expected_s(self, jobs: Optional[int]) -> float:
        """Return the estimated remaining time, s."""
        del jobs  # a case is one run
        left = len(self.case.times) - len(self._stored_files())
        if self.failure() or not left:
            return 0.0
        simulation = self._simulation(0)
        spacing = float(getattr(self.case.scene.numerics, "spacing", 0) or 0.01)
        speed = SPEED_OVER_FREE_FALL * math.sqrt(2 * 9.81 * self.case.profile.corners[0][1])
        steps = left * self.case.interval * speed / (0.2 * spacing)
        return steps * simulation.particle_count / PARTICLE_STEPS_PER_S

    def snow(self) -> list[Snow]:
        """Return the snow at all stored times."""
        snow = []
        for file in self._stored_files():
            with np.load(file, allow_pickle=False) as data:
                snow.append(
                    Snow(float(data["time"]), data["positions"], data["velocities"], data["kinds"])
                )
        return snow

    def compute(self, jobs: Optional[int], report: StageReporter) -> None:
        """Compute the rest; a case that fails records the reason in its folder."""
        del jobs
        state = self.state()
        if state.finished:
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        try:
            self._resume(state.done, report)
        except SimulationError as error:
            write_text(self.folder / FAILURE, f"{error}\n")

    def _resume(self, done: int, report: StageReporter) -> None:
        simulation = self._simulation(done)
        times = self.case.times
        for number in range(done, len(times)):
            start = simulation.time
            for part in range(1, PROGRESS_PARTS + 1):
                until = start + (times[number] - start) * part / PROGRESS_PARTS
                if until > simulation.time:  # a long step may have passed it
                    simulation.run(until=until)
                text = f"{self.case.name}: {simulation.time:.2f} of {times[-1]:g} s"
                report(min(1.0, simulation.time / times[-1]), text)
            self._keep(simulation, number)

    def _simulation(self, done: int) -> Simulation:
        file = self.folder / CHECKPOINT
        if done and file.is_file():
            return Simulation.load(file)
        scene: SceneLike = self.case.scene
        simulation = Simulation(scene)
        simulation.begin_event()
        return simulation

    def _keep(self, simulation: Simulation, number: int) -> None:
        file = io.BytesIO()
        np.savez_compressed(
            file,
            time=simulation.time,
            positions=simulation.positions().astype(np.float32),
            velocities=simulation.velocities().astype(np.float32),
            kinds=simulation.fields["particle_kind"].by_id().astype(np.uint8),
        )
        simulation.save(self.folder / CHECKPOINT)
        with replacing(self.folder / f"{number:03d}.npz") as written:
            written.write_bytes(file.getvalue())

    def _failure_reason(self) -> str:
        """Return the error that ended the case; empty if none did."""
        file = self.folder / FAILURE
        return file.read_text(encoding="utf-8").strip() if file.is_file() else ""

    def _stored_files(self) -> list[Path]:
        return sorted(self.folder.glob("[0-9][0-9][0-9].npz"))
