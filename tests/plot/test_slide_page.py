"""Pictures of a slide: layers lie in the right position on the terrain."""

import base64
import io

import numpy as np
import pytest
from matplotlib.image import imread

from snowshed.io.raster.raster import Raster
from snowshed.methods.slide.frames import Frame
from snowshed.methods.slide.maps import SlideMaps
from snowshed.plot.slide_page import _film, _moving
from snowshed.plot.terrain_map import _cropped, extent, focus

CELL, WEST, SOUTH = 5.0, 6e5, 2e5


@pytest.fixture
def maps() -> SlideMaps:
    """A slope on which snow crosses the rows 20 to 22 from column 10 to 30."""
    rows, columns = np.indices((60, 80))
    crossed = np.where((abs(rows - 21) <= 1) & (columns >= 10) & (columns <= 30), 1.0, 0.0)
    return SlideMaps(
        terrain=1000.0 - 3.0 * columns + 0.0 * rows, peak_thickness=crossed, thickness=crossed,
        peak_speed=crossed, speed=crossed, west=WEST, south=SOUTH, cell=CELL, density=300.0,
    )  # fmt: skip


def frame(time: float, column: int) -> Frame:
    return Frame(time, np.ones((3, 2), dtype=np.float32), 20, column)


def test_the_film_shows_the_snow_where_the_outline_is(maps):
    """The outline follows the cells of the first frame, so its corners (in percent) are theirs."""
    x0, y0 = WEST + 9.5 * CELL, SOUTH + 19.5 * CELL
    x1, y1 = x0 + 2 * CELL, y0 + 3 * CELL
    south = [(x0, SOUTH + 5.0), (x1, SOUTH + 5.0), (x1, SOUTH + 10.0)]  # an area off the centre
    cells = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    film = _film(maps, [cells, south], [frame(0, 10), frame(5, 28)])
    corners = np.array([pair.split(",") for pair in film.outlines[0].split()], dtype=float) / 100
    pixels = imread(io.BytesIO(base64.b64decode(film.frames[0][1])))
    down, across = np.nonzero(pixels[..., 3])
    height, width = pixels.shape[:2]
    assert corners[:, 0].min() == pytest.approx(across.min() / width, abs=1e-4)
    assert corners[:, 0].max() == pytest.approx((across.max() + 1) / width, abs=1e-4)
    assert corners[:, 1].min() == pytest.approx(down.min() / height, abs=1e-4)
    assert corners[:, 1].max() == pytest.approx((down.max() + 1) / height, abs=1e-4)
    later = np.nonzero(imread(io.BytesIO(base64.b64decode(film.frames[1][1])))[..., 3])[1]
    assert later.min() - across.min() == 18
    assert film.ratio == pytest.approx(width / height)


def test_small_maps_show_the_moving_snow_rather_than_its_creeping_end():
    frames = [frame(t, min(10 + 2 * t, 30)) for t in range(60)]
    times = [moving.time for moving in _moving(frames, 6)]
    assert times[0] == 0 and times[-1] == 59
    assert all(time <= 10 for time in times[:-1]) and len(times) == 6
    assert [moving.time for moving in _moving([frame(0, 10), frame(9, 10)], 6)] == [0, 9]


def test_a_part_of_the_terrain_keeps_its_coordinates(maps):
    ground = maps.raster(maps.terrain)
    part = focus(ground, maps.peak_thickness > 0.0, [[(WEST + 100.0, SOUTH + 10.0)]])
    assert part[0] <= WEST + 10 * CELL and part[1] >= WEST + 30 * CELL
    assert part[2] <= SOUTH + 10.0 and part[3] >= SOUTH + 22 * CELL
    cropped = _cropped(ground, part)
    edges = extent(cropped)
    assert edges[0] <= part[0] and edges[1] >= part[1]
    assert edges[2] <= part[2] and edges[3] >= part[3]
    x = np.array([WEST + 77.0])
    assert cropped.height_at(x, x * 0 + SOUTH + 60.0) == ground.height_at(x, x * 0 + SOUTH + 60.0)
    window = focus(Raster(np.zeros((3, 4)), 0.0, 0.0, 1.0), np.zeros((3, 4), dtype=bool), [])
    assert window == (-0.5, 3.5, -0.5, 2.5)
