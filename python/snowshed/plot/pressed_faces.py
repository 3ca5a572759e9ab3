"""Peak pressures of the snow on faces, as colours in the moving view."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional

import matplotlib as mpl
import numpy as np

from snowshed.base.arrays import Floats
from snowshed.plot.solids import Solid

COLOURS = "YlOrRd"
LEVELS = 6
#: Faces with a smaller share of the largest pressure keep the colour of their obstacle.
MIN_SHARE = 0.02
#: Thickness of faces in 2D, as a share of the size of the picture.
BAND = 0.008
MAX_FACES = 40_000  # in a page; earlier events are left out


@dataclass(frozen=True)
class PressedFaces:
    """Faces of one obstacle with one colour, after one event."""

    event: int
    level: int
    solid: Solid


@dataclass(frozen=True)
class PressurePicture:
    """The pressed faces of a page, and their scale.

    Attributes
    ----------
    top
        The largest pressure, Pa.
    faces
        Pressed faces.
    first
        The first event whose faces are shown.
    """

    top: float
    faces: Sequence[PressedFaces]
    first: int

    @property
    def data(self) -> dict[str, Any]:
        """The picture as JSON data for a page."""
        shades = mpl.colormaps[COLOURS](np.linspace(0.15, 1.0, LEVELS))[:, :3]
        colours = np.round(shades, 3).tolist()
        limits = np.linspace(0.0, self.top / 1000.0, LEVELS + 1)
        limits[0] = MIN_SHARE * self.top / 1000.0
        return {
            "title": "Peak pressure (10 ms), kPa",
            "colours": colours,
            "labels": [f"{low:.3g} to {high:.3g}" for low, high in zip(limits, limits[1:])],
            "faces": [
                {**pressed.solid.data, "event": pressed.event, "paint": colours[pressed.level]}
                for pressed in self.faces
            ],
        }

    @property
    def notes(self) -> list[str]:
        """Notes for readers."""
        if self.first <= 1:
            return []
        return [f"The pressures before event {self.first} are not in this view."]


def pressure_picture(
    pressures: Iterable[tuple[int, Mapping[str, Any]]], solids: Sequence[Solid], size: float
) -> Optional[PressurePicture]:
    """Return the pressed faces after events; None without any pressure.

    Parameters
    ----------
    pressures
        Events, the last first, and their pressures, as from `read_pressures`.
    solids
        The solids of the scene. Faces move with the solid of their name.
    size
        Size of the picture, m.
    """
    chosen: list[tuple[int, Mapping[str, Any]]] = []
    faces = 0
    for event, table in pressures:
        faces += len(table["area"])
        if chosen and faces > MAX_FACES:
            break
        chosen.append((event, table))
    top = max((float(table["peak_pressure"].max(initial=0.0)) for _, table in chosen), default=0.0)
    if not top > 0.0:
        return None
    motions = {solid.name: solid.motion for solid in solids}
    pressed = [
        PressedFaces(event, level, Solid(name, "pressed", *corners, motion=motions.get(name)))
        for event, table in chosen
        for level, name, corners in _grouped(table, top, BAND * size)
    ]
    return PressurePicture(top, pressed, min(event for event, _ in chosen))


def _grouped(
    table: Mapping[str, Any], top: float, thickness: float
) -> Iterator[tuple[int, str, tuple[Floats, Any]]]:
    """Yield the faces of each obstacle and level of pressure: their corners and triangles."""
    shares = np.asarray(table["peak_pressure"]) / top
    levels = np.minimum((LEVELS * shares).astype(int), LEVELS - 1)
    names = np.asarray(table["obstacle"])
    shown = shares >= MIN_SHARE
    for name in np.unique(names[shown]).tolist():
        for level in np.unique(levels[shown & (names == name)]).tolist():
            group = shown & (names == name) & (levels == level)
            yield level, name, _triangles(np.asarray(table["corners"])[group], thickness)


def _triangles(faces: Floats, thickness: float) -> tuple[Floats, Any]:
    """Return corners and triangles of faces (n, 4, 3), or of lines (n, 2, 3) as thick bands."""
    if faces.shape[1] == 2:
        along = faces[:, 1] - faces[:, 0]
        normal = np.stack([-along[:, 2], 0.0 * along[:, 0], along[:, 0]], axis=1)
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
        out = 0.5 * thickness * normal[:, None, :]
        faces = np.concatenate([faces - out, (faces + out)[:, ::-1]], axis=1)
    first = 4 * np.arange(len(faces))[:, None]
    triangles = (first[:, None] + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)
    return faces.reshape(-1, 3), triangles
