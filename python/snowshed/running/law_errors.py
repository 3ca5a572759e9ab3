"""Errors that laws of one's own raise: Python only prints them, because C calls the functions."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Optional

from snowshed._core import SimulationError
from snowshed.running.laws import Laws


@contextmanager
def law_errors(laws: Optional[Laws]) -> Iterator[Callable[[], None]]:
    """Collect the errors of a simulation's laws during a block, and raise the first at its end.

    Yields
    ------
    callable
        Raises the first error so far, if there is one.

    Raises
    ------
    SimulationError
        If a law has raised an error, also where the simulation ended with one of its own.
    """
    if laws is None:
        yield _nothing
        return
    errors: list[BaseException] = []
    name, others = laws.name, sys.unraisablehook

    def collect(unraisable: Any) -> None:
        if _is_of_callback(unraisable) and unraisable.exc_value is not None:
            errors.append(unraisable.exc_value)
        else:
            others(unraisable)

    def check() -> None:
        if errors:
            raise SimulationError(
                f"laws of the user: {name}: a function raised {type(errors[0]).__name__}: "
                f"{errors[0]}"
            ) from errors[0]

    sys.unraisablehook = collect
    try:
        yield check
    except SimulationError:
        check()
        raise
    finally:
        sys.unraisablehook = others
    check()


def _nothing() -> None:
    """Do nothing: without laws there are no errors of theirs."""


def _is_of_callback(unraisable: Any) -> bool:
    """Return whether an error was raised in a function that C calls, of ctypes or of numba."""
    if "ctypes" in (unraisable.err_msg or ""):
        return True
    return isinstance(unraisable.object, str)  # the name of a function of numba
