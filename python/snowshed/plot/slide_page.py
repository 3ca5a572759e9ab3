"""The page of a slide: summary, maps, the slide over time, and its settings."""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.colors import Normalize
from matplotlib.image import imsave

from snowshed.io.atomic import write_text
from snowshed.io.raster.raster import Raster
from snowshed.methods.slide.event_notes import event_notes
from snowshed.methods.slide.frames import Frame
from snowshed.methods.slide.maps import SlideMaps
from snowshed.methods.slide.validity import ReleaseArea
from snowshed.plot.figure_style import STYLE, blank_figure
from snowshed.plot.html_page import HtmlTable, Picture, template
from snowshed.plot.slide_figure import MIN_SHOWN_THICKNESS, PEAKS, slide_figure
from snowshed.plot.slide_objects import SlopeObject, draw_objects, event_rows
from snowshed.plot.terrain_map import (
    Extent,
    Outline,
    draw_outlines,
    draw_terrain,
    draw_values,
    extent,
    focus,
    panel_size,
)
from snowshed.scene.schema import scene_parameters

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SMALL_MULTIPLES = 6
COLOURS = "YlGnBu"
BASE_DPI = 130
#: The largest error of a slide, measured on real topographies (docs/trust/slide-record.md).
GRID_ERROR = (
    "Results depend on the size of the cells: on two real gullies, cells of half the size changed "
    "the thickness by a quarter on average, and the area by 4 and 18 %."
)


@dataclass(frozen=True)
class SlideFilm:
    """Pictures of the snow at some times, to be laid over a picture of the ground.

    Attributes
    ----------
    ground
        Picture of the ground as PNG, in base64.
    frames
        Pictures of the snow as PNG, in base64, with their times, s.
    width, ratio
        Width of the picture in CSS pixels, and its ratio of width to height.
    largest
        Thickness that has the last colour, m.
    colours
        CSS colours of the scale, from nothing to `largest`.
    outlines
        Corners of the release areas, as shares of width and height of the picture, in percent.
    objects
        The same of areas of later snow, forest and dams.
    """

    ground: str
    frames: Sequence[tuple[float, str]]
    width: int
    ratio: float
    largest: float
    colours: Sequence[str]
    outlines: Sequence[str]
    objects: Sequence[tuple[SlopeObject, str]] = ()


def write_slide_page(
    file: Path,
    maps: SlideMaps,
    scene: Mapping[str, Any],
    areas: Sequence[ReleaseArea],
    figures: Mapping[str, Any],
    frames: Sequence[Frame],
    objects: Sequence[SlopeObject] = (),
    facts: Mapping[str, Any] = MappingProxyType({}),
) -> None:
    """Write the page of a slide, a single file that needs no network.

    Parameters
    ----------
    file
        The HTML file; it appears whole or not at all.
    maps
        The maps at the end.
    scene
        The complete scene's data.
    areas
        The release areas.
    figures
        The summary of the slide, as in ``slide.json``.
    frames
        The snow over time.
    objects
        Areas of later snow, forest and dams on the slope.
    facts
        ``slide_facts`` of the core's simulation, for what happened to each of them.
    """
    outlines = [area["outline"] for area in scene["terrain"]["release"]]
    events = event_rows(facts)
    event_texts = {*event_notes(facts)} if events else set()
    assumed = str(scene["terrain"].get("notes") or "").splitlines()
    page = template("snowshed.plot", "slide.html.j2")
    text = page.render(
        title=scene.get("title") or "Snow slide",
        sentence=headline(figures),
        notes=[note for note in figures.get("notes", ()) if note not in {*assumed, *event_texts}],
        assumed=assumed,
        facts=_facts(figures),
        areas=_area_table(areas),
        events=HtmlTable(("", "name", "during the slide"), events, "lll") if events else None,
        mass=_mass_table(figures),
        settings=_settings_table(scene),
        peaks=[_peak(maps, outlines, quantity, objects) for quantity in PEAKS],
        film=_film(maps, outlines, frames, objects) if len(frames) > 1 else None,
        multiples=_multiples(maps, outlines, frames, objects) if len(frames) > 1 else None,
        crs=scene["terrain"].get("crs") or "not given",
        cell=maps.cell,
        accuracy=GRID_ERROR,
    )
    write_text(file, text)


def headline(figures: Mapping[str, Any]) -> str:
    """Return a sentence on the distance, speed and pressure of a slide.

    Examples
    --------
    >>> headline({"run_out_m": 106.0, "drop_m": 75.2, "sim_time_s": 44.2, "peak_speed_m_s": 3.49,
    ...           "peak_pressure_kpa": 3.65, "peak_thickness_m": 1.2, "reached_m2": 6900.0,
    ...           "ended": "rest"})[:54]
    'The snow came 106 m from the middle of the release and'
    """
    ended = "and rested" if figures["ended"] == "rest" else "and still moved"
    speed = figures["peak_speed_m_s"]
    return (
        f"The snow came {figures['run_out_m']:.0f} m from the middle of the release and "
        f"{figures['drop_m']:.0f} m down {ended} after {figures['sim_time_s']:.0f} s. Highest "
        f"values: speed {speed:.1f} m/s ({3.6 * speed:.0f} km/h), thickness "
        f"{figures['peak_thickness_m']:.1f} m, pressure {figures['peak_pressure_kpa']:.1f} kPa."
    )


def _facts(figures: Mapping[str, Any]) -> list[tuple[str, str]]:
    bonds = figures["bonds_made"]
    broken = f"{figures['bonds_broken']:,} of {bonds:,}" if bonds else "no bonds"
    return [
        ("run-out", f"{figures['run_out_m']:.1f} m from the middle of the release"),
        ("drop", f"{figures['drop_m']:.1f} m"),
        ("duration", f"{figures['sim_time_s']:.1f} s, until {figures['ended'].replace('_', ' ')}"),
        ("peak speed", f"{figures['peak_speed_m_s']:.2f} m/s"),
        ("peak pressure", f"{figures['peak_pressure_kpa']:.2f} kPa"),
        ("peak thickness", f"{figures['peak_thickness_m']:.2f} m"),
        ("area reached", f"{figures['reached_m2']:,.0f} m²"),
        ("bonds broken", broken),
    ]


def _area_table(areas: Sequence[ReleaseArea]) -> HtmlTable:
    head = ("area", "thickness, m", "on the map, m²", "along the ground, m²", "volume, m³",
            "slope, °", "altitude, m")  # fmt: skip
    rows = [
        (
            area.name,
            f"{area.thickness:g}",
            f"{area.area:,.0f}",
            f"{area.sloping_area:,.0f}",
            f"{area.volume:,.0f}",
            f"{area.slope:.0f} ({area.flattest:.0f} to {area.steepest:.0f})",
            f"{area.lowest:.0f} to {area.highest:.0f}",
        )
        for area in areas
    ]
    return HtmlTable(head, rows, "lrrrrrr")


def _mass_table(figures: Mapping[str, Any]) -> HtmlTable:
    always = ("released_kg", "entrained_kg", "left_terrain_kg", "on_terrain_kg")
    masses = [
        ("released", "released_kg", 1.0),
        ("released by snow of the slide", "secondary_kg", 1.0),
        ("brought by inflows", "inflow_kg", 1.0),
        ("entrained", "entrained_kg", 1.0),
        ("taken by forest", "detrained_kg", -1.0),
        ("left the terrain", "left_terrain_kg", -1.0),
        ("on the terrain at the end", "on_terrain_kg", 1.0),
    ]
    rows = [
        (name, f"{1e-3 * sign * figures.get(key, 0.0) + 0.0:,.3f}")
        for name, key, sign in masses
        if key in always or figures.get(key, 0.0) > 0.0
    ]
    return HtmlTable(("mass", "t"), rows, "lr")


def _settings_table(scene: Mapping[str, Any]) -> HtmlTable:
    settings = scene["numerics"]
    rows = [
        (name, _setting_text(settings[name]), parameter.unit, parameter.description)
        for parameter in scene_parameters("slide")
        for section, _, name in [parameter.path.partition(".")]
        if section == "numerics" and name in settings and name != "threads"
    ]
    return HtmlTable(("setting", "value", "unit", "meaning"), rows, "lrll")


def _setting_text(value: Any) -> str:
    return str(value).lower() if isinstance(value, (bool, str)) else f"{value:g}"


def _peak(
    maps: SlideMaps, outlines: Sequence[Outline], quantity: str, objects: Sequence[SlopeObject]
) -> Picture:
    figure = slide_figure(maps, outlines, quantity, 38.0, objects)
    name = PEAKS[quantity][0].partition(",")[0]
    caption = "Largest value over time at every node; the dashed line holds the snow at the end."
    return Picture.drawn(figure, quantity, name.capitalize(), caption)


def _shown(outlines: Sequence[Outline], objects: Sequence[SlopeObject]) -> list[Outline]:
    return [*outlines, *(each.corners for each in objects)]


def _window(maps: SlideMaps, outlines: Sequence[Outline]) -> tuple[slice, slice, Extent]:
    """Return the rows and columns to show, and the map coordinates of their outer edges."""
    ground = maps.raster(maps.terrain)
    west, east, south, north = focus(ground, maps.peak_thickness > MIN_SHOWN_THICKNESS, outlines)
    edges = extent(ground)
    c0, c1 = (round((x - edges[0]) / maps.cell) for x in (west, east))
    r0, r1 = (round((y - edges[2]) / maps.cell) for y in (south, north))
    part = (
        edges[0] + c0 * maps.cell,
        edges[0] + c1 * maps.cell,
        edges[2] + r0 * maps.cell,
        edges[2] + r1 * maps.cell,
    )
    return slice(r0, r1), slice(c0, c1), part


def _film(
    maps: SlideMaps,
    outlines: Sequence[Outline],
    frames: Sequence[Frame],
    objects: Sequence[SlopeObject] = (),
) -> SlideFilm:
    rows, columns, part = _window(maps, _shown(outlines, objects))
    ground = maps.raster(maps.terrain)
    width, height = panel_size(part, 38.0)
    figure = blank_figure(width, height)
    figure.set_layout_engine("none")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    draw_terrain(axes, ground, part)
    axes.set_axis_off()
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=BASE_DPI)
    largest = _largest(frames)
    colours = mpl.colormaps[COLOURS]
    scale = [mpl.colors.to_hex(colours(share)) for share in np.linspace(0.15, 1.0, 8)]
    shown = [(frame.time, _overlay(frame.window(rows, columns), largest)) for frame in frames]
    encoded = base64.b64encode(file.getvalue()).decode()
    rings = [_in_percent(outline, part) for outline in outlines]
    lines = [(each, _in_percent(each.corners, part)) for each in objects]
    ratio = width / height
    return SlideFilm(encoded, shown, round(96 * width), ratio, largest, scale, rings, lines)


def _in_percent(outline: Outline, part: Extent) -> str:
    """Return the corners of an outline in a picture of a part of the map, as SVG has them."""
    west, east, south, north = part
    return " ".join(
        f"{100.0 * (x - west) / (east - west):.3f},{100.0 * (north - y) / (north - south):.3f}"
        for x, y in outline
    )


def _largest(frames: Sequence[Frame]) -> float:
    """Return the thickness that only 0.5 % of the snow's cells exceed, m."""
    values = np.concatenate(
        [frame.thickness[frame.thickness > MIN_SHOWN_THICKNESS] for frame in frames]
    )
    return float(np.quantile(values, 0.995)) if values.size else 1.0


def _overlay(thickness: Any, largest: float) -> str:
    """Return the snow as a PNG with one pixel per cell, transparent without snow."""
    share = 0.15 + 0.85 * np.clip(thickness / largest, 0.0, 1.0)
    pixels = np.asarray(mpl.colormaps[COLOURS](share, bytes=True))
    pixels[..., 3] = np.where(thickness > MIN_SHOWN_THICKNESS, 225, 0)
    file = io.BytesIO()
    imsave(file, np.ascontiguousarray(pixels[::-1]), format="png")
    return base64.b64encode(file.getvalue()).decode()


def _multiples(
    maps: SlideMaps,
    outlines: Sequence[Outline],
    frames: Sequence[Frame],
    objects: Sequence[SlopeObject],
) -> Picture:
    title = "The slide over time"
    caption = "Thickness of the snow, and the release."
    figure = multiples_figure(maps, outlines, frames, objects=objects)
    return Picture.drawn(figure, "over_time", title, caption)


def multiples_figure(
    maps: SlideMaps,
    outlines: Sequence[Outline],
    frames: Sequence[Frame],
    count: int = SMALL_MULTIPLES,
    objects: Sequence[SlopeObject] = (),
) -> Figure:
    """Return small maps of the thickness of the snow, more of them while it moves fast.

    Parameters
    ----------
    maps
        The maps of the slide, from which the terrain is taken.
    outlines
        Corners of the release areas, in map coordinates, m.
    frames
        The snow over time; at most `count` frames are shown.
    count
        Largest number of small maps.
    objects
        Areas of later snow, forest and dams on the slope.
    """
    chosen = _moving(frames, count)
    rows, columns, part = _window(maps, _shown(outlines, objects))
    ground: Raster = maps.raster(maps.terrain)
    across = 3 if (part[1] - part[0]) < 2.2 * (part[3] - part[2]) else 2
    down = -(-len(chosen) // across)
    width, height = panel_size(part, 9.0 if across == 3 else 14.0)
    norm = Normalize(0.0, _largest(frames))
    with mpl.rc_context(STYLE):
        figure = blank_figure(width * across, (height + 0.3) * down + 0.5)
        panels = figure.subplots(down, across, squeeze=False).ravel()
        for axes, frame in zip(panels, chosen):
            draw_terrain(axes, ground, part, labels=False)
            thickness = np.full(ground.heights.shape, np.nan)
            cut = frame.window(rows, columns)
            thickness[rows, columns] = np.where(cut > MIN_SHOWN_THICKNESS, cut, np.nan)
            drawn = draw_values(axes, ground, thickness, cmap=COLOURS, norm=norm)
            draw_outlines(axes, outlines)
            draw_objects(axes, objects)
            axes.set_title(f"{frame.time:.0f} s" if frame.time >= 10 else f"{frame.time:.1f} s")
            axes.set(xticks=[], yticks=[])
        for axes in panels[len(chosen) :]:
            axes.set_axis_off()
        figure.colorbar(drawn, ax=list(panels), label="thickness, m", shrink=0.6, pad=0.01)
    return figure


def _moving(frames: Sequence[Frame], count: int) -> list[Frame]:
    """Return frames from the first to the last, closer together where the snow moves most.

    The times follow the path of the snow's centre, because a slide creeps for a long time at its
    end.
    """
    middles = np.array([_middle(frame) for frame in frames])
    distance = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(middles, axis=0).T))])
    if distance[-1] <= 0.0:
        return [frames[0], frames[-1]]
    wanted = np.linspace(0.0, 0.999 * distance[-1], count)
    indices = list(dict.fromkeys(np.searchsorted(distance, wanted).tolist()))
    return [frames[place] for place in [*indices[:-1], len(frames) - 1]]


def _middle(frame: Frame) -> tuple[float, float]:
    total = float(frame.thickness.sum()) or 1.0
    rows, columns = np.indices(frame.thickness.shape)
    row = frame.first_row + float((rows * frame.thickness).sum()) / total
    return row, frame.first_column + float((columns * frame.thickness).sum()) / total
