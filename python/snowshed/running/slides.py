"""Runs of a snow slide: the results folder with its maps, and what they come to.

Beside what every run writes (``snowshed.results.folder``), the folder holds

================== ==========================================================================
peaks/             largest values over time: thickness (pft, m), speed (pfv, m/s) and pressure
                   (ppr, kPa), as ESRI ASCII grids; a .prj holds the coordinate system, if known
flow/              thickness (FT) and speed (FV) at the end
slide.json         the figures of `SlideSummary`
slide.png          the map: terrain, peak speed, outline of the release
slide.html         the page: maps, the slide over time, release, mass and settings
energy.csv         energy balance at the end (only with output.energy)
energy_history.csv the same over time, with energy.png, a picture of it
================== ==========================================================================
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

import snowshed._core as _core
from snowshed.base.interrupt import InterruptRequest, deferred_interrupts
from snowshed.base.machine import machine_facts
from snowshed.base.progress import Progress, Reporter
from snowshed.io.atomic import replacing, write_text
from snowshed.io.csv_table import Table
from snowshed.io.film import FILM, Film
from snowshed.io.raster.output import write_raster
from snowshed.methods.slide.frames import Frame, slide_frames
from snowshed.methods.slide.maps import SlideMaps, slide_maps
from snowshed.methods.slide.peak_maps import PeakMaps
from snowshed.methods.slide.summary import SlideSummary
from snowshed.methods.slide.validity import (
    ReleaseArea,
    release_areas,
    thickness_map,
    validity_notes,
)
from snowshed.results.energies import draw_energies, write_energy_history
from snowshed.results.reader import HISTORY
from snowshed.running.sequence import NotePasser, open_sequence, run_sequence, seal_files
from snowshed.scene.components import Outline
from snowshed.scene.scene import PathLike, SceneLike, resolve_scene
from snowshed.scene.terrain_grid import release_outlines

if TYPE_CHECKING:
    import pandas as pd

SUMMARY, ENERGY = "slide.json", "energy.csv"
PACKED = "peaks.npz"  # the peak maps, where no rasters are wanted


def run_slide(
    scene: SceneLike,
    out_dir: PathLike,
    *,
    resume: bool = False,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
    rasters: bool = True,
) -> SlideSummary:
    """Run a slide into a results folder, and return its figures.

    Parameters
    ----------
    scene
        What to simulate; its method is "slide".
    out_dir
        The results folder; new or empty, unless resuming.
    resume
        Go on from the checkpoint in `out_dir`.
    progress
        Called with a `Progress` about twice a second.
    pictures
        Whether to draw ``slide.png`` and write ``slide.html``.
    rasters
        Whether to write the maps as rasters; else ``peaks.npz`` holds the peak maps
        (`snowshed.methods.slide.peak_maps.PeakMaps`), which is quicker and smaller.

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
    >>> from snowshed.scene.builders import example_slide
    >>> with TemporaryDirectory() as folder:
    ...     scene = example_slide(folder).set("events.max_time", 0.5)
    ...     summary = run_slide(scene, folder + "/out", pictures=False)
    >>> summary.ended
    'time_limit'
    """
    ready = resolve_scene(scene)
    sequence = open_sequence(ready, out_dir, resume=resume)
    with sequence, deferred_interrupts() as interrupt:
        sequence.describe_machine(machine_facts())
        recorder = _Recorder(sequence.simulation, interrupt, progress)
        run_sequence(sequence, recorder, out_dir)
        (facts,) = sequence.finished_events
        maps = slide_maps(sequence.simulation)
        terrain = json.loads(sequence.simulation.scene)["terrain"]
        depth = thickness_map(terrain, Path(ready.base_dir))
        areas = release_areas(maps.raster(maps.terrain), terrain["release"], depth)
        summary = _summary(sequence.simulation, facts, maps, areas)
        if rasters:
            _write(Path(out_dir), maps, summary, _crs(sequence.simulation))
        else:
            _write_packed(Path(out_dir), maps, summary)
        if facts["energy"]:
            energies = Table(Path(out_dir) / ENERGY)
            energies.keep_through(0)  # a finished slide may be resumed, too
            energies.add([{"event": 1, **facts["energy"]}])
            write_energy_history(sequence.simulation, out_dir)
            seal_files(sequence, out_dir, ENERGY, HISTORY)
        seal_files(sequence, out_dir, SUMMARY)
        sequence.rewrite_record()
        if pictures and facts["energy"]:
            draw_energies(out_dir)
        if pictures:
            _draw(Path(out_dir), sequence.simulation, maps, areas, summary)
    return summary


def particles_at(scene: SceneLike, steps: Sequence[int]) -> dict[int, pd.DataFrame]:
    """Return the particles after some numbers of steps, whether the slide rests by then or not.

    Parameters
    ----------
    scene
        A scene whose method is "slide".
    steps
        Numbers of steps, 0 for the release.

    Returns
    -------
    dict of pandas.DataFrame
        By the number of steps: ID, x, y, z [m], ux, uy, uz [m/s], m [kg], h [m]; x and y from the
        south-west node of the terrain.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.scene.builders import example_slide
    >>> with TemporaryDirectory() as folder:
    ...     found = particles_at(example_slide(folder), [0, 2])
    >>> list(found)
    [0, 2]
    """
    ready = resolve_scene(scene)
    simulation = _core.Simulation(ready.json, ready.base_dir)
    simulation.begin_event()
    found: dict[int, pd.DataFrame] = {}
    done = 0
    for wanted in sorted(set(steps)):
        simulation.step(wanted - done)
        done = wanted
        found[wanted] = _particle_table(simulation)
    return found


def _particle_table(simulation: _core.Simulation) -> pd.DataFrame:
    import pandas as pd

    position, velocity = simulation.positions(), simulation.velocities()
    return pd.DataFrame(
        {
            "ID": simulation.field_by_id("id"),
            **{axis: position[:, k] for k, axis in enumerate("xyz")},
            **{f"u{axis}": velocity[:, k] for k, axis in enumerate("xyz")},
            "m": simulation.masses(),
            "h": simulation.field_by_id("thickness"),
        }
    )


class _Recorder(NotePasser):
    """Passes on how far the run has come."""

    def __init__(
        self,
        simulation: _core.Simulation,
        interrupt: InterruptRequest,
        report: Optional[Reporter],
    ) -> None:
        self.simulation = simulation
        self.interrupt = interrupt
        self.report = report

    def between_events(self) -> None:
        """Do nothing: a slide has one event."""

    def event_begun(self, reseeding: Optional[dict[str, Any]]) -> None:
        """Report the beginning."""
        self._tell(0.0, 0.0, 0.0)

    def progress(self, report: dict[str, Any]) -> None:
        """Pass on how far the slide has come."""
        self._tell(report["time_s"], report["progress"], report["updates_per_s"])

    def event_ended(self, facts: dict[str, Any]) -> None:
        """Report the end."""
        self._tell(facts["sim_time_s"], 1.0, 0.0)

    def before_checkpoint(self) -> None:
        """Do nothing: all that goes on is in the checkpoint."""

    def stop_requested(self) -> bool:
        """Return whether to stop at the next safe point."""
        return self.interrupt.requested

    def _tell(self, time_s: float, fraction: float, updates_per_s: float) -> None:
        if self.report is not None:
            self.report(
                Progress(
                    fraction,
                    int(fraction == 1.0),
                    1,
                    "slides",
                    f"{time_s:.2f} s of the slide",
                    event=1,
                    time=time_s,
                    updates_per_s=updates_per_s,
                )
            )


def _release_outlines(simulation: _core.Simulation) -> list[Outline]:
    return release_outlines(json.loads(simulation.scene))


def _frames(folder: Path, maps: SlideMaps) -> list[Frame]:
    """Return the snow over time, as far as the run has recorded it."""
    try:
        return slide_frames(Film(folder / FILM), maps.raster(maps.terrain))
    except (_core.InputError, OSError):
        return []  # not wanted, lost or damaged; the page does without


def _draw(
    folder: Path,
    simulation: _core.Simulation,
    maps: SlideMaps,
    areas: Sequence[ReleaseArea],
    summary: SlideSummary,
) -> None:
    from snowshed.plot.figure_style import save
    from snowshed.plot.slide_figure import slide_figure
    from snowshed.plot.slide_page import write_slide_page

    save(slide_figure(maps, _release_outlines(simulation)), folder / "slide.png")
    scene = json.loads(simulation.scene)
    frames = _frames(folder, maps)
    write_slide_page(folder / "slide.html", maps, scene, areas, asdict(summary), frames)


def _summary(
    simulation: _core.Simulation,
    facts: dict[str, Any],
    maps: SlideMaps,
    areas: Sequence[ReleaseArea],
) -> SlideSummary:
    slide = simulation.slide_facts()
    corners = np.concatenate(_release_outlines(simulation))
    middle = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    rows, columns = np.nonzero(maps.thickness > 0.0)
    x, y = maps.west + columns * maps.cell, maps.south + rows * maps.cell
    way = np.hypot(x - middle[0], y - middle[1])
    reached = maps.peak_thickness > 0.0
    lies = maps.terrain[rows, columns]
    summary = SlideSummary(
        ended=facts["ended"],
        duration_s=facts["sim_time_s"],
        particles=simulation.particle_count,
        released_kg=slide["released_kg"],
        entrained_kg=slide["entrained_kg"],
        left_terrain_kg=slide["left_terrain_kg"],
        detrained_kg=0.0,
        on_terrain_kg=math.fsum(simulation.masses()),
        bonds_made=slide["bonds_made"],
        bonds_broken=slide["bonds_made"] - slide["bonds"],
        peak_speed_m_s=float(maps.peak_speed.max()),
        peak_thickness_m=float(maps.peak_thickness.max()),
        peak_pressure_kpa=float(maps.peak_pressure.max()),
        reached_m2=float(reached.sum()) * maps.cell**2,
        run_out_m=float(way.max(initial=0.0)),
        drop_m=float(maps.terrain[reached].max() - lies.min()) if lies.size else 0.0,
        notes=_notes(slide["left_terrain_kg"], maps),
    )
    settings = json.loads(simulation.scene)["numerics"]
    left = validity_notes(areas, settings, asdict(summary))
    return replace(summary, notes=(*_of_files(simulation), *summary.notes, *left))


def _write_packed(folder: Path, maps: SlideMaps, summary: SlideSummary) -> None:
    peaks = PeakMaps.cropped(maps.peak_thickness, maps.peak_speed, maps.peak_pressure)
    with replacing(folder / PACKED) as beside:
        beside.write_bytes(peaks.packed())
    write_text(folder / SUMMARY, json.dumps(asdict(summary), indent=2) + "\n")


def _notes(left: float, maps: SlideMaps) -> tuple[str, ...]:
    if left == 0.0:
        return ()
    holes = np.isnan(maps.terrain).any()
    where = "or went where the raster has no elevation" if holes else "at its border"
    return (
        f"{left:,.0f} kg of snow left the terrain {where}; what lies beyond is not part of these "
        "figures",
    )


def _of_files(simulation: _core.Simulation) -> list[str]:
    """Return what was assumed of the scene's files when it was made."""
    return str(json.loads(simulation.scene)["terrain"].get("notes", "")).splitlines()


def _crs(simulation: _core.Simulation) -> str:
    return str(json.loads(simulation.scene)["terrain"].get("crs", ""))


def _write(folder: Path, maps: SlideMaps, summary: SlideSummary, crs: str) -> None:
    for name, values in (
        ("peaks/pft", maps.peak_thickness),
        ("peaks/pfv", maps.peak_speed),
        ("peaks/ppr", maps.peak_pressure),
        ("flow/FT", maps.thickness),
        ("flow/FV", maps.speed),
    ):
        file = folder / f"{name}.asc"
        file.parent.mkdir(exist_ok=True)
        write_raster(file, maps.raster(values, crs))
    write_text(folder / SUMMARY, json.dumps(asdict(summary), indent=2) + "\n")
