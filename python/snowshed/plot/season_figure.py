"""The picture of a season: the snow on the panel, the stack below it, and its outlines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Any, Optional, Protocol

import numpy as np
from matplotlib import colormaps
from matplotlib.dates import AutoDateLocator, ConciseDateFormatter, date2num
from matplotlib.figure import Figure

from snowshed.base.arrays import Floats
from snowshed.plot.caption import scene_caption
from snowshed.plot.figure_style import (
    BODY,
    FAINT,
    FIRST_SHADE,
    GRID,
    INK,
    LAST_SHADE,
    STACK,
    blank_figure,
    describe,
    mute_frame,
)
from snowshed.plot.stack_figures import ROWS, named_events

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


class _Contact(Protocol):
    """The first contact of the snow with the panel, as a season has it."""

    @property
    def date(self) -> str: ...
    @property
    def event(self) -> Optional[int]: ...
    @property
    def cause(self) -> str: ...


SIZE = (9.0, 10.2)  # inches


def season_figure(
    table: pd.DataFrame,
    outlines: pd.DataFrame,
    scene: Mapping[str, Any],
    *,
    panels: Sequence[Sequence[Sequence[float]]],
    contact: Optional[_Contact],
    title: str,
    snow: str = "",
) -> Figure:
    """Draw a season.

    Parameters
    ----------
    table
        The table of the season, as in season.csv.
    outlines
        The profiles of the stack, as in outline.csv; without rows if nothing slid.
    scene
        The complete scene of the slide-offs.
    panels
        The upper and the lower edge of each row, (x, z) in m.
    contact
        The first contact of the snow with the panel, if any.
    title
        Text above the figure, before the key numbers of the scene.
    snow
        A line on the quality of the snow data.
    """
    figure = blank_figure(*SIZE)
    load, stack, side = figure.subplots(3, 1, height_ratios=(1.0, 1.1, 1.2))
    moments = [datetime.fromisoformat(date) for date in table["date"]]
    dates: Floats = date2num(moments)  # type: ignore[no-untyped-call]
    _draw_panel_snow(load, dates, table)
    _draw_stack(stack, dates, table, float(panels[0][1][1]), contact)
    _draw_outlines(side, outlines, table, panels)
    for axes in (load, stack):
        locator: Any = AutoDateLocator()  # type: ignore[no-untyped-call]
        formatter: Any = ConciseDateFormatter(locator, show_offset=False)  # type: ignore[no-untyped-call]
        axes.xaxis.set_major_locator(locator)
        axes.xaxis.set_major_formatter(formatter)
    stack.sharex(load)
    for axes in (load, stack, side):
        _style_axes(axes)
    first, last = (f"{moment:%Y-%m-%d}" for moment in (moments[0], moments[-1]))
    caption = scene_caption(dict(scene))
    snow_line = f"\n{snow}" if snow else ""
    describe(figure, f"Season from {first} to {last}, {title}{snow_line}\n{caption}")
    return figure


def _draw_panel_snow(axes: Axes, dates: Floats, table: pd.DataFrame) -> None:
    """Draw the forces that pull and hold the snow on the panel, and its releases."""
    released = (table["released"] == "yes").to_numpy()
    axes.vlines(dates, 0.0, table["driving_pa"], color=STACK, linewidth=3.0, label="downslope pull")
    axes.plot(
        dates,
        table["resisting_pa"],
        "_",
        color=BODY,
        markersize=9,
        markeredgewidth=2,
        label="friction and adhesion",
    )
    axes.plot(
        dates[released],
        table["driving_pa"][released],
        "v",
        color=INK,
        markersize=6,
        label="released",
    )
    axes.set_title("Snow on the panel: stress at its base, Pa", loc="left", color=INK, fontsize=11)
    most = max(table["driving_pa"].max(), table["resisting_pa"].max())
    axes.set_ylim(0.0, 1.25 * most if most > 0.0 else 1.0)  # a winter without snow has none
    axes.legend(frameon=False, fontsize=9, ncols=3, loc="upper left")


def _draw_stack(
    axes: Axes, dates: Floats, table: pd.DataFrame, edge: float, contact: Optional[_Contact]
) -> None:
    """Draw the height of the snow against that of the panel's lower edge."""
    below = table["clearance_m"].rsub(edge)  # the snow right below the edge
    axes.axhline(edge, color=INK, linewidth=1.2, linestyle=(0, (4, 3)))
    axes.annotate(
        "lower edge of the panel",
        (0.0, edge),
        (4, 4),
        xycoords=axes.get_yaxis_transform(),
        textcoords="offset points",
        ha="left",
        color=INK,
        fontsize=9,
    )
    steps: dict[str, Any] = {"where": "post", "linewidth": 2.0}
    cover = table["cover_m"]
    top, settled_top = table["stack_height_m"] + cover, table["settled_height_m"] + cover
    axes.fill_between(
        dates, 0.0, cover, step="post", color=GRID, linewidth=0, label="natural snow cover"
    )
    axes.step(dates, top, color=STACK, label="highest snow", **steps)
    axes.step(dates, below, color=BODY, label="snow below the edge", **steps)
    if (table["settled_height_m"] < table["stack_height_m"]).any():
        name = "settled and melted (estimate)"
        settled = {**steps, "linewidth": 1.3, "linestyle": "--"}
        axes.step(dates, settled_top, color=INK, label=name, **settled)
    if contact is not None:
        row = table["date"].tolist().index(contact.date)
        _mark_contact(axes, dates[row], edge, contact)
    axes.set_title("Snow: height above the ground, m", loc="left", color=INK, fontsize=11)
    axes.set_ylim(0.0, 1.35 * max(edge, float(top.max() or 0.0)))
    axes.legend(frameon=False, fontsize=9, loc="upper left", ncols=4)


def _mark_contact(axes: Axes, date: float, edge: float, contact: _Contact) -> None:
    axes.plot(date, edge, "o", color=BODY, markersize=8)
    event = "" if contact.event is None else f", event {contact.event}"
    axes.annotate(
        f"first contact: {contact.cause}{event}",
        (date, edge),
        (-8, -4),
        textcoords="offset points",
        ha="right",
        va="top",
        color=BODY,
        fontsize=9,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
    )


def _draw_outlines(
    axes: Axes,
    outlines: pd.DataFrame,
    table: pd.DataFrame,
    panels: Sequence[Sequence[Sequence[float]]],
) -> None:
    """Draw the stack's profile on the snow cover of its day, event by event, below the panels."""
    covers = table.dropna(subset=["event"]).groupby("event")["cover_m"].first()
    for panel in panels:
        axes.plot(*zip(*panel), color=INK, linewidth=3.5, solid_capstyle="round")
    axes.axhline(0.0, color=FAINT, linewidth=1.2)
    events = sorted(set(outlines["event"]))
    shades = colormaps["viridis"](np.linspace(FIRST_SHADE, LAST_SHADE, max(len(events), 1)))
    named = named_events(len(events))
    for number, (event, shade) in enumerate(zip(events, shades), 1):
        profile = outlines[outlines["event"] == event]
        name = f"after event {event}" if number in named else None
        cover = float(covers.get(event, 0.0))
        axes.plot(profile["x"], cover + profile["z"], color=shade, linewidth=1.6, label=name)
    if events:
        columns = 1 + (len(named) - 1) // ROWS
        axes.legend(frameon=False, fontsize=9, loc="upper right", ncols=columns)
        deepest = float(covers.max())
        if deepest > 0.0:
            axes.axhspan(0.0, deepest, color=GRID, linewidth=0, zorder=0)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title(
        "Outlines on the natural snow cover, from the side, m", loc="left", color=INK, fontsize=11
    )
    axes.set_xlabel("along the ground from the panel's centre, m", color=INK, fontsize=9)


def _style_axes(axes: Axes) -> None:
    mute_frame(axes)
    axes.grid(color=GRID, linewidth=0.8)
