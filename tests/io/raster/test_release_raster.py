"""Release areas from rasters of thickness: outlines of cells, holes, gaps, and limits."""

import numpy as np
import pytest

from snowshed import InputError
from snowshed.base.limits import MAX_SNOW_CELLS
from snowshed.io.raster.raster import Raster
from snowshed.io.raster.release import areas_of_depth, snow_part

shapely = pytest.importorskip("shapely")
pytest.importorskip("rasterio")


def raster(values, cell=2.0):
    return Raster(np.asarray(values, dtype=float), 100.0, 200.0, cell, "depth.asc")


def shapes(areas):
    return [shapely.Polygon(area.outline, area.holes) for area in areas]


@pytest.mark.parametrize("seed", range(5))
def test_the_areas_cover_the_cells_with_snow(seed):
    """The outlines of any pattern are those of the union of its cells."""
    depth = raster(np.random.default_rng(seed).integers(0, 2, (9, 11)))
    rows, columns = np.nonzero(depth.heights)
    x, y = depth.east + columns * depth.cell, depth.north + rows * depth.cell
    union = shapely.union_all(shapely.box(x - 1, y - 1, x + 1, y + 1))
    polygons = shapes(areas_of_depth(depth))
    assert all(shape.is_valid for shape in polygons)
    assert shapely.union_all(polygons).symmetric_difference(union).area < 1e-4
    assert sum(shape.area for shape in polygons) == pytest.approx(4.0 * len(rows), rel=1e-6)
    distances = [a.distance(b) for a in polygons for b in polygons if a is not b]
    assert min(distances, default=1.0) > 0.0


def test_areas_that_meet_at_a_corner_are_separate():
    assert len(areas_of_depth(raster([[1, 0], [0, 1]]))) == 2


def test_a_missing_value_amid_snow_is_a_gap_but_not_beside_it():
    values = np.full((5, 5), 0.5)
    values[0, :] = np.nan
    assert len(areas_of_depth(raster(values))) == 1
    values[2, 2] = np.nan
    with pytest.raises(InputError, match=r"depth\.asc: no thickness amid snow at \(104, 204\)"):
        areas_of_depth(raster(values))
    values[2, 2] = 0.0
    assert [len(area.holes) for area in areas_of_depth(raster(values))] == [1]


def test_a_gap_that_opens_at_a_corner_is_not_amid_snow():
    values = np.full((4, 4), 0.5)
    values[1, 1] = values[0, 0] = np.nan
    assert len(areas_of_depth(raster(values))) == 1


def test_many_holes_and_gaps_are_found_quickly():
    """A search for gaps in every hole would need 22500 x 22500 comparisons."""
    values = np.full((300, 300), 0.5)
    values[1:-1:2, 1:-1:2] = np.nan
    with pytest.raises(InputError, match="no thickness amid snow"):
        areas_of_depth(raster(values))
    values[np.isnan(values)] = 0.0
    with pytest.raises(
        InputError, match="has 88808 corners; at most 2222 are allowed with 90000 cells"
    ):
        areas_of_depth(raster(values))


def test_a_large_raster_is_cropped_to_its_snow():
    values = np.zeros((3000, 3000))
    values[1500, 1000:1003] = 0.4
    part = snow_part(raster(values))
    assert part.heights.shape == (3, 5)
    assert (part.east, part.north) == (100.0 + 2.0 * 999, 200.0 + 2.0 * 1499)
    assert len(areas_of_depth(raster(values))) == 1


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.zeros((3, 3)), "holds no thickness above 0"),
        (np.full((3, 3), -0.5), r"a negative thickness at \(100, 200\)"),
        (np.full((3, 3), 9999.0), r"a thickness above 100 m at \(100, 200\)"),
        (np.full((2001, 2000), 0.5), f"holds snow in 4002000 cells; at most {MAX_SNOW_CELLS}"),
    ],
)
def test_invalid_thickness_is_refused(values, message):
    with pytest.raises(InputError, match=rf"depth\.asc: {message}"):
        areas_of_depth(raster(values))
