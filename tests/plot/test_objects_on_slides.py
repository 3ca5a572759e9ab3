"""Areas of later snow, forest and dams on the maps and the page of a slide."""

import pytest

from snowshed.plot.figure_style import blank_figure
from snowshed.plot.slide_objects import NEVER_STARTED, draw_objects, event_rows, slope_objects
from snowshed.plot.slide_page import _mass_table

SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0)]
TERRAIN = {
    "secondary_release": [{"outline": SQUARE}, {"outline": SQUARE}],
    "inflows": [{"outline": SQUARE}],
    "resistance": [{"outline": SQUARE}],
    "dams": [{"corners": [{"x": 1.0, "y": 2.0}, {"x": 3.0, "y": 4.0}, {"x": 5.0, "y": 4.0}]}],
}
LATE = [
    {"name": "bowl", "by_contact": True, "planned_s": 0.0, "time_s": 5.8, "mass_kg": 62966.0},
    {"name": "far", "by_contact": True, "planned_s": 0.0, "time_s": None, "mass_kg": 10.0},
    {"name": "gully", "by_contact": False, "planned_s": 2.0, "time_s": None, "mass_kg": 8000.0},
]


def test_a_map_tells_started_areas_from_others_and_names_each_kind_once():
    objects = slope_objects(TERRAIN, LATE)
    assert [each.dashed for each in objects] == [False, True, False, False, False]
    axes = blank_figure(4, 3).subplots()
    draw_objects(axes, [*objects, *objects])
    _, labels = axes.get_legend_handles_labels()
    assert labels == [
        "secondary release", NEVER_STARTED, "inflow", "forest or resistance", "dam",
    ]  # fmt: skip
    dam = axes.lines[2 * 4 + 1].get_xydata().tolist()
    assert dam == [[1.0, 2.0], [3.0, 4.0], [5.0, 4.0]]  # open
    assert axes.lines[1].get_xydata().tolist() == [*map(list, SQUARE), [0.0, 0.0]]  # closed


def test_the_table_says_of_each_part_whether_it_acted():
    facts = {"late_releases": LATE, "detrained_kg": 19770.0}
    dams = [{"name": "upper", "passed_kg": 1202.0}, {"name": "lower", "passed_kg": 0.0}]
    assert event_rows({**facts, "dams": dams}) == [
        ("secondary release", "bowl", "62.966 t after 5.80 s"),
        ("secondary release", "far", "never started"),
        ("inflow at 2 s", "gully", "the slide ended earlier"),
        ("forest", "", "took 19.770 t"),
        ("dam", "upper", "1.202 t passed over it"),
        ("dam", "lower", "no snow passed over it"),
    ]
    assert event_rows({"late_releases": [], "detrained_kg": 0.0, "dams": []}) == []


def test_the_masses_of_the_page_add_up():
    figures = {
        "released_kg": 1000.0, "secondary_kg": 200.0, "inflow_kg": 30.0, "entrained_kg": 4.0,
        "detrained_kg": 500.0, "left_terrain_kg": 60.0, "on_terrain_kg": 674.0,
    }  # fmt: skip
    *parts, end = [float(mass) for _, mass in _mass_table(figures).rows]
    assert sum(parts) == pytest.approx(end) and end == 0.674
    del figures["inflow_kg"]
    assert "brought by inflows" not in [name for name, _ in _mass_table(figures).rows]
