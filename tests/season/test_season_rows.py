"""Rows of panels and fences in a season."""

from datetime import datetime

import numpy as np
import pytest

from snowshed import InputError, Scene
from snowshed.analysis.clearance import (
    PanelDesign,
    SnowRanges,
    answer_text,
    required_clearance,
    split_winters,
)
from snowshed.analysis.clearance.winters import Winter
from snowshed.scene.panel_edge import panel_edge
from snowshed.season import SeasonSettings, accumulate, run_season
from snowshed.season.panel_contact import below_panel, clearance, panel_ends
from snowshed.season.rows import PanelRows
from snowshed.season.slabs import season_scene
from snowshed.season.weather.generator import EXAMPLE_CLIMATE
from snowshed.season.weather.row import Weather

SNOWFALL = [Weather(2, datetime(2024, 12, 1), 0.12, 200.0, -4.0)]
TWO = PanelRows(2, 3.0)


def panel_scene(**values):
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.03})
    scene.update({"events.max_time": 3.0, "numerics.threads": 1, "snow.youngs_modulus": 2e5})
    return scene.update({"seeding.particles_per_voxel": 4, **values})


def test_every_row_sheds_its_snow(tmp_path):
    """Two rows far apart: twice the mass, and the same height as of a single row."""
    single = run_season(SNOWFALL, panel_scene(), tmp_path / "single")
    rows = run_season(SNOWFALL, panel_scene(), tmp_path / "rows", settings=SeasonSettings(rows=TWO))
    first, second = (
        np.genfromtxt(tmp_path / name / "run" / "events.csv", delimiter=",", names=True)
        for name in ("single", "rows")
    )
    laid = [events["mass_kg"] + events["on_panel_kg"] + events["on_structures_kg"]
            for events in (first, second)]  # fmt: skip
    assert laid[1] == pytest.approx(2.0 * laid[0], rel=0.01)
    assert second["mass_kg"] == pytest.approx(2.0 * first["mass_kg"], rel=0.05)
    height = [result.table["stack_height_m"].iloc[0] for result in (single, rows)]
    assert height[1] == pytest.approx(height[0], rel=0.25)
    assert any("2 rows of panels" in note for note in rows.notes)
    assert len(rows.panels) == 2
    assert rows.panels[1][1][0] - rows.panels[0][1][0] == pytest.approx(3.0)


def test_a_heap_below_any_row_closes_the_clearance():
    data = panel_scene().resolve().data
    heap = np.array([[2.9, 0.0], [3.08, 0.25], [3.3, 0.0]])  # below the second row only
    assert clearance(data, heap, 0.25).below == pytest.approx(data["panel"]["height"])
    assert clearance(data, heap, 0.25, rows=TWO.distances(data)).below < 0.1


def test_rows_on_a_slope_follow_the_ground():
    data = panel_scene(**{"ground.tilt": 20.0}).resolve().data
    days = accumulate(SNOWFALL, SeasonSettings(), 50.0)
    scene = season_scene(
        panel_scene(**{"ground.tilt": 20.0}).resolve(), days, SeasonSettings(rows=TWO, cover="none")
    )
    first, second = panel_edge(scene.data).center, scene.data["obstacles"][0]["shape"]["center"]
    assert second[0] - first[0] == pytest.approx(3.0)
    assert second[1] - first[1] == pytest.approx(-3.0 * np.tan(np.radians(20.0)))
    assert TWO.distances(data)[1] == pytest.approx(3.0 / np.cos(np.radians(20.0)))


@pytest.mark.parametrize(
    ("count", "pitch", "message"),
    [
        (0, 0.0, "rows: 0; allowed: 1 to 20"),
        (3, 0.0, "pitch: missing"),
        (1, 5.0, "pitch: not allowed for a single row"),
        (2, float("nan"), "pitch: nan m"),
    ],
)
def test_impossible_rows_are_refused(count, pitch, message):
    with pytest.raises(InputError, match=message):
        PanelRows(count, pitch)


def test_overlapping_rows_are_refused(tmp_path):
    settings = SeasonSettings(rows=PanelRows(2, 0.1))
    with pytest.raises(InputError, match="the panels overlap below"):
        run_season(SNOWFALL, panel_scene(), tmp_path / "rows", settings=settings)
    assert not (tmp_path / "rows").exists()


def test_overlapping_rows_are_refused_without_a_slide_off_too(tmp_path):
    settings = SeasonSettings(rows=PanelRows(3, 0.01))
    with pytest.raises(InputError, match="the panels overlap below"):
        run_season(SNOWFALL, panel_scene(**{"panel.tilt": 90.0}), tmp_path, settings=settings)


def deep_rows(height):
    """Four deep snowfalls on two low rows: snow stays on the lower one."""
    falls = [
        Weather(2 + n, datetime(2024, 12, 1 + n), 0.3, 100.0, -5.0, adhesion=0.0) for n in range(4)
    ]
    return falls, panel_scene(**{"panel.height": height, "panel.length": 0.8, "slab.length": 0.8})


def test_snow_that_stays_on_a_lower_row_is_a_burial(tmp_path):
    falls, scene = deep_rows(0.1)
    settings = SeasonSettings(rows=PanelRows(2, 1.0), cover="none")
    with pytest.raises(InputError, match="snow stays on a lower row, because the stack"):
        run_season(falls, scene, tmp_path, settings=settings, pictures=False)


def test_a_winter_that_buries_a_lower_row_counts(tmp_path):
    """The season at the low edge cannot go on, so the height lies above it."""
    falls, _ = deep_rows(0.1)
    known = SnowRanges({"friction": (0.5, 0.5), "adhesion": (0.0, 0.0)}, draws=1)
    answer = required_clearance(
        PanelDesign(0.8, 50.0, PanelRows(2, 1.0)), [Winter("2024/25", falls)], [0.1, 3.0],
        tmp_path, ranges=known, settings=SeasonSettings(cover="none"),
    )  # fmt: skip
    assert answer.failed == 0
    assert answer.outcomes[0][0].height == 0.1
    assert answer.outcomes[0][0].contact is not None
    assert 0.1 < answer.required[0] < 3.0
    assert any("snow stays on a lower row" in text for text in answer_text.warnings([answer]))


def test_the_cover_on_a_slope_is_measured_vertically():
    data = panel_scene(**{"ground.tilt": 45.0, "panel.tilt": 60.0}).resolve().data
    bare = clearance(data, np.zeros((0, 2)), 0.0).below
    assert bare - clearance(data, np.zeros((0, 2)), 0.0, cover=0.1).below == pytest.approx(
        0.05 * 2**0.5
    )


def test_snow_over_the_face_of_any_row_is_not_below_it():
    data = panel_scene().resolve().data
    (upper_x, upper_z), (x, z) = panel_ends(data)
    middle = [0.5 * (upper_x + x), 0.5 * (upper_z + z) + 0.05]
    outline = np.array([[2.0, 0.1], middle, [middle[0] + 3.0, middle[1]]])
    assert len(below_panel(data, outline)) == 2
    assert below_panel(data, outline, TWO.distances(data)).tolist() == [[2.0, 0.1]]


def test_a_season_without_slide_offs_does_not_mix_with_those_of_another(tmp_path):
    run_season(SNOWFALL, panel_scene(), tmp_path, pictures=False)
    with pytest.raises(InputError, match="it holds slide-offs, but in this season nothing slides"):
        run_season(SNOWFALL, panel_scene(**{"panel.tilt": 20.0}), tmp_path, resume=True)


def test_the_notes_of_a_fence_say_that_no_snow_lies_on_it(tmp_path):
    fence = panel_scene(**{"panel.tilt": 90.0, "panel.height": 1.0})
    notes = run_season(SNOWFALL, fence, tmp_path, pictures=False).notes
    assert any("no snow lies on the panel, because it is vertical" in note for note in notes)
    assert not any("friction and adhesion held it" in note for note in notes)


def test_no_snow_lies_on_a_fence():
    day = accumulate(SNOWFALL, SeasonSettings(), 90.0)[0]
    assert (day.load, day.released) == (0.0, False)


def test_a_fence_needs_the_height_of_the_natural_cover(tmp_path):
    winters = split_winters(EXAMPLE_CLIMATE.winters(5, seed=3))
    answer = required_clearance(
        PanelDesign(2.0, 90.0), winters, [1.0, 3.0], tmp_path, ranges=SnowRanges(draws=1)
    )
    parts = [answer.height_parts(index) for index in range(5)]
    assert all(part.pile == pytest.approx(0.0, abs=1e-6) for part in parts)
    assert all(part.cover > 0.2 for part in parts)
    texts = [*answer_text.warnings([answer]), *answer_text.assumptions(answer)]
    assert not any("grid" in text.lower() or "draws" in text for text in texts)
