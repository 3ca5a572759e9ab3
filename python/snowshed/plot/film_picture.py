"""Frames of a film as pictures, drawn without a screen: stills, and the frames of a video."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from snowshed.base.arrays import Floats
from snowshed.io.film import Film, FilmFrame
from snowshed.plot.figure_style import blank_figure
from snowshed.plot.film_summary import Colouring, FilmSummary
from snowshed.plot.html_page import Picture
from snowshed.plot.solids import Box, Solid

PAINTS = {"ground": "#dfe5ea", "panel": "#33506b", "solid": "#9aa9b5"}
SKY = "#f5f7f9"
TURN, LIFT = -0.6, 0.28  # radians, initial angles of the camera, as on the page
TERRAIN_LIFT = 0.8  # steep ground is seen from higher up
WIDTH = 8.0  # inches


def view_lift(solids: Sequence[Solid]) -> float:
    """Return the initial elevation of the camera above the horizon, radians."""
    return TERRAIN_LIFT if any(solid.name == "terrain" for solid in solids) else LIFT


@dataclass(frozen=True)
class Projection:
    """A distant view: the directions right, up and toward the viewer (rows)."""

    axes: Floats

    @classmethod
    def of(cls, film: Film, lift: float) -> Projection:
        """Return the view that suits a film: from the side in 2D, from above at a corner in 3D."""
        if film.dimension == 2:
            return cls(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]))
        c, s, rise, level = np.cos(TURN), np.sin(TURN), np.sin(lift), np.cos(lift)
        back = np.array([s * level, -c * level, rise])
        right = np.array([c, s, 0.0])
        return cls(np.array([right, np.cross(back, right), back]))

    def __call__(self, points: Floats) -> Floats:
        """Return points (n, 3) in the view: right, up and toward the viewer."""
        seen: Floats = points @ self.axes.T
        return seen

    def limits(self, box: Box) -> tuple[Floats, Floats]:
        """Return the lower left and the upper right corner of a view of a box."""
        corners = np.array(np.meshgrid(*zip(box.low, box.high))).reshape(3, -1).T
        seen = self(corners)[:, :2]
        low, high = seen.min(axis=0), seen.max(axis=0)
        margin = 0.04 * float((high - low).max())
        return low - margin, high + margin


class FilmPainter:
    """Draws frames of a film, one figure for all of them.

    Parameters
    ----------
    film, summary
        The film and its summary.
    solids, focus
        Solids of the scene, and a box that must be in view.
    width
        Width of the picture, inches.
    """

    def __init__(
        self,
        film: Film,
        summary: FilmSummary,
        solids: Sequence[Solid],
        focus: Box,
        width: float = WIDTH,
    ) -> None:
        self.film = film
        self.view = Projection.of(film, view_lift(solids))
        low, high = self.view.limits(focus)
        height = float(np.clip(width * (high[1] - low[1]) / (high[0] - low[0]), 0.3 * width, width))
        self.figure = blank_figure(width, height)
        self.figure.set_layout_engine("none")
        self.figure.set_facecolor(SKY)
        self.axes = self.figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self.axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
        self.axes.set_axis_off()
        self.axes.set_facecolor(SKY)
        for solid in solids:
            self._draw_solid(solid)
        points = 72.0 * width / (high[0] - low[0])
        self.radius = summary.radius
        self.size = max(2.0 * summary.radius * points, 0.9) ** 2
        self.dots = self.axes.scatter([], [], linewidths=0, zorder=3)

    def _draw_solid(self, solid: Solid) -> None:
        seen = self.view(solid.corners)[solid.triangles]
        order = np.argsort(seen[:, :, 2].mean(axis=1), kind="stable")
        zorder = 1 if solid.kind == "ground" else 2
        facets = solid.corners[solid.triangles]
        normal = np.cross(facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0])
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
        light = 0.75 + 0.25 * np.abs(normal @ np.array([-0.45, -0.5, 0.74]))
        paint = np.array([int(PAINTS[solid.kind][k : k + 2], 16) / 255 for k in (1, 3, 5)])
        colours = np.clip(light[:, None] * paint, 0.0, 1.0)
        self.axes.add_collection(
            PolyCollection(
                list(seen[order][:, :, :2]),
                facecolors=colours[order],
                edgecolors=colours[order],
                linewidths=0.4,
                zorder=zorder,
            ),
            autolim=False,
        )

    def draw(self, frame: FilmFrame, colouring: Colouring) -> Figure:
        """Return the figure with a frame in it."""
        seen = self.view(frame.positions)
        order = np.argsort(seen[:, 2], kind="stable")
        colours = colouring.of(frame, self.film)[order]
        depth = seen[order, 2]
        span = float(np.ptp(depth)) if len(depth) else 0.0
        if span > 0 and self.film.dimension == 3:  # more distant particles are darker
            colours = colours * (0.78 + 0.22 * ((depth - depth.min()) / span)[:, None])
        self._draw_balls(seen[order, :2], colours)
        return self.figure

    def _draw_balls(self, positions: Floats, colours: Floats) -> None:
        """Draw each ball as a disc with a lighter one on it, where the light falls."""
        light = np.clip(0.92 * colours + 0.08, 0.0, 1.0)
        lit = positions + self.radius * np.array([-0.2, 0.25])
        self.dots.set_offsets(np.stack([positions, lit], axis=1).reshape(-1, 2))
        both = np.stack([0.8 * colours, light], axis=1).reshape(-1, 3).tolist()
        self.dots.set_facecolor([(red, green, blue) for red, green, blue in both])
        self.dots.set_sizes(np.tile([self.size, 0.42 * self.size], len(positions)))


def still_picture(film: Film, summary: FilmSummary, solids: Sequence[Solid], focus: Box) -> Picture:
    """Return the last frame of a film as a picture."""
    painter = FilmPainter(film, summary, solids, focus)
    colouring = summary.colourings[0]
    figure = painter.draw(summary.last, colouring)
    caption = f"Colours: {colouring.title[0].lower()}{colouring.title[1:]}."
    return Picture.drawn(figure, "still", "The snow at the end of the film", caption)
