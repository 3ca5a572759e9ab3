"""Notes on the limits of a season's results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional

from snowshed.base.callers import argument
from snowshed.base.formatting import percent
from snowshed.season.accumulation import WinterDay
from snowshed.season.cover import end_of_readings
from snowshed.season.settings import SeasonSettings
from snowshed.season.slabs import cover_below_slides
from snowshed.season.weather.row import Weather

if TYPE_CHECKING:
    import pandas as pd

#: Share of a slab that may stay on the panel; if more stays, the core lays the next slab on top.
MAX_STAYING_SHARE = 0.02


def first_staying(events: pd.DataFrame) -> Optional[int]:
    """Return the first event that leaves more than `MAX_STAYING_SHARE` of its snow on the panel."""
    total = events["mass_kg"] + events["on_panel_kg"]
    brought = total.diff().fillna(total)
    stayed = events["event"][events["on_panel_kg"] > MAX_STAYING_SHARE * brought]
    return int(stayed.iloc[0]) if len(stayed) else None


def assumptions(
    table: pd.DataFrame, days: Sequence[WinterDay], settings: SeasonSettings
) -> Iterator[str]:
    """Yield the assumptions of a season on ground, settling and strength of the snow.

    Parameters
    ----------
    table
        As in season.csv.
    days, settings
        Days and settings of the season.
    """
    deepest = table["cover_m"].max()
    if settings.cover == "none" or not deepest:
        yield "the ground is bare: the stack lies on no natural snow cover"
    elif not isinstance(settings.cover, str):
        yield f"the stack lies on a natural snow cover of {settings.cover:g} m all season, as given"
    else:
        measured = any(day.weather.snow_depth is not None for day in days)
        source = "measured" if measured else "from the same snowfalls, settled and melted"
        date = table["date"].iloc[int(table["cover_m"].argmax())][:10]
        yield (
            f"the stack lies on a natural snow cover ({source}), at most {deepest:.2f} m deep on "
            f"{date}"
        )
        last = end_of_readings([day.weather for day in days])
        if last is not None:
            yield (
                f"the readings of the snow depth end on {last.date.date()} at "
                f"{last.snow_depth:.2f} m; from then on, the cover settles and melts by the "
                "temperature, and grows by the snowfalls"
            )
    yield from _melt_assumptions(days, settings)
    if settings.rows.count > 1 and any(day.load for day in days):
        yield (
            f"{settings.rows.count} rows of panels, {settings.rows.pitch:g} m apart, catch and "
            "shed the same snow at the same time; clearances are those of the row with the least, "
            "and snow that stays on the panel is that of the first row"
        )
    if settings.settling is None:
        yield "no snow settles"
    if settings.strength is None:
        yield "slabs of all densities have the strength of the scene's snow"
    else:
        yield f"the strength of a slab follows from its density ({settings.strength})"
    if settings.pool_below:
        slides = sum(day.event is not None for day in days)
        yield (
            f"{sum(day.released for day in days)} releases are pooled into {slides} slide-offs, "
            f"whose slabs are at least {1000 * settings.pool_below:g} mm thick (the last may be "
            "thinner)"
        )


def _melt_assumptions(days: Sequence[WinterDay], settings: SeasonSettings) -> Iterator[str]:
    if settings.melt_factor:
        yield (
            f"snow on panel and ground and in the stack melts by {settings.melt_factor:g} mm of "
            "water per day and degree of the air above 0 °C; the stack melts "
            f"{'after the cover' if settings.cover == 'weather' else 'from the first event on'}"
        )
    if settings.thaw:
        share = irradiance_share([day.weather for day in days])
        sun = ", or colder in sunshine" if share else ""
        yield f"snow does not adhere to the panel in air warmer than 0 °C{sun} ({settings.thaw})"
        if share < 1.0:
            yield sunshine_left_out(share)


def irradiance_share(rows: Sequence[Weather]) -> float:
    """Return the share of rows with an irradiance."""
    return sum(row.irradiance is not None for row in rows) / len(rows)


def sunshine_left_out(share: float) -> str:
    """Return which sunshine is left out if a share of the rows, below 1, has an irradiance."""
    if share == 0.0:
        return "sunshine is left out, because the weather has no irradiance"
    return f"{percent(1.0 - share, 2)} of the weather's rows have no irradiance, and count as dark"


def fall_notes(
    scene: Mapping[str, Any],
    table: pd.DataFrame,
    days: Sequence[WinterDay],
    settings: SeasonSettings,
) -> Iterator[str]:
    """Yield a note on the height from which the snow falls.

    Parameters
    ----------
    scene
        The complete scene of the panel.
    table
        As in season.csv.
    days, settings
        Days and settings of the season.
    """
    cover = cover_below_slides(scene, days, table["cover_m"])
    if cover:
        yield (
            f"the snow falls on the natural cover: in the simulation and its film the panel stands "
            f"{cover:.2f} m lower, by the mean depth of the cover at the slide-offs"
        )
    elif scene.get("obstacles") and settings.cover not in ("none", 0.0):
        yield "the snow falls on bare ground, because the scene has obstacles, which stand on it"


def notes(
    dx: float,
    days: Sequence[WinterDay],
    settings: SeasonSettings,
    events: pd.DataFrame,
    first_staying_event: Optional[int],
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
    first_staying_event
        From `first_staying`.
    """
    return [
        *_slab_notes(dx, days, settings),
        *_ageing_notes(settings),
        *_slide_off_notes(events, first_staying_event),
    ]


def _slab_notes(dx: float, days: Sequence[WinterDay], settings: SeasonSettings) -> Iterator[str]:
    released = [day for day in days if day.event is not None]
    estimated = sum(day.density is not None and day.weather.density is None for day in days)
    if estimated:
        yield f"{estimated} densities are estimates ({settings.density})"
    if released:
        thinnest = min(day.slab_thickness for day in released)
        if thinnest < 2.0 * dx:
            yield (
                f"the thinnest slab is {1000 * thinnest:.1f} mm thick, less than two cells of "
                f"{1000 * dx:g} mm: its stack is coarse"
            )
    elif any(day.load for day in days):
        yield "no snow slid: friction and adhesion held it"
    elif any(day.weather.snowfall for day in days):
        yield "no snow lies on the panel, because it is vertical or catches none"


def _ageing_notes(settings: SeasonSettings) -> Iterator[str]:
    if settings.settling:
        yield (
            f"the stack settles between events ({settings.settling}). Published rates differ by a "
            "factor of 4 or more, and settled heights are only estimates"
        )
    if settings.sintering:
        yield (
            f"broken bonds regain strength ({settings.sintering}), all of it in "
            f"{settings.strength_age:g} hours"
        )


def _slide_off_notes(events: pd.DataFrame, first_staying_event: Optional[int]) -> Iterator[str]:
    if first_staying_event is not None:
        yield (
            f"from event {first_staying_event} on, snow that should have left stayed on the panel; "
            "later slabs are laid on top of it"
        )
    unfinished = int((events["ended"] == "time_limit").sum())
    if unfinished:
        yield (
            f"{unfinished} of {len(events)} slide-offs ended before the snow rested; "
            f"allow a longer {argument('max_time')}"
        )
