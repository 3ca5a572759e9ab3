"""The film of a run, which must be the one that its run.json knows."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from snowshed._core import InputError
from snowshed.io.film import Film
from snowshed.io.json_file import is_number


def run_film(path: Path, record: Mapping[str, Any]) -> Film:
    """Return the film in a results folder.

    Parameters
    ----------
    path
        The file.
    record
        What run.json says, if it is there; that of the version before does not know the film.

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
    times = [float(one["sim_time_s"]) for one in facts if is_number(one.get("sim_time_s"))]
    if not film.whole or not film.frames:
        raise InputError(f"{film.path}: damaged: cut off, though the run is finished")
    if times and not math.isclose(film.frames[-1].time, math.fsum(times), rel_tol=1e-9):
        raise InputError(f"{film.path}: damaged: it does not end where the run ended")
