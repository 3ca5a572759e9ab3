"""The page of a moving view: one file that needs no network."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed.base.messages import printable
from snowshed.io.atomic import write_text
from snowshed.io.film import Film
from snowshed.plot.film_picture import still_picture, view_lift
from snowshed.plot.film_summary import Colouring, FilmSummary, summarise_film
from snowshed.plot.html_page import HtmlTable, template
from snowshed.plot.pressed_faces import PressurePicture
from snowshed.plot.solids import Box, Solid

VIEWER = Path(__file__).with_name("viewer")
SCRIPTS = ("film.js", "camera.js", "draw.js", "overlay.js", "controls.js", "view.js")


@dataclass(frozen=True)
class MeasureLine:
    """A dimension in the picture: its ends (m), its event, and its label."""

    event: int
    start: Sequence[float]
    end: Sequence[float]
    label: str


@dataclass(frozen=True)
class ViewContent:
    """The content of a page besides its film.

    Attributes
    ----------
    title, sentence
        Title of the page, and its result in a sentence.
    facts
        Names and values.
    notes
        Notes for readers.
    solids, focus
        Solids of the scene, and a box that must be in view.
    measures
        Lengths that are drawn.
    table
        The measures of all events.
    events
        Number of events.
    pressures
        Pressures on faces; None without any.
    """

    title: str
    sentence: str
    facts: Sequence[tuple[str, str]]
    solids: Sequence[Solid]
    focus: Box
    notes: Sequence[str] = ()
    measures: Sequence[MeasureLine] = field(default_factory=tuple)
    table: Optional[HtmlTable] = None
    events: int = 1
    pressures: Optional[PressurePicture] = None


def write_view_page(file: Path, film: Film, content: ViewContent) -> None:
    """Write the page of a moving view.

    Parameters
    ----------
    file
        The HTML file; it appears whole or not at all.
    film
        The film.
    content
        The content of the page besides the film.
    """
    summary = summarise_film(film)
    page = template("snowshed.plot", "view.html.j2")
    flat = film.dimension == 2
    text = page.render(
        title=content.title,
        sentence=content.sentence,
        described=f"{content.title}, moving view",
        style=(VIEWER / "view.css").read_text(encoding="utf-8"),
        script="\n".join((VIEWER / script).read_text(encoding="utf-8") for script in SCRIPTS),
        data=_embedded(_data(film, summary, content)),
        film=base64.b64encode(film.path.read_bytes()).decode(),
        colourings=[colouring.option for colouring in summary.colourings],
        still=still_picture(film, summary, content.solids, content.focus),
        notes=[*content.notes, *_film_notes(film)],
        facts=[*content.facts, *_film_facts(film)],
        table=content.table,
        section=not flat,
        flat=flat,
        measured=bool(content.measures),
        pressed=content.pressures is not None,
    )
    write_text(file, text)


def _data(film: Film, summary: FilmSummary, content: ViewContent) -> dict[str, Any]:
    return {
        "dimension": film.dimension,
        "bounds": _box(summary.bounds),
        "focus": _box(content.focus),
        "radius": summary.radius,
        "lift": view_lift(content.solids),
        "events": content.events,
        "meshes": [solid.data for solid in content.solids],
        "pressures": None if content.pressures is None else content.pressures.data,
        "colourings": [_colouring(colouring) for colouring in summary.colourings],
        "measures": [
            {
                "event": measure.event,
                "from": list(measure.start),
                "to": list(measure.end),
                "label": printable(measure.label),
            }
            for measure in content.measures
        ],
    }


def _box(box: Box) -> dict[str, list[float]]:
    return {"low": box.low.tolist(), "high": box.high.tolist()}


def _colouring(colouring: Colouring) -> dict[str, Any]:
    tables = {
        name: base64.b64encode(
            np.round(255 * colouring.colours(dark=dark)).astype(np.uint8).tobytes()
        )
        for name, dark in (("light", False), ("dark", True))
    }
    return {
        **asdict(colouring),
        "colours": {name: table.decode() for name, table in tables.items()},
    }


def _embedded(data: Mapping[str, Any]) -> Any:
    """Return data as JSON that is safe inside an element of a page."""
    import markupsafe

    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    for sign in "<>&":  # no text of the data can end the element
        text = text.replace(sign, f"\\u{ord(sign):04x}")
    return markupsafe.Markup(text)


def _film_notes(film: Film) -> list[str]:
    notes = []
    if film.share < 1.0:
        notes.append(
            f"The film holds one of {1 / film.share:.0f} particles, chosen by their ids; "
            "the others move between them."
        )
    return [*notes, *(note[0].upper() + note[1:] + "." for note in film.notes)]


def _film_facts(film: Film) -> list[tuple[str, str]]:
    most = max(frame.particles for frame in film.frames)
    return [
        ("film", f"{len(film.frames)} frames, every {film.interval:.3g} s of the snow's time"),
        ("particles shown", f"{most:,}"),
        ("positions to", f"{1e3 * film.quantum / 2:.2g} mm"),
    ]
