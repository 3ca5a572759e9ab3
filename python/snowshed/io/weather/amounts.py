"""Amounts per interval from the totals and counters in weather files.

Totals may overlap (1, 3, 6 and 24 hours), a counter may only rise, and every row may hold the sum
of the last day. The resulting amounts do not overlap, so that they can be summed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import datetime, timedelta
from statistics import median
from typing import NamedTuple

from snowshed.io.weather.observation import DAY

HOUR = timedelta(hours=1)
EPOCH = datetime(1, 1, 1)
#: A total contradicts the shorter totals that cover at least half of its time, and is a sensor
#: error, if it exceeds their sum by more than this multiple of the sum...
SENSOR_FACTOR = 20.0
#: ... and by more than this, mm.
SENSOR_EXCESS_MM = 50.0
MAX_STEPS = 400  # of a total: a year of days, half a month of hours


class Total(NamedTuple):
    """An amount over some hours before a time."""

    end: datetime
    hours: float
    amount: float


def without_overlap(
    totals: Sequence[Total], step: float, what: str
) -> tuple[list[float], list[str]]:
    """Return the excess of each total over the shorter totals that it contains, and notes.

    Parameters
    ----------
    totals
        Totals in any order.
    step
        Hours of the shortest total.
    what
        Unit and quantity of the amounts, for the notes.

    Examples
    --------
    >>> noon = datetime(2024, 1, 1, 12)
    >>> hour, longer = Total(noon - timedelta(hours=2), 1.0, 4.0), Total(noon, 6.0, 10.0)
    >>> without_overlap([hour, longer], 1.0, "mm of precipitation")[0]
    [4.0, 6.0]
    """
    amount_by_slot: dict[int, float] = {}
    amounts = [0.0] * len(totals)
    contained, contradicting = 0, []
    for i in sorted(range(len(totals)), key=lambda i: totals[i].hours):
        total = totals[i]
        last = math.ceil((total.end - EPOCH) / HOUR / step - 1e-6)
        span = range(last - min(max(round(total.hours / step), 1), MAX_STEPS) + 1, last + 1)
        inside = [amount_by_slot[slot] for slot in span if slot in amount_by_slot]
        remainder = max(total.amount - math.fsum(inside), 0.0)
        max_remainder = max(SENSOR_EXCESS_MM, SENSOR_FACTOR * math.fsum(inside))
        if 2 * len(inside) >= len(span) and remainder > max_remainder:
            contradicting.append(remainder)
            continue
        contained += bool(inside) and total.amount > 0.0
        open_slots = [slot for slot in span if slot not in amount_by_slot] or list(span)
        for slot in open_slots:
            amount_by_slot[slot] = amount_by_slot.get(slot, 0.0) + remainder / len(open_slots)
        amounts[i] = round(remainder, 6)
    notes = []
    if contained:
        notes.append(
            f"{contained} totals overlap shorter ones; counted once, {math.fsum(amounts):g} of "
            f"{math.fsum(total.amount for total in totals):g} {what} remain"
        )
    if contradicting:
        notes.append(
            f"{len(contradicting)} totals contradict the totals within them, and are left out with "
            f"{math.fsum(contradicting):g} {what}"
        )
    return amounts, notes


def usual_step(times: Sequence[datetime]) -> float:
    """Return the usual hours from row to row; 1 if there are not two rows.

    Examples
    --------
    >>> usual_step([datetime(2024, 1, 1, hour) for hour in (0, 3, 6, 7)])
    3.0
    """
    steps = [(later - earlier) / HOUR for earlier, later in zip(times, times[1:])]
    rising = [step for step in steps if step > 0.0]
    return median(rising) if rising else 1.0


def hours_before(times: Sequence[datetime]) -> list[float]:
    """Return the hours since the previous row, or the usual hours after a gap of more than a day.

    Examples
    --------
    >>> hours_before([datetime(2024, 1, 1, hour) for hour in (0, 1, 2, 5)])
    [1.0, 1.0, 1.0, 3.0]
    """
    usual = usual_step(times)
    steps = [(later - earlier) / HOUR for earlier, later in zip(times, times[1:])]
    return [usual, *(step if 0.0 < step <= max(DAY, usual) else usual for step in steps)]
