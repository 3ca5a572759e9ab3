"""Runs of a snow slide: the results folder with its maps and its figures.

Besides the files of every run (``snowshed.results.folder``), the folder holds

================== ==========================================================================
peaks/             largest values over time: thickness (pft, m), speed (pfv, m/s) and pressure
                   (ppr, kPa), as ESRI ASCII grids, whose coordinate system is in a .prj if it is
                   known, or as GeoTIFF
flow/              thickness (FT) and speed (FV) at the end
ground/            if the ground adapts to the snow: its rise (sfcChange) and its elevations with
                   it (demAdapted), m
peaks.npz          the largest values, in place of the grids of a compact run
slide.json         the figures of `SlideSummary`
slide.png          the map: terrain, peak speed, outline of the release
slide.html         the page: maps, the slide over time, release, mass and settings
energy.csv         energy balance at the end (only with output.energy)
energy_history.csv the same over time, with energy.png, a picture of it
================== ==========================================================================
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

import snowshed._core as _core
from snowshed.base.notes import ResultNote
from snowshed.io.atomic import replacing
from snowshed.io.film import FILM, Film
from snowshed.methods.slide.event_notes import event_notes
from snowshed.methods.slide.frames import Frame, slide_frames
from snowshed.methods.slide.maps import (
    PEAKS_FILE,
    PeakMaps,
    SlideMaps,
    slide_maps,
    write_maps_of_run,
)
from snowshed.methods.slide.summary import SlideSummary
from snowshed.methods.slide.validity import (
    ReleaseArea,
    release_areas,
    thickness_map,
    validity_notes,
)
from snowshed.running.method_run import Cell, MethodRun, summary_rows
from snowshed.running.sequence import record_note, seal_files
from snowshed.scene.terrain_grid import release_outlines


class SlideRun(MethodRun):
    """Writes the maps of a slide and its summary."""

    UNIT: ClassVar[str] = "slides"
    COLUMNS: ClassVar[Mapping[str, type]] = {"steps": int, **SlideSummary.columns()}

    def status_line(self, time_s: float) -> str:
        """Return the progress of the slide."""
        return f"{time_s:.2f} s of the slide"

    def finish(self) -> None:
        """Write maps, summary and energies."""
        (facts,) = self.sequence.finished_events
        terrain = self.scene.data["terrain"]
        self.maps = slide_maps(self.simulation)
        depth = thickness_map(terrain, Path(self.scene.base_dir))
        ground = self.maps.raster(self.maps.terrain)
        self.areas = release_areas(ground, terrain["release"], depth)
        self.summary = _summary(self.simulation, self.scene.data, facts, self.maps, self.areas)
        if self.options.compact:
            _write_packed(self.folder, self.maps)
        else:
            crs = str(terrain.get("crs", ""))
            write_maps_of_run(self.folder, self.maps, crs, self.options.map_format)
        self.summary.write(self.folder)
        for note in self.summary.notes:
            record_note(self.sequence, note, ResultNote)
        self.write_energies(facts)
        seal_files(self.sequence, self.folder, SlideSummary.FILE)
        self.sequence.rewrite_record()

    def draw(self) -> None:
        """Draw ``slide.png`` and the energies, and write ``slide.html``."""
        from snowshed.plot.figure_style import save_figure
        from snowshed.plot.slide_figure import slide_figure
        from snowshed.plot.slide_objects import slope_objects
        from snowshed.plot.slide_page import write_slide_page

        self.draw_energies()
        scene, page = self.scene.data, self.folder / "slide.html"
        facts = self.simulation.slide_facts()
        objects = slope_objects(scene["terrain"], facts["late_releases"])
        figure = slide_figure(self.maps, release_outlines(scene), objects=objects)
        save_figure(figure, self.folder / "slide.png")
        frames = _frames(self.folder, self.maps)
        figures = asdict(self.summary)
        write_slide_page(page, self.maps, scene, self.areas, figures, frames, objects, facts)

    @classmethod
    def rows(cls, folder: Path) -> list[dict[str, Cell]]:
        """Return the figures of ``slide.json``."""
        return summary_rows(folder, SlideSummary)

    @classmethod
    def stored_data(cls, folder: Path) -> Iterable[tuple[int, bytes]]:
        """Yield the peak maps."""
        if (folder / SlideSummary.FILE).is_file():
            yield 1, (folder / PEAKS_FILE).read_bytes()


def _frames(folder: Path, maps: SlideMaps) -> list[Frame]:
    """Return the snow over time, up to the last frame of the film."""
    try:
        return slide_frames(Film(folder / FILM), maps.raster(maps.terrain))
    except (_core.InputError, OSError):
        return []  # the film is not wanted, lost or damaged: the page has no moving picture


def _summary(
    simulation: _core.Simulation,
    scene: Mapping[str, Any],
    facts: Mapping[str, Any],
    maps: SlideMaps,
    areas: Sequence[ReleaseArea],
) -> SlideSummary:
    slide = simulation.slide_facts()
    corners = np.concatenate(release_outlines(scene))
    middle = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    rows, columns = np.nonzero(maps.holds_snow)
    x, y = maps.west + columns * maps.cell, maps.south + rows * maps.cell
    distance = np.hypot(x - middle[0], y - middle[1])
    reached = maps.peak_thickness > 0.0
    elevations = maps.terrain[rows, columns]
    summary = SlideSummary(
        ended=facts["ended"],
        sim_time_s=facts["sim_time_s"],
        final_particles=simulation.particle_count,
        released_kg=slide["released_kg"],
        entrained_kg=slide["entrained_kg"],
        left_terrain_kg=slide["left_terrain_kg"],
        on_terrain_kg=math.fsum(simulation.masses()),
        bonds_made=slide["bonds_made"],
        bonds_broken=slide["bonds_made"] - slide["bonds"] - slide["bonds_in_ground"],
        peak_speed_m_s=float(maps.peak_speed.max()),
        peak_thickness_m=float(maps.peak_thickness.max()),
        peak_pressure_kpa=float(maps.peak_pressure.max()),
        reached_m2=float(reached.sum()) * maps.cell**2,
        run_out_m=float(distance.max(initial=0.0)),
        secondary_kg=slide["secondary_kg"],
        inflow_kg=slide["inflow_kg"],
        detrained_kg=slide["detrained_kg"],
        stopped_kg=slide.get("stopped_kg", 0.0),
        ground_gained_m3=slide.get("ground_gained_m3", 0.0),
        drop_m=float(maps.terrain[reached].max() - elevations.min()) if elevations.size else 0.0,
    )
    of_files = str(scene["terrain"].get("notes", "")).splitlines()
    of_border = _border_notes(slide["left_terrain_kg"], maps)
    of_events = event_notes(slide)
    validity = validity_notes(areas, scene["numerics"], asdict(summary))
    of_steps = _step_notes(facts, scene["numerics"]["time_step"])
    return replace(summary, notes=(*of_files, *of_events, *of_border, *validity, *of_steps))


def _step_notes(facts: Mapping[str, Any], time_step: float) -> tuple[str, ...]:
    time, steps = facts["sim_time_s"], facts["steps"]
    if steps <= math.ceil(time / time_step - 1e-6):
        return ()
    return (
        f"Steps of {time_step:g} s were divided, to {time / steps:.2g} s on average, because bonds "
        "or the mixing of velocities need shorter ones.",
    )


def _border_notes(left: float, maps: SlideMaps) -> tuple[str, ...]:
    if left == 0.0:
        return ()
    holes = np.isnan(maps.terrain).any()
    where = "or went where the raster has no elevation" if holes else "at its border"
    return (f"{left:,.0f} kg of snow left the terrain {where}; these figures do not include it",)


def _write_packed(folder: Path, maps: SlideMaps) -> None:
    peaks = PeakMaps.cropped(maps.peak_thickness, maps.peak_speed, maps.peak_pressure)
    with replacing(folder / PEAKS_FILE) as beside:
        beside.write_bytes(peaks.packed())
