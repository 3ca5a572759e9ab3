"""Facts about a film that a page or a video needs first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

import matplotlib as mpl
import numpy as np
from scipy.spatial import cKDTree

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.io.film import Film, FilmFrame
from snowshed.plot.solids import Box

COLOURS = "viridis"  # perceptually uniform, and safe for colour-blind eyes
#: Part of the colour map that stands out from a light background.
ON_LIGHT = (0.0, 0.88)
#: Part of the colour map that stands out from a dark background.
ON_DARK = (0.25, 1.0)
SHOWN_SHARES = (0.005, 0.995)  # quantiles of all values at the ends of the colour scale
MAX_LABELS = 10  # largest number of labelled events; more events get a colour scale
SPACING_SAMPLE = 4000  # particles whose nearest neighbours are searched
BALL_RATIO = 0.72  # radius over the distance of neighbours: snow is drawn without gaps
CODE_SHIFT = 1 << 15  # codes lie between -711 and 711, and are counted with this shift


@dataclass(frozen=True)
class Colouring:
    """A colouring of the particles.

    Attributes
    ----------
    name, title
        Name of a quantity, "event" or "material"; and the title of its legend.
    low, high
        Values with the first and the last colour.
    labels
        Labels of whole numbers; None for quantities.
    """

    name: str
    title: str
    low: float
    high: float
    labels: Optional[Sequence[str]] = None

    @property
    def option(self) -> str:
        """Text in a list of choices."""
        if self.labels is not None or self.name == "event":
            return {"event": "event", "material": "snow"}[self.name]
        return self.title.partition(",")[0].lower()

    def colours(self, *, dark: bool = False) -> Floats:
        """Return the colours for a light or a dark background, (256, 3), from 0 to 1."""
        shown = np.linspace(*(ON_DARK if dark else ON_LIGHT), 256)
        table: Floats = mpl.colormaps[COLOURS](shown)[:, :3]
        return table

    def of(self, frame: FilmFrame, film: Film) -> Floats:
        """Return the colours of a frame's particles, (n, 3)."""
        if self.name == "event":
            values = frame.events.astype(float)
        elif self.name == "material":
            values = frame.materials.astype(float)
        else:
            which = [quantity.name for quantity in film.quantities].index(self.name)
            values = film.quantities[which].values(frame.codes[:, which]).astype(float)
        part = (values - self.low) / max(self.high - self.low, 1e-20)
        chosen: Floats = self.colours()[np.clip(255 * part, 0, 255).round().astype(int)]
        return chosen


@dataclass(frozen=True)
class FilmSummary:
    """Common properties of all frames of a film.

    Attributes
    ----------
    bounds
        Bounds of all positions at all times.
    radius
        Radius of a particle, m.
    colourings
        Colourings that distinguish particles; the page begins with the first.
    last
        The last frame.
    """

    bounds: Box
    radius: float
    colourings: Sequence[Colouring]
    last: FilmFrame


def summarise_film(film: Film) -> FilmSummary:
    """Return the common properties of all frames of a film.

    Raises
    ------
    InputError
        If the film holds no particles, or is damaged.
    """
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    counts = np.zeros((len(film.quantities), 2 * CODE_SHIFT), dtype=np.int64)
    spacing, last, materials = np.nan, None, 0
    for frame in film:
        if not len(frame.ids):
            continue
        low = np.minimum(low, frame.positions.min(axis=0))
        high = np.maximum(high, frame.positions.max(axis=0))
        for which, codes in enumerate(frame.codes.T):
            counts[which] += np.bincount(
                np.clip(codes, 1 - CODE_SHIFT, CODE_SHIFT - 1) + CODE_SHIFT,
                minlength=2 * CODE_SHIFT,
            )
        if np.isnan(spacing):
            spacing = _spacing(frame.positions)
        materials = max(materials, int(frame.materials.max()))
        last = frame
    if last is None:
        raise InputError(f"{film.path}: holds no particles yet")
    ranges = [_range(film, which, count) for which, count in enumerate(counts)]
    return FilmSummary(
        bounds=Box(low, high),
        radius=BALL_RATIO * spacing,
        colourings=_colourings(film, ranges, materials),
        last=last,
    )


def _spacing(positions: Floats) -> float:
    """Return the distance of neighbours in the first frame, m."""
    if len(positions) < 2:
        return 0.02
    some = positions[:: 1 + len(positions) // SPACING_SAMPLE]
    distance, _ = cKDTree(positions).query(some, k=2)
    return float(np.median(distance[:, 1])) or 1e-6


def _range(film: Film, which: int, counts: np.ndarray) -> tuple[float, float]:
    share = np.cumsum(counts) / counts.sum()
    codes = np.searchsorted(share, SHOWN_SHARES) - CODE_SHIFT
    low, high = film.quantities[which].values(codes.astype(np.int32)).tolist()
    if film.quantities[which].name in ("speed", "thickness", "coordination"):
        low = 0.0
    return low, high


def _colourings(
    film: Film, ranges: Sequence[tuple[float, float]], materials: int
) -> list[Colouring]:
    events = film.frames[-1].event
    colourings = []
    if events > 1:
        labels = [f"event {k}" for k in range(1, events + 1)] if events <= MAX_LABELS else None
        title = "Released in" if labels else "Released in event"
        colourings.append(Colouring("event", title, 1.0, float(events), labels))
    for quantity, (low, high) in zip(film.quantities, ranges):
        if high > low:
            unit = "" if quantity.unit == "1" else f", {quantity.unit.replace('m3', 'm³')}"
            colourings.append(Colouring(quantity.name, _short(quantity.meaning) + unit, low, high))
    if materials:
        labels = [f"snow {k + 1}" for k in range(materials + 1)]
        colourings.append(Colouring("material", "Snow", 0.0, float(materials), labels))
    if not colourings:
        colourings.append(Colouring("event", "Released in", 1.0, 2.0, ["event 1"]))
    return colourings


def _short(meaning: str) -> str:
    return meaning.partition(",")[0].partition(";")[0].strip() or "Value"
