"""Checks of what callers ask of a simulation in memory: added snow, speeds, times to run to."""

from __future__ import annotations

import numpy as np

from snowshed._core import InputError
from snowshed.base.arguments import is_flag
from snowshed.base.arrays import Floats
from snowshed.base.field_type import shown
from snowshed.base.notes import issue_note

MAX_SPEED = 1e4  # m/s, as in scenes
UNUSUAL_SPEED = 100.0  # m/s, as in scenes
MAX_REACH = 100.0  # sizes of the present snow; snow added farther away is noted
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


def check_speeds(name: str, velocities: Floats) -> None:
    """Refuse speeds beyond the largest of scenes, and note unusual ones.

    Examples
    --------
    >>> check_speeds("velocity", np.array([[0.0, 0.0, -2e4]]))
    Traceback (most recent call last):
    snowshed._core.InputError: velocity: faster than 10000 m/s
    """
    fastest = np.abs(velocities).max(initial=0.0)
    if fastest > MAX_SPEED:
        raise InputError(f"{name}: faster than {MAX_SPEED:g} m/s")
    if fastest > UNUSUAL_SPEED:
        issue_note(f"{name}: {fastest:g} m/s is unusual; is it in another unit?")


def note_on_distance(positions: Floats, present: Floats) -> None:
    """Issue a note if snow is added far from the present snow; positions in m."""
    if not len(present) or not len(positions):
        return
    low, high = present.min(axis=0), present.max(axis=0)
    away = np.maximum(np.maximum(low - positions, positions - high), 0.0).max()
    size = (high - low).max()
    if away > MAX_REACH * size:
        issue_note(
            f"positions: up to {away:.3g} m from the present snow, which is {size:.2g} m large; "
            "are they in another unit?"
        )


def is_reached(answer: object) -> bool:
    """Return what a condition of a run has answered.

    Examples
    --------
    >>> is_reached(None)
    Traceback (most recent call last):
    snowshed._core.InputError: until: the function returned None; needed: True or False
    """
    if not is_flag(answer):
        plain = isinstance(answer, (str, int, float, type(None)))
        given = shown(answer) if plain else f"a value of type {type(answer).__name__}"
        raise InputError(f"until: the function returned {given}; needed: True or False")
    return bool(answer)


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
