"""The film of a run: checked against run.json, and as an xarray Dataset."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.extras import require
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.film import Film, FilmFrame
from snowshed.io.json_file import is_number
from snowshed.results.particle_dataset import AXES

if TYPE_CHECKING:
    import xarray


def run_film(path: Path, record: Mapping[str, Any]) -> Film:
    """Return the film in a results folder.

    Parameters
    ----------
    path
        The file.
    record
        Content of run.json, empty if it is missing; older versions recorded no film in it.

    Raises
    ------
    InputError
        If the film is damaged, frames are missing or added, or it is the film of another run.
    """
    film = Film(path)
    finished = record.get("status") == "finished"
    known = record.get("film")
    if isinstance(known, Mapping):
        _check_mark(film, known, finished=finished)
    elif finished:
        _check_end(film, record)
    return film


def _check_mark(film: Film, known: Mapping[str, Any], *, finished: bool) -> None:
    frames = known.get("frames")
    if (
        not isinstance(frames, int)
        or not 0 <= frames <= len(film.frames)
        or film.checksum(frames) != known.get("checksum")
    ):
        raise InputError(f"{film.path}: damaged: not the film that the run recorded")
    if finished and (len(film.frames) > frames or not film.closed):
        raise InputError(f"{film.path}: damaged: it does not end where the run ended")


def _check_end(film: Film, record: Mapping[str, Any]) -> None:
    """Check by the times of the events that no frame is missing at the end."""
    events = record.get("finished_events")
    facts = [event for event in events or [] if isinstance(event, Mapping)]
    times = [float(event["sim_time_s"]) for event in facts if is_number(event.get("sim_time_s"))]
    if not film.whole or not film.frames:
        raise InputError(f"{film.path}: damaged: truncated, although the run is finished")
    if times and not math.isclose(film.frames[-1].time, math.fsum(times), rel_tol=1e-9):
        raise InputError(f"{film.path}: damaged: it does not end where the run ended")


@checked
def film_dataset(film: Film, every: int = 1) -> xarray.Dataset:
    """Return a film as a Dataset.

    Parameters
    ----------
    film
        The film.
    every
        Keep every `every`-th frame.

    Returns
    -------
    xarray.Dataset
        Dimensions ``frame``, with time and event_number, ``particle``, with the ids and the event
        and material of each, and ``component``; NaN where a particle is not in a frame.

    Raises
    ------
    InputError
        If xarray (extra ``study``) is not installed, or the film is damaged or too large for the
        memory.
    """
    library = require("xarray", "study", "a Dataset of a film")
    if not isinstance(every, int) or every < 1:
        raise InputError(f"every: {every!r}; a whole number from 1 is needed")
    for note in film.notes:
        issue_note(f"{film.path}: {note}", InputNote)
    frames = _selected_frames(film, every)
    ids, first = np.unique(np.concatenate([frame.ids for frame in frames]), return_index=True)
    kinds = {
        name: np.concatenate([getattr(frame, name) for frame in frames])[first]
        for name in ("events", "materials")
    }
    shape = (len(frames), len(ids))
    position = np.full((*shape, len(AXES)), np.nan, dtype=np.float32)
    values = [np.full(shape, np.nan, dtype=np.float32) for _ in film.quantities]
    for number, frame in enumerate(frames):
        columns = np.searchsorted(ids, frame.ids)
        position[number, columns] = frame.positions
        for which, quantity in enumerate(film.quantities):
            values[which][number, columns] = quantity.values(frame.codes[:, which])
    dimensions = ("frame", "particle")
    dataset: xarray.Dataset = library.Dataset(
        {
            "position": ((*dimensions, "component"), position, _facts("position")),
            **{
                quantity.name: (
                    dimensions,
                    array,
                    {"units": quantity.unit, "long_name": quantity.meaning},
                )
                for quantity, array in zip(film.quantities, values)
            },
        },
        coords={
            "particle": ("particle", ids, {"long_name": _facts("id")["long_name"]}),
            "component": list(AXES),
            "event": ("particle", kinds["events"], {"long_name": _facts("event")["long_name"]}),
            "material_id": ("particle", kinds["materials"]),
            "time": (
                "frame",
                [frame.time for frame in frames],
                {"units": "s", "long_name": "Time, through all events"},
            ),
            "event_number": ("frame", [frame.event for frame in frames]),
        },
        attrs={"share_of_particles": film.share, "quantum_m": film.quantum},
    )
    return dataset


def _facts(name: str) -> dict[str, str]:
    unit, meaning = {known: (unit, text) for known, unit, text in _core.quantities()}[name]
    return {"units": unit, "long_name": meaning}


def _selected_frames(film: Film, every: int) -> list[FilmFrame]:
    if not film.frames:
        raise InputError(f"{film.path}: has no frame yet")
    facts = film.frames[::every]
    # Bytes per particle of a decoded frame, and of its row in the Dataset.
    each = 8 * (2 * len(AXES) + 4 + len(film.quantities))
    needed = each * (sum(frame.particles for frame in facts) + len(facts) * facts[-1].particles)
    available = _core.available_memory_bytes()
    if needed > available:
        raise InputError(
            f"{film.path}: {len(facts)} frames need {needed / 1e9:.1f} GB of memory, but "
            f"{available / 1e9:.1f} GB are available; take fewer with every=2 or more"
        )
    return [frame for number, frame in enumerate(film) if number % every == 0]
