"""What a process of a pool says to who made it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Ready:
    """The process has started and can compute."""


@dataclass(frozen=True)
class Fraction:
    """How much of the task's work is done, 0 to 1."""

    done: float


@dataclass(frozen=True)
class Done:
    """What the task gave."""

    result: object


@dataclass(frozen=True)
class Raised:
    """What the task raised."""

    error: Exception
