"""Messages of a pool's process to the pool that started it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Ready:
    """The process has started and can compute."""


@dataclass(frozen=True)
class Fraction:
    """The fraction of the task's work that is done, 0 to 1."""

    done: float


@dataclass(frozen=True)
class Done:
    """The task's result."""

    result: object


@dataclass(frozen=True)
class Raised:
    """The exception that the task raised."""

    error: Exception


@dataclass(frozen=True)
class Died:
    """The fork that computed the task has ended with a code, negative for a signal's number."""

    code: int
