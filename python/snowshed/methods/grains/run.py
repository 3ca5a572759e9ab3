"""Loading tests of grains: the results folder with its curve and its figures.

Besides the files of every run (``snowshed.results.folder``), the folder holds

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

import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, ClassVar

from snowshed.base.notes import InputNote, ResultNote
from snowshed.io.atomic import write_text
from snowshed.methods.grains.contacts import CONTACTS, grain_contacts
from snowshed.methods.grains.curve import CURVE, loading_curve
from snowshed.methods.grains.sample_folder import LABELS, SYNTHETIC, find_sample
from snowshed.methods.grains.summary import GrainsSummary, summarise
from snowshed.running.method_run import Cell, MethodRun, summary_rows
from snowshed.running.sequence import record_note, seal_files

WRITE_INTERVAL = 5.0  # s of wall time between two versions of curve.csv


class GrainsRun(MethodRun):
    """Writes the curve of a loading test while it runs, and its figures at the end."""

    UNIT: ClassVar[str] = "loading tests"
    COLUMNS: ClassVar[Mapping[str, type]] = {"steps": int, **GrainsSummary.columns()}

    def begin(self) -> None:
        """Issue the notes on the sample."""
        self.stages = self.scene.data["loading"]
        self.sample_notes = [note] if (note := self.simulation.input_note()) else []
        for note in self.sample_notes:
            record_note(self.sequence, note, InputNote)
        self.written = time.monotonic()

    def status_line(self, time_s: float) -> str:
        """Return the stage, and the last row of the curve."""
        last = {name: values[-1] for name, values in self.simulation.grains_curve().items()}
        stage = min(int(last["stage"]), len(self.stages))
        kind = self.stages[stage - 1]["kind"]
        return f"stage {stage} of {len(self.stages)}, {kind}: {_reading(kind, last)}"

    def progress(self) -> None:
        """Write the curve now and then."""
        if time.monotonic() >= self.written + WRITE_INTERVAL:
            self._write_curve()

    def before_checkpoint(self) -> None:
        """Write the curve, so that run.json and the checkpoint hold the same rows."""
        self._write_curve()
        seal_files(self.sequence, self.folder, CURVE)

    def interrupted(self) -> None:
        """Write the curve so far."""
        self._write_curve()

    def finish(self) -> None:
        """Write curve, contacts, summary and energies."""
        self._write_curve()
        (facts,) = self.sequence.finished_events
        self.curve, self.contacts = loading_curve(self.simulation), grain_contacts(self.simulation)
        scene = self.scene.data
        summary = summarise(
            self.curve, scene, ended=facts["ended"], grains=self.simulation.particle_count,
            spheres=len(self.contacts.spheres), synthetic=_synthetic(scene),
            sample_notes=self.sample_notes,
        )  # fmt: skip
        summary.write(self.folder)
        for note in summary.notes:
            record_note(self.sequence, note, ResultNote)
        write_text(self.folder / CONTACTS, self.contacts.text())
        self.write_energies(facts, history=False)  # the curve has the energies over time
        seal_files(self.sequence, self.folder, CURVE, GrainsSummary.FILE, CONTACTS)
        self.sequence.rewrite_record()

    def draw(self) -> None:
        """Draw ``grains.png`` and ``forces.png``."""
        from snowshed.plot.figure_style import save_figure
        from snowshed.plot.force_chains import force_figure
        from snowshed.plot.loading_figure import loading_figure

        title, size = self.scene.data.get("title", ""), self.scene.data["sample"]["voxel_size"]
        kinds = [stage["kind"] for stage in self.stages]
        save_figure(loading_figure(self.curve, kinds, title), self.folder / "grains.png")
        save_figure(force_figure(self.contacts, size, title), self.folder / "forces.png")

    @classmethod
    def rows(cls, folder: Path) -> list[dict[str, Cell]]:
        """Return the figures of ``grains.json``."""
        return summary_rows(folder, GrainsSummary)

    @classmethod
    def stored_data(cls, folder: Path) -> Iterable[tuple[int, bytes]]:
        """Yield the curve."""
        if (folder / GrainsSummary.FILE).is_file():
            yield 1, (folder / CURVE).read_bytes()

    def _write_curve(self) -> None:
        write_text(self.folder / CURVE, loading_curve(self.simulation).text())
        self.written = time.monotonic()


def _reading(kind: str, row: Mapping[str, float]) -> str:
    """Return the strain and stress of a stage, or its force, with units."""
    if kind == "penetrate":
        return f"{row['cone_force_n']:.3g} N"
    if kind == "shear":
        return f"{row['shear_strain']:.1%}, {row['shear_stress_pa'] / 1e3:.3g} kPa"
    return f"{abs(row['axial_strain']):.1%}, {row['top_stress_pa'] / 1e3:.3g} kPa"


def _synthetic(scene: Mapping[str, Any]) -> str:
    """Return the origin of a sample that its folder or the scene's title declares synthetic."""
    title = str(scene.get("title", ""))
    known = find_sample(scene["sample"]["file"], LABELS).source
    return known or (title if title.startswith(SYNTHETIC) else "")
