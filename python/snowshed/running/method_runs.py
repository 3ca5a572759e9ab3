"""How the scenes of each method are run into a results folder, and what is measured of them.

Whoever runs scenes of any method, such as a study, asks `runs_of` and knows no method by name.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from types import MappingProxyType
from typing import Optional, Protocol, Union

from snowshed._core import InputError
from snowshed.base.json_values import JsonValue
from snowshed.base.progress import Reporter
from snowshed.io.json_file import read_object
from snowshed.io.run_files import check_run_file
from snowshed.methods.grains.summary import GrainsSummary
from snowshed.methods.registry import DEFAULT, NAME_KEY
from snowshed.methods.slide.summary import SlideSummary
from snowshed.results.event_particles import read_event_particles
from snowshed.results.folder import EVENT_COLUMNS, WORDS, RunFolder
from snowshed.running.ageing import Ageing
from snowshed.running.events import run_events
from snowshed.running.grains import CURVE, run_grains
from snowshed.running.slides import PACKED, run_slide
from snowshed.scene.scene import ResolvedScene

Cell = Union[int, float, str, None]
COUNTS = (
    "steps", "bonds_made", "bonds_broken", "final_particles", "spheres", "bonds",
    "broken_in_tension", "broken_in_shear",
)  # fmt: skip
#: Columns that say which event a row is of, and how long its computing took.
ROW_KEYS = ("event", "wall_s")


def _require_no_ageing(ageing: Optional[Ageing]) -> None:
    if ageing is not None:
        raise InputError("ageing: only a stack ages, and this method makes none")


class MethodRuns(Protocol):
    """Runs scenes of a method."""

    @property
    def columns(self) -> Sequence[str]:
        """Names of what is measured after an event, in the order of a table."""

    def run(
        self,
        scene: ResolvedScene,
        folder: Path,
        *,
        resume: bool,
        ageing: Optional[Ageing],
        progress: Optional[Reporter],
    ) -> None:
        """Run a scene into a folder, without pictures, or go on with it.

        Raises InputError if there is ageing, and the method makes no stack that could age.
        """

    def rows(self, folder: Path) -> list[dict[str, Cell]]:
        """Return a row for each event that is done: ``event``, ``wall_s`` and `columns`."""

    def kept(self, folder: Path) -> Iterable[tuple[int, bytes]]:
        """Yield each event with what it left, packed, so that it can be evaluated anew."""


class _StackRuns:
    """Events whose snow makes a stack."""

    columns: Sequence[str] = tuple(name for name in EVENT_COLUMNS if name not in ROW_KEYS)

    def run(
        self,
        scene: ResolvedScene,
        folder: Path,
        *,
        resume: bool,
        ageing: Optional[Ageing],
        progress: Optional[Reporter],
    ) -> None:
        run_events(scene, folder, resume=resume, ageing=ageing, progress=progress, pictures=False)

    def rows(self, folder: Path) -> list[dict[str, Cell]]:
        table = RunFolder(folder).events.rows
        return [{name: _value(name, cell) for name, cell in row.items()} for row in table]

    def kept(self, folder: Path) -> Iterable[tuple[int, bytes]]:
        return ((event, found.packed()) for event, found in read_event_particles(folder))


#: What a table calls differently from a summary: what other methods measure too, or mean by it.
_RENAMED = {
    "duration_s": "sim_time_s", "particles": "final_particles", "grains": "final_particles"
}  # fmt: skip


def _figures(summary: type) -> Mapping[str, str]:
    """Return the figures of a summary that are single values, with their columns."""
    return {
        field.name: _RENAMED.get(field.name, field.name)
        for field in fields(summary)
        if field.type in ("int", "float", "str", "Optional[float]")
    }


def _row_of(folder: Path, file: str, figures: Mapping[str, str]) -> list[dict[str, Cell]]:
    """Return the row of a run with one event, whose figures stand in a JSON file."""
    if not (folder / file).is_file():
        return []
    check_run_file(folder / file)
    found = read_object(folder / file)
    (event,) = RunFolder(folder).read_run()["finished_events"]
    row = {column: found.get(name) for name, column in figures.items()}
    return [{"event": 1, "wall_s": event["wall_s"], "steps": event["steps"], **row}]


_SLIDE_FIGURES, _LOADING_FIGURES = _figures(SlideSummary), _figures(GrainsSummary)


class _SlideRuns:
    """Slides, which leave maps."""

    columns: Sequence[str] = ("steps", *_SLIDE_FIGURES.values())

    def run(
        self,
        scene: ResolvedScene,
        folder: Path,
        *,
        resume: bool,
        ageing: Optional[Ageing],
        progress: Optional[Reporter],
    ) -> None:
        _require_no_ageing(ageing)
        options = {"pictures": False, "rasters": False}
        run_slide(scene, folder, resume=resume, progress=progress, **options)

    def rows(self, folder: Path) -> list[dict[str, Cell]]:
        return _row_of(folder, "slide.json", _SLIDE_FIGURES)

    def kept(self, folder: Path) -> Iterable[tuple[int, bytes]]:
        if (folder / "slide.json").is_file():
            yield 1, (folder / PACKED).read_bytes()


class _GrainsRuns:
    """Loading tests, which leave curves."""

    columns: Sequence[str] = ("steps", *_LOADING_FIGURES.values())

    def run(
        self,
        scene: ResolvedScene,
        folder: Path,
        *,
        resume: bool,
        ageing: Optional[Ageing],
        progress: Optional[Reporter],
    ) -> None:
        _require_no_ageing(ageing)
        run_grains(scene, folder, resume=resume, progress=progress, pictures=False)

    def rows(self, folder: Path) -> list[dict[str, Cell]]:
        return _row_of(folder, "grains.json", _LOADING_FIGURES)

    def kept(self, folder: Path) -> Iterable[tuple[int, bytes]]:
        if (folder / "grains.json").is_file():
            yield 1, (folder / CURVE).read_bytes()


_RUNS: Mapping[str, MethodRuns] = MappingProxyType(
    {"mpm": _StackRuns(), "slide": _SlideRuns(), "grains": _GrainsRuns(), "mps": _StackRuns()}
)


def runs_of(scene: Union[str, Mapping[str, JsonValue]]) -> MethodRuns:
    """Return how a complete scene is run, by its method.

    Parameters
    ----------
    scene
        JSON data or text.

    Examples
    --------
    >>> "run_out_m" in runs_of({"method": "slide"}).columns
    True
    """
    data = json.loads(scene) if isinstance(scene, str) else scene
    return _RUNS[str(data.get(NAME_KEY) or DEFAULT)]


def column_types() -> dict[str, str]:
    """Return what any method measures after an event, with its type in a database.

    Examples
    --------
    >>> column_types()["ended"], column_types()["height_m"]
    ('TEXT', 'REAL')
    """
    names = dict.fromkeys(name for runs in _RUNS.values() for name in runs.columns)
    return {name: _type(name) for name in names}


def _type(name: str) -> str:
    return "INTEGER" if name in COUNTS else "TEXT" if name in WORDS else "REAL"


def _value(name: str, cell: str) -> Cell:
    """Return the value of a cell of events.csv, exactly."""
    if name in WORDS:
        return cell
    if name == "event" or name in COUNTS:
        return int(cell)
    return float(cell) if cell else None
