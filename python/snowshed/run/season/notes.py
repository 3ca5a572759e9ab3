"""Notes on the limits of a season's results."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Optional

from snowshed.run.season.accumulation import Day
from snowshed.run.season.settings import SeasonSettings

if TYPE_CHECKING:
    import pandas as pd

#: Part of a slab that may stay on the panel; if more stays, the core lays the next slab on top.
STAYING = 0.02


def first_staying(events: pd.DataFrame) -> Optional[int]:
    """Return the first event that leaves more than `STAYING` of its snow on the panel."""
    total = events["mass_kg"] + events["on_panel_kg"]
    brought = total.diff().fillna(total)
    stayed = events["event"][events["on_panel_kg"] > STAYING * brought]
    return int(stayed.iloc[0]) if len(stayed) else None


def notes(
    dx: float,
    days: Sequence[Day],
    settings: SeasonSettings,
    events: pd.DataFrame,
    staying: Optional[int],
) -> list[str]:
    """Return notes on the limits of the results, a sentence each.

    Parameters
    ----------
    dx
        Resolution of the scene, m.
    days
        From `accumulate`.
    settings
        The settings of the season.
    events
        The table of the slide-offs, as in events.csv.
    staying
        From `first_staying`.
    """
    return [
        *_of_slabs(dx, days, settings),
        *_of_ageing(settings),
        *_of_slide_offs(events, staying),
    ]


def _of_slabs(dx: float, days: Sequence[Day], settings: SeasonSettings) -> Iterator[str]:
    released = [day for day in days if day.event is not None]
    estimated = sum(day.density is not None and day.weather.density is None for day in days)
    if estimated:
        yield f"{estimated} densities are estimates ({settings.density})"
    if released:
        thinnest = min(day.thickness for day in released)
        if thinnest < 2.0 * dx:
            yield (
                f"the thinnest slab has {1000 * thinnest:.1f} mm, less than two cells of "
                f"{1000 * dx:g} mm: its stack is coarse"
            )
    else:
        yield "no snow let go: friction and adhesion held all of it"


def _of_ageing(settings: SeasonSettings) -> Iterator[str]:
    if settings.settling:
        yield (
            f"the stack settles between events ({settings.settling}), for which a factor of 4 and "
            "more is published; settled heights are estimates for the time until the next"
        )
    if settings.sintering:
        yield (
            f"broken bonds regain strength ({settings.sintering}), all of it in "
            f"{settings.strength_age:g} hours"
        )


def _of_slide_offs(events: pd.DataFrame, staying: Optional[int]) -> Iterator[str]:
    if staying is not None:
        yield (
            f"from event {staying} on, snow that should have left stayed on the panel; later slabs "
            "are laid on top of it"
        )
    unfinished = int((events["ended"] == "time_limit").sum())
    if unfinished:
        yield (
            f"{unfinished} of {len(events)} slide-offs ended before the snow rested; "
            "allow a longer --max-time"
        )
