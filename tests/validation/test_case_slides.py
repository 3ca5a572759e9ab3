"""Closed forms of the snow slide's cases, and errors that their measures might miss."""

import numpy as np
import pytest
from scipy.integrate import trapezoid
from validation.slide import case_block as slide_block
from validation.slide import case_dam_break as dam_break
from validation.slide import case_events as slide_events
from validation.slide import case_gully as slide_gully
from validation.slide import case_parabolic_cap as parabolic_cap
from validation.slide import case_pool as slide_pool
from validation.slide import case_rotation as slide_rotation
from validation.slide.site import Plane, Site, maps_of, rectangle, slide_drive


@pytest.mark.parametrize("columns", ["across_flow", "vertical"])
def test_the_exact_dam_break_conserves_mass(columns):
    time = 2.0
    s = np.linspace(-20.0, 40.0, 6001)
    thickness = dam_break.exact_thickness(s, time, columns)
    moved = 0.5 * dam_break.PLANE.coulomb(dam_break.FRICTION) * time**2  # mass from above
    assert trapezoid(thickness, s) == pytest.approx(20.0 + moved, rel=1e-4)
    at_front = dam_break.exact_thickness(
        np.array(dam_break.exact_front(time, columns)), time, columns
    )
    assert at_front == pytest.approx(dam_break.FRONT_THICKNESS)


@pytest.mark.parametrize(("shape", "mass"), [("ridge", 2 / 3 * 20 * 28), ("cap", np.pi * 100 / 2)])
def test_terraces_have_the_mass_of_the_parabola(shape, mass):
    plane = parabolic_cap.PLANE
    site = Site(plane.height, -20.0, -28.0, 44.0, 28.0, parabolic_cap.terraces(shape))
    settings = {"cell": 2.0, "layer_thickness": 0.1, "density": 300.0}
    drive = slide_drive(site, settings)
    assert drive.masses.sum() == pytest.approx(300.0 * mass, rel=1e-6)
    assert parabolic_cap._half_length(drive, shape) == pytest.approx(10.0, rel=0.06)


def test_voellmys_block_follows_its_equation():
    step = 1e-4
    present, later = (slide_block.block_motion("voellmy", t) for t in (1.0, 1.0 + step))
    drag = 9.81 / (slide_block.TURBULENCE * slide_block.THICKNESS)
    rate = slide_block.PLANE.coulomb(slide_block.FRICTION) - drag * present.speed**2
    assert (later.speed - present.speed) / step == pytest.approx(rate, rel=1e-3)
    assert (later.distance - present.distance) / step == pytest.approx(present.speed, rel=1e-3)


def test_a_map_turned_four_times_is_the_same():
    plane = Plane(20.0)
    site = Site(plane.height, -70.0, -70.0, 70.0, 70.0, [rectangle(-20, -5, 0, 15, 1.0)])
    maps = maps_of(slide_drive(site, {"cell": 2.0}))
    turned = maps.peak_thickness
    for _ in range(4):
        turned = slide_rotation._turned(maps, turned, 90.0)
    assert turned[1:-1, 1:-1] == pytest.approx(maps.peak_thickness[1:-1, 1:-1], abs=1e-9)


def test_a_wrong_friction_of_the_block_is_detected():
    settings = {**slide_block.DEFAULTS, "layer_thickness": 0.25, "law": "coulomb"}
    right = slide_block.measure(settings).measured[1]
    wrong = slide_block.measure({**settings, "friction": 1.02 * slide_block.FRICTION}).measured[1]
    assert abs(right.error) < 0.005 < abs(wrong.error)


def test_columns_of_the_wrong_direction_widen_a_stream():
    settings = {**slide_pool.DEFAULTS, "ground": "gully"}
    right, wrong = (
        slide_pool.measure({**settings, "columns": columns}).measured[0].error
        for columns in ("across_flow", "vertical")
    )
    assert abs(right) < 0.05 < wrong


def test_long_steps_do_not_change_a_slide_in_a_gully():
    measured = slide_gully.measure({**slide_gully.DEFAULTS, "time_step": 0.1}).measured
    assert {m.quantity: abs(m.error) < 0.01 for m in measured} == dict.fromkeys(
        ("speed", "area", "run_out"), True
    )


@pytest.mark.parametrize("part", ["inflow", "forest", "held", "passed"])
def test_later_snow_forest_and_dams_keep_their_limits(part):
    outcome = slide_events.measure({**slide_events.DEFAULTS, "part": part})
    limits = {quantity.name: quantity.limit for quantity in slide_events.CASE.quantities}
    for measured in outcome.measured:
        assert abs(measured.error) <= limits[measured.quantity]
