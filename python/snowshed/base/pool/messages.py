"""Messages of a pool's process to the pool that started it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ProcessReady:
    """The process has started and can compute."""


@dataclass(frozen=True)
class Fraction:
    """The fraction of the task's work that is done, 0 to 1."""

    done: float


@dataclass(frozen=True)
class TaskResult:
    """The task's result."""

    result: object


@dataclass(frozen=True)
class TaskError:
    """The exception that the task raised."""

    error: Exception


@dataclass(frozen=True)
class ForkDeath:
    """The fork that computed the task has died; `code` is negative for a signal."""

    code: int
