"""The class of a note says what it concerns, so that scripts can filter."""

import warnings

import numpy as np
import pandas as pd
import pytest

from snowshed import (
    InputNote,
    ResolutionNote,
    ResultNote,
    Simulation,
    SnowshedNote,
    Study,
    UnusualValueNote,
    measure_stack,
    run_events,
)
from snowshed.base.notes import issue_note
from snowshed.season import read_season


def classes(action):
    """Return the class of each note by its text."""
    with warnings.catch_warnings(record=True) as log:
        warnings.simplefilter("always")
        action()
    return {str(note.message): note.category for note in log}


def only(notes, words):
    (category,) = {category for text, category in notes.items() if words in text}
    return category


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("panel.tilt", 0.7),
        ("snow.density", 5.0),
        ("snow.youngs_modulus", 1.0),
        ("panel.height", 33),
    ],
)
def test_unlikely_units_of_scenes_have_their_class(tiny, path, value):
    notes = classes(lambda: Simulation(tiny.with_({path: value})))
    about = {text: note for text, note in notes.items() if not text.startswith("the strength is")}
    assert only(about, path.split(".")[1]) is UnusualValueNote
    assert only(classes(lambda: Study.product(tiny, {path: [value]})), path) is UnusualValueNote


def test_unlikely_particles_have_their_class():
    rng = np.random.default_rng(1)
    positions = rng.uniform(0, 1000, (500, 3)) * [1, 0, 1]  # in mm
    masses, densities = np.full(500, 0.4), np.full(500, 200.0)
    notes = classes(lambda: measure_stack(positions, masses, densities, dimension=2, dx=10.0))
    assert only(notes, "in mm or cm?") is UnusualValueNote


def test_coarse_snow_and_results_have_their_classes(tiny, tmp_path):
    coarse = tiny.with_({"numerics.dx": 0.1, "panel.tilt": 5, "panel.friction": 0.9})
    notes = classes(lambda: run_events(coarse, tmp_path / "out", pictures=False))
    assert only(notes, "its stack is coarse") is ResolutionNote
    assert only(notes, "stays on the panel") is ResultNote


def test_tables_have_their_class():
    days = pd.date_range("2024-12-01", periods=3)
    warm = pd.DataFrame({"date": days, "snowfall_m": 0.1, "temperature_c": 25.0})
    notes = classes(lambda: read_season(warm))
    assert notes and set(notes.values()) <= {InputNote, UnusualValueNote}


def test_notes_on_runs_of_a_study_keep_their_class(tiny, tmp_path):
    study = Study.product(tiny.with_({"numerics.dx": 0.1}), {"snow.density": [200.0, 210.0]})
    notes = classes(lambda: study.run(tmp_path / "study", progress=None))
    assert only(notes, "its stack is coarse") is ResolutionNote


def test_one_class_can_be_an_error_while_others_are_silent(tiny):
    with warnings.catch_warnings():
        warnings.simplefilter("error", UnusualValueNote)
        warnings.simplefilter("ignore", ResolutionNote)
        Simulation(tiny.with_({"numerics.dx": 0.1}))
        with pytest.raises(UnusualValueNote, match="tilt"):
            Simulation(tiny.with_({"panel.tilt": 0.7}))


def test_words_decide_before_the_given_class_and_all_are_notes():
    assert only(classes(lambda: issue_note("are they in feet?", InputNote)), "") is UnusualValueNote
    assert only(classes(lambda: issue_note("a.tif: turned", InputNote)), "") is InputNote
    assert only(classes(lambda: issue_note("the snow is red")), "") is SnowshedNote
    for subject in (InputNote, ResolutionNote, ResultNote, UnusualValueNote):
        assert issubclass(subject, SnowshedNote)


def test_a_file_is_in_a_unit_without_a_question():
    notes = classes(
        lambda: issue_note("a.shp: the thickness is that of its field h, in cm", InputNote)
    )
    assert only(notes, "") is InputNote
