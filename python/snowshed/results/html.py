"""Results as HTML for notebooks: a picture, a table, and notes."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Optional

if TYPE_CHECKING:
    import pandas as pd

#: Pictures of runs by any method; the first that exists is shown.
PICTURES = ("stack.png", "slide.png", "grains.png")
#: Columns of the table of events.
COLUMNS = ("event", "height_m", "length_m", "mass_kg", "on_panel_kg", "ended")
WIDTH = 640  # pixels


def results_html(
    title: str,
    folder: Path,
    events: Optional[pd.DataFrame],
    figures: Mapping[str, object],
    notes: Iterable[object],
) -> str:
    """Return the results of a run as HTML.

    Parameters
    ----------
    title
        Title of the scene; if it is empty, the name of the folder is shown.
    folder
        The results folder, for its picture.
    events
        The table of events, if the method has one.
    figures
        Figures of a run without such a table.
    notes
        Notes on the results.

    Examples
    --------
    >>> results_html("A slide", Path("out"), None, {"run_out_m": 310.2}, [])
    '<div><b>A slide</b><table><tr><td>run_out_m</td><td>310.2</td></tr></table></div>'
    """
    shown_notes = "".join(f"<br><small>note: {escape(str(note))}</small>" for note in notes)
    table = _figures(figures) if events is None else _events(events)
    return f"<div><b>{escape(title or folder.name)}</b>{_picture(folder)}{table}{shown_notes}</div>"


def _picture(folder: Path) -> str:
    for name in PICTURES:
        path = folder / name
        if path.is_file():
            data = base64.b64encode(path.read_bytes()).decode()
            return f'<br><img width="{WIDTH}" src="data:image/png;base64,{data}">'
    return ""


def _events(events: pd.DataFrame) -> str:
    shown = events[[name for name in COLUMNS if name in events]]
    return str(shown.to_html(index=False, float_format="{:.4g}".format))


def _figures(figures: Mapping[str, object]) -> str:
    rows = "".join(
        f"<tr><td>{escape(name)}</td><td>{_shown(value)}</td></tr>"
        for name, value in figures.items()
    )
    return f"<table>{rows}</table>" if rows else ""


def _shown(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else escape(str(value))
