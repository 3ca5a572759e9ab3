"""The end of an event of a simulation in memory."""

from __future__ import annotations

from typing import Literal, NamedTuple

Ended = Literal["rest", "time_limit", "reached"]


class EventEnd(NamedTuple):
    """The end of an event.

    Attributes
    ----------
    event
        Number of the event, from 1.
    ended
        "rest" or "time_limit".
    time
        Duration of the event, s.
    """

    event: int
    ended: Ended
    time: float
