"""Questions inside the data, and the objections to all others."""

import numpy as np
import pytest
from synthetic_rows import thesis_inputs

from snowshed.analysis.regression.domain import DataDomain

DOMAIN = DataDomain(thesis_inputs())


@pytest.mark.parametrize(
    "panel",
    [(2, 2, 40), (1, 10, 40), (4, 8, 70), (2.5, 6, 55), (3.3, 0.9, 68), (1.2, 1, 40.5), (2, 9, 44)],
)
def test_questions_inside_the_data_have_no_objections(panel):
    assert DOMAIN.objections(np.array([3, *panel])) == []


@pytest.mark.parametrize(
    ("question", "message"),
    [
        ((5, 4.5, 2, 40), "panel height 4.5 m is outside the data, which reach from 1 to 4 m"),
        ((6, 2, 2, 40), "event 6 is outside the data, which reach from 1 to 5"),
        ((5, 2, 2, 30), "panel tilt 30° is outside the data"),
        ((5, 1, 10, 70), "not together: panel height 1 m, panel length 10 m, panel tilt 70"),
        ((5, 3, 9, 60), "the nearest panel in the data has panel height 3 m, panel length 8 m"),
    ],
)
def test_questions_outside_the_data_have_an_objection(question, message):
    (objection,) = DOMAIN.objections(np.array(question, float))
    assert message in objection


def test_many_events_outside_the_data_have_one_objection():
    questions = np.column_stack([np.arange(1, 51), np.tile([2, 2, 40], (50, 1))])
    assert DOMAIN.objections(questions) == [
        "event 6 to 50 is outside the data, which reach from 1 to 5"
    ]


def test_every_exceeded_range_is_named():
    assert len(DOMAIN.objections(np.array([9, 9, 99, 89]))) == 4


def test_every_row_is_inside_its_data():
    for row in DOMAIN.inputs[::7]:
        assert DOMAIN.objections(row) == []


def test_the_hull_agrees_with_a_triangulation():
    """Random questions, against Delaunay's simplices of the panels."""
    from scipy.spatial import Delaunay

    rng = np.random.default_rng(0)
    panels = np.unique(DOMAIN.inputs[:, 1:], axis=0)
    questions = rng.uniform(panels.min(axis=0), panels.max(axis=0), (60, 3))
    inside = Delaunay(panels).find_simplex(questions) >= 0
    assert 10 < inside.sum() < 50
    for question, expected in zip(questions, inside):
        objections = DOMAIN.objections(np.array([1, *question]))
        assert (not objections) == expected


def test_a_gap_between_two_clusters_is_outside():
    clusters = np.array([[1, h, 1, 40] for h in (1, 1.1, 1.2, 5, 5.1, 5.2)], float)
    (objection,) = DataDomain(clusters).objections(np.array([1, 3, 1, 40.0]))
    assert "is in a gap of the data" in objection


def test_a_constant_input_must_keep_its_value():
    flat = DataDomain(np.array([[1, h, 1, 40] for h in (1, 2, 3)], float))
    assert flat.objections(np.array([1, 1.5, 1, 40.0])) == []
    (objection,) = flat.objections(np.array([1, 1.5, 1, 41.0]))
    assert objection.endswith("panel tilt 41° is outside the data, which have 40° only")


def test_a_remote_panel_does_not_fill_the_gap():
    lengths = (*np.arange(0.5, 1.6, 0.1), 10)
    domain = DataDomain(np.array([[1, 2, length, 40] for length in lengths], float))
    assert domain.objections(np.array([1, 2, 1.55, 40])) == []
    for length in (3, 5, 8):
        (objection,) = domain.objections(np.array([1, 2, length, 40]))
        assert "in a gap of the data" in objection


def test_an_event_is_judged_by_the_panels_that_have_it():
    """Runs may end early: only one of nine panels has a third event."""
    panels = [(h, length, 40) for h in (1, 2, 3) for length in (1, 2, 3)]
    rows = [(event, *panel) for panel in panels for event in (1, 2)]
    domain = DataDomain(np.array([*rows, (3, *panels[0])], float))
    assert domain.objections(np.array([2, 2.5, 2.5, 40])) == []
    assert domain.objections(np.array([3, 1, 1, 40])) == []
    questions = np.array([[event, 2.5, 2.5, 40] for event in (1, 2, 3)])
    (objection,) = domain.objections(questions)
    assert "only 1 of 9 panels have event 3; the nearest panel" in objection
