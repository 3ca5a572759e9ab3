"""The part of a method in a run: measures, files and pictures, and the rows of tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Optional, Union

import snowshed._core as _core
from snowshed.io.csv_table import Table
from snowshed.io.raster.output import MapFormat
from snowshed.results.energies import draw_energies, write_energy_history
from snowshed.results.folder import ENERGY, RunFolder
from snowshed.results.reader import HISTORY, Results
from snowshed.running.sequence import seal_files
from snowshed.scene.resolved import ResolvedScene

if TYPE_CHECKING:
    from snowshed.running.ageing.ageing import Ageing

Cell = Union[int, float, str, None]


@dataclass(frozen=True)
class RunOptions:
    """Options of a run; see `snowshed.run`."""

    resume: bool = False
    ageing: Optional[Ageing] = None
    pictures: bool = True
    compact: bool = False
    map_format: MapFormat = "ascii"


class MethodRun:
    """A run of a scene. Each method has a subclass, which overrides the steps it needs.

    The methods are called in the order in which they stand here; those from `between_events` to
    `before_checkpoint` for each event.

    Parameters
    ----------
    sequence
        The core's sequence of events.
    scene, folder, options
        The scene, its results folder, and the options of the run.

    Attributes
    ----------
    UNIT
        Unit of the progress.
    COLUMNS
        Columns of a table of events besides ``event`` and ``wall_s``, with int, float or str.
    """

    UNIT: ClassVar[str] = "events"
    COLUMNS: ClassVar[Mapping[str, type]] = {"steps": int, "sim_time_s": float, "ended": str}

    def __init__(
        self,
        sequence: _core.EventSequence,
        scene: ResolvedScene,
        folder: Path,
        options: RunOptions,
    ) -> None:
        self.sequence, self.simulation = sequence, sequence.simulation
        self.scene, self.folder, self.options = scene, folder, options
        self.keeps_energy = bool(scene.data["output"]["energy"])

    def begin(self) -> None:
        """Prepare the folder, before the first step or the first one after a pause."""

    def between_events(self) -> None:
        """Change the snow between two events."""

    def event_begun(self, reseeding: Optional[dict[str, Any]]) -> None:
        """Record that an event begins; `reseeding` holds the stack before and after reseeding."""

    def status_line(self, time_s: float) -> str:
        """Return the status line for people at a time of the event, s."""
        return f"{time_s:.2f} s of event {self.simulation.event}"

    def progress(self) -> None:
        """Do the work that is due about twice a second."""

    def event_ended(self, facts: Mapping[str, Any]) -> None:
        """Write the results of an event."""

    def before_checkpoint(self) -> None:
        """Write the files that a run needs when it resumes from the checkpoint."""

    def interrupted(self) -> None:
        """Write the results so far, because the run stops."""

    def finish(self) -> None:
        """Write the results of the run, once all events have ended."""

    def draw(self) -> None:
        """Draw the pictures."""

    def write_energies(self, facts: Mapping[str, Any], *, history: bool = True) -> None:
        """Write the energy balance of a run with a single event: at its end, and over time."""
        if not self.keeps_energy:
            return
        energies = Table(self.folder / ENERGY)
        energies.keep_through(0)  # a finished run may be resumed, too
        energies.add([{"event": 1, **facts["energy"]}])
        if history:
            write_energy_history(self.simulation, self.folder)
        seal_files(self.sequence, self.folder, ENERGY, *([HISTORY] if history else []))

    def draw_energies(self) -> None:
        """Draw the energies over time, if they are recorded."""
        if self.keeps_energy:
            draw_energies(Results.of_run(self.folder, self.scene))

    @classmethod
    def rows(cls, folder: Path) -> list[dict[str, Cell]]:
        """Return a row for each event that has ended: ``event``, ``wall_s`` and `COLUMNS`."""
        finished = RunFolder(folder).read_run().get("finished_events", ())
        return [
            {name: facts[name] for name in ("event", "wall_s", *cls.COLUMNS)} for facts in finished
        ]

    @classmethod
    def stored_data(cls, folder: Path) -> Iterable[tuple[int, bytes]]:
        """Yield each event with the data that a study stores of it for later measures."""
        return ()


def summary_rows(folder: Path, summary: type[Any]) -> list[dict[str, Cell]]:
    """Return the row of a run with a single event, whose figures are those of a `Summary`."""
    if not (folder / summary.FILE).is_file():
        return []
    figures = summary.read(folder)
    (event,) = RunFolder(folder).read_run()["finished_events"]
    figures = {name: getattr(figures, name) for name in summary.columns()}
    return [{"event": 1, "wall_s": event["wall_s"], "steps": event["steps"], **figures}]
