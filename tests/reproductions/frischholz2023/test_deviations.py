"""The preset ``thesis``: each deviation sets only the values that its sentences name."""

import json

import pytest
from reproductions.frischholz2023.deviations import (
    DEVIATIONS,
    deviating_settings,
    deviating_trimming,
    deviations_named,
)
from reproductions.frischholz2023.studies import deviating_panels

from snowshed import InputError, Scene
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, TRIMMINGS
from snowshed.study.table import value_at


def test_the_preset_has_the_printed_settings():
    scene = Scene.preset("geometry").update(deviating_settings(5)).resolve().data
    printed = {
        "panel.condition": "slip",
        "numerics.transfer": "flip",
        "numerics.flip_ratio": 0.99,
        "numerics.dx": 0.01,
        "events.between": "reseed",
    }
    assert {path: value_at(scene, path) for path in printed} == printed
    assert printed.items() <= deviating_settings(5).items()  # independent of presets
    assert deviating_trimming() == "equal_pace" != DEFAULT_TRIMMING
    assert deviating_trimming(["slip"]) == deviating_trimming([]) == DEFAULT_TRIMMING


@pytest.mark.parametrize(("chapter", "seconds"), [(3, 2.0833), (4, 2.5), (5, 4.1667)])
def test_events_end_at_the_last_frame_of_each_chapter(chapter, seconds):
    settings = deviating_settings(chapter, ["frames"])
    assert settings == {"events.max_time": pytest.approx(seconds, abs=1e-4)}


@pytest.mark.parametrize("name", DEVIATIONS)
def test_a_single_deviation_changes_only_its_settings(name):
    deviation = DEVIATIONS[name]
    assert (
        deviation.thesis.endswith(".")
        and deviation.here.endswith(".")
        and deviation.reason.endswith(".")
    )
    assert deviation.trimming is None or deviation.trimming in TRIMMINGS
    everything = deviating_settings(5)
    alone = deviating_settings(5, [name])
    assert alone.items() <= everything.items()
    others = deviating_settings(5, [key for key in DEVIATIONS if key != name])
    assert set(alone).isdisjoint(others) and {**alone, **others} == everything
    assert bool(alone) == deviation.simulated


def test_unknown_deviations_and_chapters_are_refused():
    with pytest.raises(InputError, match="deviation: 'sleep' is unknown; allowed: slip, damping"):
        deviations_named(["sleep"])
    with pytest.raises(InputError, match="chapter: 2; allowed: 3, 4, 5"):
        deviating_settings(2)


def test_studies_of_panels_take_deviations():
    def scenes(*names):
        study = deviating_panels(names, dx=0.015)
        return study, [json.loads(run.scene) for run in study.runs()]

    study, frames = scenes("frames", "trimming")
    assert study.name == "geometry-carry-frames" and "events.max_time" in study.axes
    assert {scene["events"]["max_time"] for scene in frames} == {100 / 24}
    assert {scene["numerics"]["dx"] for scene in frames} == {0.015} and len(frames) == 122
    study, thesis = scenes("all")
    assert study.name == "geometry-thesis"
    assert {scene["events"]["between"] for scene in thesis} == {"reseed"}
    assert {scene["numerics"]["dx"] for scene in thesis} == {0.01}
    assert {scene["panel"]["condition"] for scene in thesis} == {"slip"}
    assert scenes("reseed")[0].name == "geometry-reseed"
