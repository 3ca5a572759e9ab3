"""Pressed faces of the moving view: levels, corners, and the events that fit."""

import numpy as np
import pytest

from snowshed.plot import pressed_faces
from snowshed.plot.pressed_faces import pressure_picture
from snowshed.plot.solids import Solid


def lines(*pressures):
    x = np.arange(len(pressures) + 1.0)
    ends = np.stack([x, 0.0 * x, 0.0 * x], axis=1)
    return {
        "corners": np.stack([ends[:-1], ends[1:]], axis=1),
        "obstacle": np.array(["wall"] * len(pressures)),
        "area": np.ones(len(pressures)),
        "peak_pressure": np.array(pressures, dtype=float),
    }


def test_each_face_has_the_colour_of_its_pressure():
    picture = pressure_picture([(1, lines(0.0, 100.0, 2950.0, 3000.0))], [], size=10.0)
    levels = {faces.level: faces.solid.corners[:, 0] for faces in picture.faces}
    assert sorted(levels) == [0, 5]  # the first face is not pressed
    assert (levels[0].min(), levels[0].max()) == (1.0, 2.0)
    assert (levels[5].min(), levels[5].max()) == (2.0, 4.0)
    assert picture.data["labels"][-1] == "2.5 to 3"


def test_lines_become_bands_about_the_face():
    (faces,) = pressure_picture([(1, lines(5.0))], [], size=10.0).faces
    assert np.ptp(faces.solid.corners[:, 2]) == pytest.approx(0.08)
    assert faces.solid.corners[:, 2].mean() == pytest.approx(0.0)


def test_faces_move_with_their_obstacle():
    motion = {"velocity": [1, 0, 0]}
    wall = Solid("wall", "solid", np.zeros((3, 3)), np.array([[0, 1, 2]]), motion)
    (faces,) = pressure_picture([(1, lines(5.0))], [wall], size=1.0).faces
    assert faces.solid.motion is motion


def test_earlier_events_are_left_out_of_large_pages_and_named(monkeypatch):
    monkeypatch.setattr(pressed_faces, "MAX_FACES", 4)
    picture = pressure_picture([(event, lines(1, 2)) for event in (3, 2, 1)], [], size=1.0)
    assert {faces.event for faces in picture.faces} == {3, 2}
    assert picture.notes == ["The pressures before event 2 are not in this view."]


def test_snow_that_touches_nothing_has_no_picture():
    assert pressure_picture([(1, lines(0.0, 0.0))], [], size=1.0) is None
    assert pressure_picture([], [], size=1.0) is None
