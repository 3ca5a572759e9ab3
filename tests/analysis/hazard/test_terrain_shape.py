"""Slope, plan curvature and ruggedness on surfaces with known answers."""

import numpy as np
import pytest

from snowshed.analysis.hazard.terrain_shape import terrain_shape
from snowshed.io.raster.raster import Raster


def grid(columns=41, rows=41, cell=5.0):
    """Return coordinates whose origin is the middle cell, m."""
    axes = ((np.arange(count) - count // 2) * cell for count in (columns, rows))
    return np.meshgrid(*axes)


def shape_of(heights, cell=5.0):
    return terrain_shape(Raster(heights, 0.0, 0.0, cell))


@pytest.mark.parametrize("toward", [0.0, 33.0, 90.0, 210.0])
def test_a_plane_has_its_slope_and_neither_curvature_nor_ruggedness(toward):
    x, y = grid()
    down = np.sin(np.radians(toward)) * x + np.cos(np.radians(toward)) * y
    shape = shape_of(1000.0 - np.tan(np.radians(35.0)) * down)
    inner = np.s_[1:-1, 1:-1]
    assert shape.slope[inner] == pytest.approx(np.full((39, 39), 35.0), abs=1e-9)
    assert np.abs(shape.plan_curvature[inner]).max() < 1e-12
    assert shape.ruggedness(9)[inner].max() < 1e-12
    assert shape.surface[20, 20] == pytest.approx(1.0 / np.cos(np.radians(35.0)))


def test_the_border_and_cells_beside_a_hole_have_no_shape():
    x, _ = grid(9, 7)
    heights = 1000.0 - 0.7 * x
    heights[3, 4] = np.nan
    missing = np.isnan(shape_of(heights).slope)
    expected = np.ones((7, 9), dtype=bool)
    expected[1:-1, 1:-1] = False
    expected[2:5, 3:6] = True
    assert (missing == expected).all()
    assert np.isnan(shape_of(heights).ruggedness(3)[3, 4])


@pytest.mark.parametrize(("sign", "ridge"), [(1.0, True), (-1.0, False)])
def test_a_sloping_cylinder_has_the_curvature_of_its_radius(sign, ridge):
    """On the crest of a ridge it is 1/R; in the bed of a gully it is -1/R."""
    x, y = grid(cell=1.0)
    radius = 100.0
    heights = 1000.0 - 0.7 * y + sign * (np.sqrt(radius**2 - x**2) - radius)
    middle = shape_of(heights, 1.0).plan_curvature[20, 20]
    assert middle == pytest.approx(sign / radius, rel=1e-4)
    assert (middle > 0.0) == ridge


def test_a_cone_has_a_curvature_that_falls_with_the_distance_from_its_axis():
    """The second derivative of a cone of slope b along a level circle of radius r is tan b / r."""
    x, y = grid(cell=1.0, columns=121, rows=121)
    r = np.hypot(x, y)
    curvature = shape_of(1500.0 - 0.8 * r, 1.0).plan_curvature
    away = (r > 20.0) & np.isfinite(curvature)
    assert curvature[away] == pytest.approx(0.8 / r[away], rel=5e-3)


@pytest.mark.parametrize("cells", [9, 21])
def test_a_cylinder_has_the_ruggedness_of_its_arc(cells):
    """The mean normal over an arc from -a to a of sines has the length (cos b + b / sin b) / 2."""
    x, _ = grid(cell=0.5, columns=161, rows=161)
    radius = 100.0
    rugged = shape_of(1000.0 + np.sqrt(radius**2 - x**2), 0.5).ruggedness(cells)
    half = np.arcsin(0.5 * cells * 0.5 / radius)
    length = 0.5 * (np.cos(half) + half / np.sin(half))
    assert rugged[80, 80] == pytest.approx(1.0 - length, rel=0.02)


def test_the_ruggedness_of_a_roof_is_that_of_its_two_normals():
    """The ridge between slopes of 40 degrees; its own cells are level."""
    x, _ = grid(cell=1.0)
    rugged = shape_of(1000.0 - np.tan(np.radians(40.0)) * np.abs(x), 1.0).ruggedness(9)
    share = 8.0 / 9.0
    length = (1.0 - share) + share * np.cos(np.radians(40.0))
    assert rugged[20, 20] == pytest.approx(1.0 - length, rel=1e-9)


@pytest.mark.parametrize("toward", [0.0, 33.0, 90.0, 135.0, 210.0, 300.0])
def test_the_aspect_is_the_direction_of_the_fall_line(toward):
    x, y = grid()
    down = np.sin(np.radians(toward)) * x + np.cos(np.radians(toward)) * y
    aspect = shape_of(1000.0 - 0.7 * down).aspect(5)[1:-1, 1:-1]
    assert np.abs((aspect - toward + 180.0) % 360.0 - 180.0).max() < 1e-6
