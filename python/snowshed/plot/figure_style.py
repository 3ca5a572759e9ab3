"""The common look of figures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from snowshed.base.arguments import checked
from snowshed.io.atomic import replacing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK, FAINT, STACK, BODY = "#22303c", "#8a97a3", "#2b6a8f", "#c8553d"
#: Part of the colour map of events that reads well on white.
FIRST_SHADE, LAST_SHADE = 0.08, 0.86
#: Colours that stay apart for colour-blind eyes and in print (Okabe and Ito).
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d31")
#: Colour of noise, beside the colours of effects.
NOISE = "#c9d1d8"
GRID = "#e6eaee"
#: For `matplotlib.rc_context`.
STYLE: dict[Any, Any] = {
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.titlelocation": "left",
    "axes.titlesize": 10.5,
    "axes.labelsize": 9,
    "axes.axisbelow": True,
    "axes.grid": True,
    "grid.color": GRID,
    "grid.linewidth": 0.7,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "font.size": 9,
}


@checked
def blank_figure(width: float, height: float) -> Figure:
    """Return an empty figure that needs no screen.

    Parameters
    ----------
    width, height
        In inches.

    Examples
    --------
    >>> blank_figure(4, 3).axes
    []
    """
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def headline(figure: Figure, text: str) -> None:
    """Write the subject of a figure above all of its diagrams, at the left."""
    figure.suptitle(text, x=0.01, ha="left", color=INK, fontsize=10.5)


def describe(figure: Figure, text: str) -> None:
    """Write the key numbers of a figure above it, in small letters, at the left."""
    figure.suptitle(text, x=0.02, ha="left", color=INK, fontsize=9, linespacing=1.5)


def mute_frame(axes: Axes) -> None:
    """Remove the parts of a frame that are not needed."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=9)
    axes.set_axisbelow(True)


@checked
def save_figure(figure: Figure, path: Path, *, dpi: int = 160) -> None:
    """Write a figure to a file, whole or not at all."""
    with replacing(path) as beside:
        figure.savefig(beside, dpi=dpi)
