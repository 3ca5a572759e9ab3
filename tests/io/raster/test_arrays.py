"""Rasters from arrays in memory."""

import numpy as np
import pytest

from snowshed import InputError
from snowshed.io.raster.arrays import raster_of
from snowshed.io.raster.raster import Raster

HEIGHTS = np.array([[0.0, 1.0], [2.0, 3.0]])


def field(values=HEIGHTS, **attributes):
    xarray = pytest.importorskip("xarray")
    return xarray.DataArray(values, {"y": [15.0, 5.0], "x": [0.0, 10.0]}, attrs=attributes)


def test_masked_heights_are_missing():
    raster = Raster(np.ma.masked_less(HEIGHTS, 1.0), 0.0, 0.0, 5.0)
    assert np.isnan(raster.heights[0, 0]) and raster.heights[1, 1] == 3.0


@pytest.mark.parametrize(
    "heights",
    [HEIGHTS + 1j, HEIGHTS.astype(object), HEIGHTS[None], HEIGHTS[0], HEIGHTS.tolist()],
    ids=["complex", "objects", "three dimensions", "a row", "lists"],
)
def test_heights_that_are_no_numbers_in_rows_and_columns_are_refused(heights):
    with pytest.raises(InputError, match=r"(?s)raster: heights: .*; needed: an array of numbers"):
        Raster(heights, 0.0, 0.0, 5.0)


@pytest.mark.parametrize("name", ["_FillValue", "missing_value", "nodata"])
def test_the_number_of_missing_values_of_a_data_array_is_applied(name):
    heights = raster_of(field(HEIGHTS - 3.0, **{name: -3.0})).heights
    assert np.isnan(heights[1, 0]) and np.isnan(heights).sum() == 1


@pytest.mark.parametrize(("name", "value"), [("scale_factor", 0.1), ("add_offset", 1000.0)])
def test_packed_numbers_of_a_data_array_are_refused(name, value):
    with pytest.raises(InputError, match=f"terrain: its attribute {name} is {value}; apply it"):
        raster_of(field(**{name: value}))
    assert raster_of(field(scale_factor=1.0, add_offset=0.0)).cell == 10.0


def test_coordinates_of_a_data_array_in_kilometres_are_refused():
    hill = field()
    hill["x"].attrs["units"] = "km"
    with pytest.raises(InputError, match="terrain: the units of x are 'km'; convert them"):
        raster_of(hill)
