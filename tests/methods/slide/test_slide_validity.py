"""Warnings of slides outside the range of the method."""

import math

import numpy as np
import pytest

from snowshed.io.raster.raster import Raster
from snowshed.methods.slide.validity import release_areas, validity_notes

GOOD = {"drop_m": 60.0, "bonds_made": 100, "bonds_broken": 2, "ended": "rest"}
SETTINGS = {"bonds": True, "layer_thickness": 0.25}
OUTLINE = [(20.0, 20.0), (40.0, 20.0), (40.0, 50.0), (20.0, 50.0)]


def plane(angle: float, top: float = 1000.0) -> Raster:
    fall = math.tan(math.radians(angle)) * np.arange(50) * 2.0
    return Raster(np.tile(top - fall, (40, 1)), 0.0, 0.0, 2.0)


def area(angle: float, thickness: float = 0.5, top: float = 1000.0, **settings: object):
    (release,) = release_areas(
        plane(angle, top),
        [{"name": "slab", "outline": OUTLINE, "thickness": thickness, **settings}],
    )
    return release


def test_a_release_on_a_plane_is_measured_exactly():
    release = area(36.0)
    assert (release.slope, release.flattest, release.steepest) == pytest.approx((36.0,) * 3)
    assert release.area == pytest.approx(600.0)
    assert release.volume == pytest.approx(0.5 * 600.0 / math.cos(math.radians(36.0)))
    hole = {"outline": [(25.0, 25.0), (35.0, 25.0), (35.0, 35.0), (25.0, 35.0)]}
    assert area(36.0, holes=[hole]).area == pytest.approx(500.0)


def test_the_slope_of_a_hole_is_not_that_of_the_release():
    ground = plane(36.0)
    ground.heights[13:17, 13:17] += 4.0  # a block in the middle
    hole = {"outline": [(21.5, 21.5), (38.5, 21.5), (38.5, 38.5), (21.5, 38.5)]}
    release = {"name": "ring", "outline": OUTLINE, "thickness": 0.5}
    assert release_areas(ground, [release])[0].steepest > 50.0
    assert release_areas(ground, [{**release, "holes": [hole]}])[0].steepest < 37.0


def test_a_slide_within_the_stated_range_has_no_warning():
    assert validity_notes([area(36.0)], SETTINGS, GOOD) == []


@pytest.mark.parametrize(
    ("release", "settings", "figures", "message"),
    [
        (area(24.0), {}, {}, "made for slopes of 28 to 50 degrees"),
        (area(54.0), {}, {}, "made for slopes of 28 to 50 degrees"),
        (area(36.0, top=2100.0), {}, {}, "made for 500 to 1500 m"),
        (area(36.0, thickness=0.2), {}, {}, "less than the layer"),
        (area(36.0), {}, {"drop_m": 120.0}, "drop is 120 m"),
        (area(36.0), {}, {"bonds_broken": 40}, "40 % of the bonds broke"),
        (area(36.0), {"bonds": False}, {}, "plain avalanche"),
        (area(36.0), {}, {"ended": "time_limit"}, "still moving"),
    ],
)
def test_every_condition_outside_the_range_has_a_warning(release, settings, figures, message):
    (note,) = validity_notes([release], {**SETTINGS, **settings}, {**GOOD, **figures})
    assert message in note


def test_a_release_by_a_raster_has_its_mean_thickness():
    depth = Raster(np.tile(np.linspace(0.0, 1.0, 101), (101, 1)), 0.0, 0.0, 1.0)
    release = {"name": "drift", "outline": OUTLINE, "thickness": 9.0}
    (measured,) = release_areas(plane(36.0), [release], depth)
    assert measured.thickness == pytest.approx(0.3, abs=0.006)  # in its middle, 30 m to the east
    assert measured.volume == pytest.approx(0.3 * 600.0 / math.cos(math.radians(36.0)), rel=0.02)
