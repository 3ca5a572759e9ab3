"""Functions that a simulation calls while it runs: they may change the snow, but take no steps."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar, cast

from snowshed._core import InputError

Method = TypeVar("Method", bound=Callable[..., Any])
Answer = TypeVar("Answer")


class CallsFunctions:
    """The part of a simulation that calls functions with itself."""

    _is_calling = False

    def _call(self, function: Callable[[Any], Answer]) -> Answer:
        """Call a function with this simulation, which takes no steps meanwhile."""
        self._is_calling = True
        try:
            return function(self)
        finally:
            self._is_calling = False


def refused_within_calls(method: Method) -> Method:
    """Decorate a method of `CallsFunctions`: functions that the simulation calls cannot use it.

    Examples
    --------
    >>> class Clock(CallsFunctions):
    ...     @refused_within_calls
    ...     def step(self) -> None: ...
    >>> Clock()._call(lambda clock: clock.step())
    Traceback (most recent call last):
    snowshed._core.InputError: step: called from a function that `run` calls (until, on_step), \
which may change the snow, but takes no steps
    """

    @functools.wraps(method)
    def guarded(simulation: CallsFunctions, *values: object, **options: object) -> object:
        if simulation._is_calling:
            raise InputError(
                f"{method.__name__}: called from a function that `run` calls (until, on_step), "
                "which may change the snow, but takes no steps"
            )
        return method(simulation, *values, **options)

    return cast(Method, guarded)
