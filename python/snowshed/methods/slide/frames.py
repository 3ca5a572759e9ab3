"""A slide over time: maps of the thickness of the snow, from the film of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.io.film import Film, FilmFrame
from snowshed.io.raster.raster import Raster

Singles = NDArray[np.float32]
MAX_FRAMES = 64
MIN_PARTICLES = 1.5  # mean number of particles in a square with snow


@dataclass(frozen=True)
class Frame:
    """The thickness of the snow at a time.

    Attributes
    ----------
    time
        Time, s.
    thickness : (rows, columns)
        Thickness in the rectangle that holds all snow, m, the southernmost row first.
    first_row, first_column
        First row and column of the rectangle in the whole grid.
    """

    time: float
    thickness: Singles
    first_row: int
    first_column: int

    def window(self, rows: slice, columns: slice) -> Singles:
        """Return a rectangle of the whole grid, zero where there is no snow."""
        heights = np.zeros((rows.stop - rows.start, columns.stop - columns.start), dtype=np.float32)
        top, left = self.first_row - rows.start, self.first_column - columns.start
        height, width = self.thickness.shape
        r0, r1 = max(top, 0), min(top + height, heights.shape[0])
        c0, c1 = max(left, 0), min(left + width, heights.shape[1])
        if r0 < r1 and c0 < c1:
            heights[r0:r1, c0:c1] = self.thickness[r0 - top : r1 - top, c0 - left : c1 - left]
        return heights


def slide_frames(film: Film, ground: Raster, most: int = MAX_FRAMES) -> list[Frame]:
    """Return maps of the thickness of the snow over time, at the nodes of a slide's grid.

    A node has the mean thickness of the particles in the four cells around it, with bilinear
    weights. If the film holds only some of the particles, the mean is taken over larger squares, so
    that the snow has no holes.

    Parameters
    ----------
    film
        Film of a slide.
    ground
        The grid.
    most
        Largest number of maps; the first and the last frame are among them.

    Raises
    ------
    InputError
        If the film holds no thickness.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import snowshed
    >>> from snowshed.scene.terrain_grid import slide_terrain
    >>> from snowshed.scene.builders.slides import example_slide
    >>> with TemporaryDirectory() as folder:
    ...     scene = example_slide(folder).set("events.max_time", 0.5)
    ...     _ = snowshed.run(scene, folder + "/out", pictures=False)
    ...     frames = slide_frames(Film(folder + "/out/film.bin"), slide_terrain(scene))
    >>> frames[0].time, round(float(np.median(frames[0].thickness)), 1)
    (0.0, 0.5)
    """
    names = [quantity.name for quantity in film.quantities]
    if "thickness" not in names:
        raise InputError(f"{film.path}: not the film of a slide; it holds no thickness")
    column = names.index("thickness")
    count = len(film.frames)
    chosen = set(np.linspace(0, count - 1, min(count, most)).round().astype(int).tolist())
    frames: list[Frame] = []
    edge = 0
    for number, frame in enumerate(film):
        if number not in chosen or not len(frame.ids):
            continue
        edge = edge or _edge(film, frame, ground)
        thickness = film.quantities[column].values(frame.codes[:, column])
        frames.append(_map(frame, thickness, ground, edge))
    return frames


def _edge(film: Film, frame: FilmFrame, ground: Raster) -> int:
    """Return the smallest edge, in cells, of squares that hold enough particles of a film."""
    edge = 1
    cells = np.floor(frame.positions[:, :2] / ground.cell).astype(int)
    while film.share < 1.0 and edge < max(ground.heights.shape):
        squares = len(np.unique(cells // edge, axis=0))
        if len(cells) >= MIN_PARTICLES * squares:
            break
        edge *= 2
    return edge


def _map(frame: FilmFrame, thickness: Singles, ground: Raster, edge: int) -> Frame:
    rows, columns = (-(-size // edge) + 1 for size in ground.heights.shape)
    weight, sums = np.zeros((rows, columns)), np.zeros((rows, columns))
    # A square of several cells is represented by its middle.
    x, y = frame.positions[:, :2].T / (ground.cell * edge) - 0.5 * (1.0 - 1.0 / edge)
    west, south = (np.clip(np.floor(values).astype(int), 0, None) for values in (x, y))
    for row, column, share in _corners(x - west, y - south):
        at = (np.minimum(south + row, rows - 1), np.minimum(west + column, columns - 1))
        np.add.at(weight, at, share)
        np.add.at(sums, at, share * thickness)
    thickness = np.divide(sums, weight, out=np.zeros_like(sums), where=weight > 0.0)
    thickness = np.kron(thickness, np.ones((edge, edge)))[tuple(map(slice, ground.heights.shape))]
    snow = thickness > 0.0
    down, across = (np.flatnonzero(snow.any(axis=axis)) for axis in (1, 0))
    if not down.size:
        down = across = np.array([0])
    cut = thickness[down[0] : down[-1] + 1, across[0] : across[-1] + 1].astype(np.float32)
    return Frame(frame.time, cut, int(down[0]), int(across[0]))


def _corners(east: Floats, north: Floats) -> list[tuple[int, int, Floats]]:
    """Return the bilinear weights of the four nodes around points within cells, by row, column."""
    east, north = np.clip(east, 0.0, 1.0), np.clip(north, 0.0, 1.0)
    return [
        (row, column, (north if row else 1.0 - north) * (east if column else 1.0 - east))
        for row in (0, 1)
        for column in (0, 1)
    ]
