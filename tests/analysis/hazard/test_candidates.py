"""Candidate release areas on planes, cones and hills, turned, mirrored and refined."""

import numpy as np
import pytest

from snowshed import InputError, SnowshedNote
from snowshed.analysis.hazard import ReleaseRules, find_release_areas
from snowshed.base.notes import record_notes
from snowshed.io.raster.areas import MapArea
from snowshed.io.raster.raster import Raster
from snowshed.scene.builders.hillside import hillside

shapely = pytest.importorskip("shapely")
pytest.importorskip("rasterio")

pytestmark = pytest.mark.filterwarnings("ignore:.*cells of . m; the rules for release areas")


def plane(degrees, columns=41, rows=31, cell=5.0, **options):
    x = np.arange(columns) * cell
    return Raster(
        np.tile(3000.0 - np.tan(np.radians(degrees)) * x, (rows, 1)), 1000.0, 2000.0, cell,
        **options,
    )  # fmt: skip


def polygons(found_areas):
    return [shapely.Polygon(area.outline, area.holes) for area in found_areas.outlines]


def cone(slope=40.0, cell=2.0, half=60):
    axis = np.arange(-half, half + 1) * cell
    r = np.hypot(*np.meshgrid(axis, axis))
    return Raster(3000.0 - np.tan(np.radians(slope)) * r, axis[0], axis[0], cell)


@pytest.mark.parametrize(("degrees", "count"), [(27.9, 0), (28.1, 1), (59.9, 1), (60.1, 0)])
def test_a_plane_is_a_candidate_within_the_slopes(degrees, count):
    assert len(find_release_areas(plane(degrees)).areas) == count


def test_a_plane_has_its_figures():
    (area,) = find_release_areas(plane(40.0), thickness=0.8).areas
    flat = 39 * 29 * 25.0  # all cells but those at the border
    ground = flat / np.cos(np.radians(40.0))
    assert (area.area, area.surface) == pytest.approx((flat, ground))
    assert (area.slope, area.lowest_slope, area.highest_slope) == pytest.approx((40.0,) * 3)
    assert (area.aspect, area.thickness, area.largest_thickness) == pytest.approx((90.0, 0.8, 0.8))
    assert area.volume == pytest.approx(0.8 * ground)
    assert area.highest - area.lowest == pytest.approx(38 * 5.0 * np.tan(np.radians(40.0)))
    (shape,) = polygons(find_release_areas(plane(40.0)))
    assert shape.bounds == pytest.approx((1002.5, 2002.5, 1197.5, 2147.5), abs=1e-5)


@pytest.mark.parametrize(
    ("turns", "aspect"), [(0, 90.0), (1, 0.0), (2, 270.0), (3, 180.0)], ids=["E", "N", "W", "S"]
)
def test_the_aspect_follows_the_slope(turns, aspect):
    ground = plane(40.0)
    turned = Raster(np.rot90(ground.heights, -turns), 0.0, 0.0, 5.0)
    (area,) = find_release_areas(turned).areas
    assert area.aspect == pytest.approx(aspect, abs=1e-9)


def test_the_top_of_a_cone_is_a_ridge_and_the_rest_faces_all_sides():
    """The plan curvature tan(b) / r exceeds its limit up to the radius tan(b) / limit."""
    ground = cone()
    rules = ReleaseRules(max_ruggedness=1.0, sectors=1)
    (area,) = find_release_areas(ground, rules).areas
    assert area.aspect is None
    (shape,) = polygons(find_release_areas(ground, rules))
    (hole,) = shape.interiors
    radius = np.sqrt(shapely.Polygon(hole).area / np.pi)
    assert radius == pytest.approx(np.tan(np.radians(40.0)) / 0.06, rel=0.06)
    assert area.area == pytest.approx(shape.area, rel=1e-6)


@pytest.mark.parametrize("sectors", [2, 4, 8])
def test_a_cone_is_split_by_sectors_of_the_same_size(sectors):
    ground = cone()
    outside = (3000.0 - ground.heights > 100.0 * np.tan(np.radians(40.0))).astype(float)
    beyond = Raster(outside, ground.east, ground.north, ground.cell)
    rules = ReleaseRules(max_ruggedness=1.0, sectors=sectors)
    areas = find_release_areas(ground, rules, forest=beyond).areas
    assert len(areas) == sectors
    assert [area.area for area in areas] == pytest.approx([areas[0].area] * sectors, rel=0.05)
    off = np.array([area.aspect for area in areas]) % (360.0 / sectors)
    assert np.minimum(off, 360.0 / sectors - off).max() < 1.5


def test_small_parts_of_a_sector_join_their_neighbour():
    """A bump of 3 m turns the aspect of some cells of a slope, but the slope stays one area."""
    x, y = np.meshgrid(np.arange(60) * 5.0, np.arange(60) * 5.0)
    bump = 3.0 * np.exp(-((x - 150.0) ** 2 + (y - 150.0) ** 2) / 200.0)
    diagonal = 0.75 * (x * np.cos(0.38) + y * np.sin(0.38))  # close to the border of two sectors
    ground = Raster(3000.0 - diagonal + bump, 0.0, 0.0, 5.0)
    rules = {"max_plan_curvature": 10.0, "ruggedness_window": 15.0}
    (area,) = find_release_areas(ground, ReleaseRules(**rules, min_area=5000.0)).areas
    assert area.area == 58 * 58 * 25.0
    assert len(find_release_areas(ground, ReleaseRules(**rules, min_area=25.0)).areas) > 1


def test_a_gully_is_not_left_out_but_a_ridge_is():
    x, y = np.meshgrid((np.arange(41) - 20) * 5.0, np.arange(61) * 5.0)
    fold = 12.0 * np.exp(-((x / 8.0) ** 2))
    rules = ReleaseRules(max_ruggedness=1.0)
    gully = find_release_areas(Raster(3000.0 - 0.75 * y - fold, 0.0, 0.0, 5.0), rules)
    ridge = find_release_areas(Raster(3000.0 - 0.75 * y + fold, 0.0, 0.0, 5.0), rules)
    middle = shapely.Point(20 * 5.0, 150.0)
    assert any(shape.contains(middle) for shape in polygons(gully))
    assert not any(shape.contains(middle) for shape in polygons(ridge))


def test_rough_ground_is_left_out():
    """The ground of the eastern half is as steep on average, but rough."""
    ground = plane(38.0, columns=81, rows=61)
    heights = ground.heights.copy()
    heights[:, 40:] += np.random.default_rng(1).normal(0.0, 4.0, heights[:, 40:].shape)
    rough = Raster(heights, 0.0, 0.0, 5.0)
    loose, strict = (
        find_release_areas(rough, ReleaseRules(max_plan_curvature=10.0, max_ruggedness=limit)).areas
        for limit in (1.0, 0.08)
    )
    eastern = shapely.box(225.0, 0.0, 400.0, 300.0)
    sizes = [
        sum(shapely.Polygon(a.outline.outline).intersection(eastern).area for a in areas)
        for areas in (loose, strict)
    ]
    assert sizes[0] > 0.3 * eastern.area
    assert sizes[1] < 0.02 * eastern.area
    assert 195.0 < max(x for x, _ in strict[0].outline.outline) < 225.0


def turned_and_mirrored():
    return {
        "quarter turn": lambda z: np.rot90(z),
        "half turn": lambda z: np.rot90(z, 2),
        "mirrored": lambda z: z[:, ::-1],
        "transposed": lambda z: z.T,
    }


@pytest.mark.parametrize("name", turned_and_mirrored())
def test_candidates_turn_and_mirror_with_the_terrain(name):
    change = turned_and_mirrored()[name]
    hill = hillside()
    before = find_release_areas(hill, thickness=1.0)
    after = find_release_areas(Raster(change(hill.heights), 0.0, 0.0, 2.0), thickness=1.0)
    figures = [
        sorted(
            (a.area, round(a.surface, 6), round(a.slope, 9), round(a.volume, 6)) for a in c.areas
        )
        for c in (before, after)
    ]
    assert len(before.areas) >= 1
    assert figures[0] == figures[1]
    assert list(before.remaining.values()) == list(after.remaining.values())


def smooth_bowl(cell):
    count = round(400.0 / cell)
    x, y = np.meshgrid((np.arange(count) + 0.5) * cell, (np.arange(count) + 0.5) * cell)
    heights = 2500.0 - 40.0 * np.tanh((x - 200.0) / 55.0) - 0.4 * x + 6.0 * np.sin(y / 70.0)
    return Raster(heights, 0.5 * cell, 0.5 * cell, cell)


def test_halving_the_cells_changes_the_areas_little():
    coarse, fine = (find_release_areas(smooth_bowl(cell), thickness=0.5) for cell in (5.0, 2.5))
    assert len(coarse.areas) == len(fine.areas) == 1
    a, b = coarse.areas[0], fine.areas[0]
    assert b.area == pytest.approx(a.area, rel=0.04)
    assert b.slope == pytest.approx(a.slope, abs=0.3)
    (first,), (second,) = polygons(coarse), polygons(fine)
    assert first.symmetric_difference(second).area < 0.06 * first.area


def test_small_areas_go_and_the_smallest_allowed_stays():
    ground = plane(10.0, columns=40, rows=30)
    heights = ground.heights.copy()
    steep = np.s_[10:15, 10:14]  # 20 cells of 25 m2, 500 m2
    heights[:, :] = 2000.0
    x = np.arange(40) * 5.0
    heights[:, :] = 2000.0 - 0.1 * x
    blocked = np.ones((30, 40))
    blocked[steep] = 0.0
    forest = Raster(blocked, 1000.0, 2000.0, 5.0, name="forest")
    slope = plane(40.0, columns=40, rows=30)
    for smallest, count in ((500.0, 1), (501.0, 0)):
        rules = ReleaseRules(min_area=smallest)
        areas = find_release_areas(slope, rules, forest=forest).areas
        assert [area.area for area in areas] == [500.0] * count


def test_areas_that_meet_at_a_corner_are_two_and_do_not_touch():
    slope = plane(40.0)
    blocked = np.ones(slope.heights.shape)
    blocked[5:10, 5:10] = blocked[10:15, 10:15] = 0.0
    forest = Raster(blocked, 1000.0, 2000.0, 5.0)
    first, second = polygons(find_release_areas(slope, forest=forest))
    assert first.distance(second) > 0.0
    assert first.is_valid and second.is_valid


def test_gaps_are_filled_up_to_their_limit():
    slope = plane(40.0)
    blocked = np.zeros(slope.heights.shape)
    blocked[10:12, 10:12] = 1.0  # 100 m2
    forest = Raster(blocked, 1000.0, 2000.0, 5.0)
    holes = [
        len(
            find_release_areas(slope, ReleaseRules(max_gap=gap), forest=forest)
            .areas[0]
            .outline.holes
        )
        for gap in (0.0, 99.0, 100.0)
    ]
    assert holes == [1, 1, 0]


def test_cells_of_a_gap_are_connected_by_their_corners():
    slope = plane(40.0)
    blocked = np.zeros(slope.heights.shape)
    blocked[10, 10] = blocked[11, 11] = 1.0
    forest = Raster(blocked, 1000.0, 2000.0, 5.0)
    (area,) = find_release_areas(slope, ReleaseRules(max_gap=25.0), forest=forest).areas
    assert area.area == (39 * 29 - 2) * 25.0


@pytest.mark.parametrize(("cell", "count"), [(5.0, 9), (1.0, 45), (2.0, 23), (15.0, 3)])
def test_the_window_of_the_ruggedness_has_its_size_in_metres(cell, count):
    assert ReleaseRules().window_cells(cell) == count


def test_a_gap_without_elevation_is_not_filled():
    heights = plane(40.0).heights.copy()
    heights[15, 20] = np.nan
    ground = Raster(heights, 1000.0, 2000.0, 5.0)
    (area,) = find_release_areas(ground, ReleaseRules(max_gap=1e4)).areas
    assert len(area.outline.holes) == 1
    assert area.area == (39 * 29 - 9) * 25.0


def test_forest_is_a_raster_of_other_cells_or_areas():
    slope = plane(40.0)
    west = [(990.0, 1990.0), (1107.0, 1990.0), (1107.0, 2200.0), (990.0, 2200.0)]
    by_areas = find_release_areas(slope, forest=[MapArea("wood", west)])
    values = np.zeros((20, 25))
    values[:, :13] = 60.0  # crown cover, %
    by_raster = find_release_areas(slope, forest=Raster(values, 985.0, 1995.0, 10.0))
    for candidates in (by_areas, by_raster):
        (area,) = candidates.areas
        assert min(x for x, _ in area.outline.outline) == pytest.approx(1107.5)
        assert area.area == 18 * 29 * 25.0


def test_forest_without_a_value_is_noted():
    slope = plane(40.0)
    forest = Raster(np.zeros((5, 5)), 1000.0, 2000.0, 5.0, name="wood.tif")
    with pytest.warns(SnowshedNote, match=r"wood\.tif: has no value in 98% of the terrain"):
        find_release_areas(slope, forest=forest)


def test_a_raster_of_thickness_gives_mean_largest_and_volume():
    slope = plane(40.0)
    depth = np.where(np.arange(41) < 21, 0.4, 0.6) * np.ones((31, 1))
    (area,) = find_release_areas(slope, thickness=Raster(depth, 1000.0, 2000.0, 5.0)).areas
    mean = (20 * 0.4 + 19 * 0.6) / 39
    assert (area.thickness, area.largest_thickness) == pytest.approx((mean, 0.6))
    assert area.volume == pytest.approx(mean * area.surface)
    assert area.outline.thickness == pytest.approx(mean)


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.nan, np.inf])
def test_a_thickness_that_is_no_snow_is_refused(wrong):
    with pytest.raises(InputError, match=r"in a candidate at \(1005, 2005\)"):
        find_release_areas(plane(40.0), thickness=wrong)


def test_cells_of_other_sizes_are_noted():
    with record_notes() as notes:
        find_release_areas(plane(40.0))
        assert notes == []
        find_release_areas(plane(40.0, cell=1.0))
    assert "cells of 1 m; the rules for release areas were made for cells of 5 m" in notes[0]


def test_other_coordinate_systems_are_refused():
    forest = Raster(np.zeros((31, 41)), 1000.0, 2000.0, 5.0, name="forest", crs="EPSG:2056")
    with pytest.raises(InputError, match="different coordinate systems"):
        find_release_areas(plane(40.0, crs="EPSG:31287"), forest=forest)


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"min_slope": 60.0}, "slope: 60 to 60 degrees"),
        ({"max_slope": 91.0}, "slope: 28 to 91 degrees"),
        ({"min_area": -1.0}, "min_area: -1; allowed: finite numbers from 0"),
        ({"max_ruggedness": np.nan}, "max_ruggedness: nan"),
        ({"ruggedness_window": 5.0}, "5 m are 1 cells of 5 m; allowed: 3 to 401 cells"),
        ({"ruggedness_window": 1e6}, "allowed: 3 to 401 cells"),
    ],
)
def test_impossible_rules_are_refused(limits, message):
    with pytest.raises(InputError, match=message):
        find_release_areas(plane(40.0), ReleaseRules(**limits))


@pytest.mark.parametrize(
    ("heights", "message"),
    [
        (np.full((9, 9), np.nan), "holds no elevation"),
        (np.full((9, 9), 1e38), "do not occur on Earth"),
        (1000.0 - 40.0 * np.arange(9.0) * np.ones((9, 1)), "steeper than 83 degrees"),
    ],
)
def test_implausible_terrain_is_refused(heights, message):
    with pytest.raises(InputError, match=message):
        find_release_areas(Raster(heights, 0.0, 0.0, 5.0))


@pytest.mark.parametrize("shape", [(1, 1), (2, 50), (50, 2), (3, 3)])
def test_terrain_without_inner_cells_has_no_candidates(shape):
    heights = 1000.0 - 4.0 * np.arange(shape[1]) * np.ones((shape[0], 1))
    assert find_release_areas(Raster(heights, 0.0, 0.0, 5.0)).areas == []


def checkerboard(side):
    slope = plane(40.0, columns=side, rows=side)
    blocked = np.indices(slope.heights.shape).sum(axis=0) % 2
    return slope, Raster(blocked.astype(float), 1000.0, 2000.0, 5.0)


def test_more_candidates_than_a_slide_takes_are_noted():
    slope, forest = checkerboard(151)
    with pytest.warns(SnowshedNote, match="11101 candidates with 44404 corners; a slide takes"):
        found_areas = find_release_areas(slope, ReleaseRules(min_area=25.0), forest=forest)
    assert len(found_areas.areas) == 11101


def test_far_too_many_candidates_are_refused():
    slope, forest = checkerboard(451)
    with pytest.raises(InputError, match="100801 candidates with 403204 corners; at most 100000"):
        find_release_areas(slope, ReleaseRules(min_area=25.0), forest=forest)


def test_the_rules_leave_less_and_less():
    remaining = list(find_release_areas(hillside()).remaining.values())
    assert remaining == sorted(remaining, reverse=True)
    assert remaining[0] == 64 * 104 * 4.0
