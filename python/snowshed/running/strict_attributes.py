"""Objects whose attributes cannot be set: a misspelt name is an error."""

from __future__ import annotations

from typing import TYPE_CHECKING

from snowshed.base.messages import suggestion
from snowshed.base.record import UnknownFieldError


class StrictAttributes:
    """An object without public attributes that can be set; subclasses of users add their own.

    Examples
    --------
    >>> class Clock(StrictAttributes):
    ...     time = 0.0
    >>> Clock().tiem = 3
    Traceback (most recent call last):
    snowshed.base.record.UnknownFieldError: Clock.tiem: Clock has no such attribute; did you mean \
time?
    """

    if not TYPE_CHECKING:  # otherwise type checkers would accept any attribute

        def __setattr__(self, name: str, value: object) -> None:
            kind = type(self)
            if name.startswith("_") or not kind.__module__.startswith(f"{_PACKAGE}."):
                super().__setattr__(name, value)
            elif hasattr(kind, name):
                raise UnknownFieldError(f"{kind.__name__}.{name}: it is read, and cannot be set")
            else:
                names = [each for each in dir(kind) if not each.startswith("_")]
                near = suggestion(name, names)
                raise UnknownFieldError(
                    f"{kind.__name__}.{name}: {kind.__name__} has no such attribute{near}"
                )


_PACKAGE = __name__.partition(".")[0]
