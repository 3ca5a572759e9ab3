"""Checks of what callers ask of a simulation in memory: added snow, and times to run to."""

from __future__ import annotations

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.notes import issue_note

MAX_SPEED = 1e4  # m/s, as in scenes
MASS_RATIO = 10.0  # masses that differ more from those of seeded particles are noted


def refuse_coincident(positions: Floats) -> None:
    """Raise InputError if two positions coincide in single precision.

    Examples
    --------
    >>> refuse_coincident(np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [0.0, 0.0, 1.0]]))
    Traceback (most recent call last):
    snowshed._core.InputError: positions: indices 0 and 2 are the same place, and 1 of 3 positions \
repeats another
    """
    _, first, place = np.unique(
        positions.astype(np.float32), axis=0, return_index=True, return_inverse=True
    )
    original = first[place.ravel()]
    repeated = np.flatnonzero(original != np.arange(len(positions)))
    if len(repeated):
        at, verb = int(repeated[0]), "repeats" if len(repeated) == 1 else "repeat"
        raise InputError(
            f"positions: indices {original[at]} and {at} are the same place, and {len(repeated)} "
            f"of {len(positions)} positions {verb} another"
        )


def refuse_fast(name: str, velocities: Floats) -> None:
    """Raise InputError if a component of a velocity exceeds the largest speed of scenes."""
    if np.abs(velocities).max(initial=0.0) > MAX_SPEED:
        raise InputError(f"{name}: faster than {MAX_SPEED:g} m/s")


def note_on_mass(mass: float, seeded: float) -> None:
    """Issue a note if particles are much heavier or lighter than seeded ones, kg."""
    if not seeded / MASS_RATIO <= mass <= seeded * MASS_RATIO:
        issue_note(
            f"mass: {mass:.3g} kg for each particle is {mass / seeded:.3g} times that of "
            "seeded snow; is it that of all particles?"
        )


def note_on_time(until: float, event: int, time: float, limit: float) -> None:
    """Issue a note if an event is to run to a time that has passed, or beyond its limit, s."""
    if until <= time:
        issue_note(
            f"until: {until:g} s has passed, because event {event} is at {time:.4g} s; no step was "
            "taken"
        )
    elif until > limit:
        issue_note(
            f"until: {until:g} s is beyond the time limit of an event, events.max_time = "
            f"{limit:g} s; the event runs on, and ends with run() only"
        )
