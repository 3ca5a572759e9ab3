"""Loading tests of grains: the results folder with its curve, and what it comes to.

Beside what every run writes (``snowshed.results.folder``), the folder holds

================== ==========================================================================
curve.csv          stresses, strains, bonds and contacts at 300 strains of each stage, and the
                   peaks of all time steps between them (`snowshed.methods.grains.curve`); it
                   grows while the test runs
contacts.csv       grains that touch at the end, with the force between them
grains.json        the figures of `snowshed.methods.grains.summary.GrainsSummary`
grains.png         the curve with its phases, broken bonds, coordination and energies
forces.png         the sample at the end with the forces between its grains
energy.csv         energy balance at the end (only with output.energy)
================== ==========================================================================

The .vtp files hold the spheres, each with the number of its grain.
"""

from __future__ import annotations

import json
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any, Optional

import snowshed._core as _core
from snowshed.base.interrupt import Interrupted, InterruptRequest, deferred_interrupts
from snowshed.base.machine import machine_facts
from snowshed.base.progress import Progress, Reporter
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import Table
from snowshed.methods.grains.contacts import GrainContacts
from snowshed.methods.grains.curve import LoadingCurve
from snowshed.methods.grains.sample_folder import LABELS, SYNTHETIC, find_sample
from snowshed.methods.grains.summary import GrainsSummary, summarise
from snowshed.running.sequence import (
    NotePasser,
    open_sequence,
    run_sequence,
    say_note,
    seal_files,
)
from snowshed.scene.scene import PathLike, SceneLike, resolve_scene

CURVE, SUMMARY, ENERGY = "curve.csv", "grains.json", "energy.csv"
WRITE_INTERVAL = 5.0  # s of wall time between two versions of curve.csv


def loading_curve(simulation: _core.Simulation) -> LoadingCurve:
    """Return what a loading test has measured so far.

    Raises
    ------
    InputError
        If the scene's method is another.
    """
    return LoadingCurve(simulation.grains_curve())


def grain_contacts(simulation: _core.Simulation) -> GrainContacts:
    """Return the grains that touch now.

    Raises
    ------
    InputError
        If the scene's method is another.
    """
    spheres, grain = simulation.grains_spheres()
    return GrainContacts(spheres, grain, *simulation.grains_contacts())


def run_grains(
    scene: SceneLike,
    out_dir: PathLike,
    *,
    resume: bool = False,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
) -> GrainsSummary:
    """Run a loading test into a results folder, and return its figures.

    Parameters
    ----------
    scene
        What to simulate; its method is "grains".
    out_dir
        The results folder; new or empty, unless resuming.
    resume
        Go on from the checkpoint in `out_dir`.
    progress
        Called with a `Progress` about twice a second.
    pictures
        Whether to draw ``grains.png`` and ``forces.png``.

    Raises
    ------
    InputError
        If the scene is wrong, the folder is not empty, or there is nothing to resume.
    SimulationError
        If the simulation cannot go on.
    Interrupted
        After Ctrl-C; a checkpoint holds the state to resume from.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.analysis.tomography.example import example_grains
    >>> with TemporaryDirectory() as folder:
    ...     scene = example_grains(folder).set("loading.0.strain", 0.001)
    ...     summary = run_grains(scene, folder + "/out", pictures=False)
    >>> summary.ended
    'rest'
    """
    folder = Path(out_dir)
    sequence = open_sequence(resolve_scene(scene), folder, resume=resume)
    with sequence, deferred_interrupts() as interrupt:
        sequence.describe_machine(machine_facts())
        simulation = sequence.simulation
        sample_notes = [note] if (note := simulation.label_note()) else []
        for note in sample_notes:
            say_note(sequence, note)
        recorder = _Recorder(sequence, folder, interrupt, progress)
        try:
            run_sequence(sequence, recorder, folder)
        except Interrupted:
            recorder.write_curve()
            raise
        recorder.write_curve()
        (facts,) = sequence.finished_events
        curve, contacts = loading_curve(simulation), grain_contacts(simulation)
        data = json.loads(simulation.scene)
        summary = summarise(
            curve, data, ended=facts["ended"], grains=simulation.particle_count,
            spheres=len(contacts.spheres), synthetic=_synthetic(data), sample_notes=sample_notes,
        )  # fmt: skip
        write_text(folder / SUMMARY, json.dumps(asdict(summary), indent=2) + "\n")
        write_text(folder / "contacts.csv", contacts.text())
        if facts["energy"]:
            energies = Table(folder / ENERGY)
            energies.keep_through(0)  # a finished test may be resumed, too
            energies.add([{"event": 1, **facts["energy"]}])
            seal_files(sequence, folder, ENERGY)
        seal_files(sequence, folder, CURVE, SUMMARY, "contacts.csv")
        sequence.rewrite_record()
        if pictures:
            _draw(folder, data, curve, contacts)
    return summary


class _Recorder(NotePasser):
    """Passes on how far the test has come, and writes its curve now and then."""

    def __init__(
        self,
        sequence: _core.EventSequence,
        folder: Path,
        interrupt: InterruptRequest,
        report: Optional[Reporter],
    ) -> None:
        self.sequence = sequence
        self.simulation = simulation = sequence.simulation
        self.folder = folder
        self.interrupt = interrupt
        self.report = report
        self.stages = json.loads(simulation.scene)["loading"]
        self.written = time.monotonic()

    def between_events(self) -> None:
        """Do nothing: a loading test has one event."""

    def event_begun(self, reseeding: Optional[dict[str, Any]]) -> None:
        """Report the beginning."""
        self._tell({"time_s": self.simulation.time_s, "progress": 0.0, "updates_per_s": 0.0})

    def progress(self, report: dict[str, Any]) -> None:
        """Pass on how far the test has come."""
        if time.monotonic() >= self.written + WRITE_INTERVAL:
            self.write_curve()
        self._tell(report)

    def event_ended(self, facts: dict[str, Any]) -> None:
        """Report the end."""
        self._tell({"time_s": facts["sim_time_s"], "progress": 1.0, "updates_per_s": 0.0})

    def before_checkpoint(self) -> None:
        """Write the curve, so that run.json knows it as the checkpoint does."""
        self.write_curve()
        seal_files(self.sequence, self.folder, CURVE)

    def stop_requested(self) -> bool:
        """Return whether to stop at the next safe point."""
        return self.interrupt.requested

    def write_curve(self) -> None:
        """Write the curve as it is now."""
        write_text(self.folder / CURVE, loading_curve(self.simulation).text())
        self.written = time.monotonic()

    def _tell(self, report: dict[str, Any]) -> None:
        if self.report is None:
            return
        done = report["progress"]
        self.report(
            Progress(
                done,
                int(done == 1.0),
                1,
                "loading tests",
                self._doing(),
                event=1,
                time=report["time_s"],
                updates_per_s=report["updates_per_s"],
            )
        )

    def _doing(self) -> str:
        """Return the stage, and the last row of the curve, in words."""
        last = {name: values[-1] for name, values in self.simulation.grains_curve().items()}
        stage = min(int(last["stage"]), len(self.stages))
        kind = self.stages[stage - 1]["kind"]
        return f"stage {stage} of {len(self.stages)}, {kind}: {_reading(kind, last)}"


def _reading(kind: str, row: dict[str, float]) -> str:
    """Return what a stage builds up, in words."""
    if kind == "penetrate":
        return f"{row['cone_force_n']:.3g} N"
    if kind == "shear":
        return f"{row['shear_strain']:.1%}, {row['shear_stress_pa'] / 1e3:.3g} kPa"
    return f"{abs(row['axial_strain']):.1%}, {row['top_stress_pa'] / 1e3:.3g} kPa"


def _synthetic(scene: dict[str, Any]) -> str:
    """Return how the sample was made, if its folder or the scene's title says it is synthetic."""
    title = str(scene.get("title", ""))
    known = find_sample(scene["sample"]["file"], LABELS).source
    return known or (title if title.startswith(SYNTHETIC) else "")


def _draw(
    folder: Path, scene: dict[str, Any], curve: LoadingCurve, contacts: GrainContacts
) -> None:
    from snowshed.plot.figure_style import save
    from snowshed.plot.force_chains import force_figure
    from snowshed.plot.loading_figure import loading_figure

    kinds, title = [stage["kind"] for stage in scene["loading"]], scene.get("title", "")
    save(loading_figure(curve, kinds, title), folder / "grains.png")
    save(force_figure(contacts, scene["sample"]["voxel_size"], title), folder / "forces.png")
