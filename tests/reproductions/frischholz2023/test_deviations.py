"""The preset ``thesis``: each deviation sets the values that its sentences name, and no others."""

import json

import pytest
from reproductions.frischholz2023.deviations import (
    DEVIATIONS,
    deviating_settings,
    deviating_trimming,
)

from snowshed import InputError, Scene
from snowshed.analysis import geometry_study
from snowshed.analysis.regression import deviations as package
from snowshed.analysis.regression.deviations import deviations_named
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, TRIMMINGS
from snowshed.study.table import value_at


def test_the_preset_is_what_the_thesis_prints():
    scene = Scene.preset("geometry").update(deviating_settings(5)).resolve().data
    printed = {
        "panel.condition": "slip",
        "numerics.transfer": "flip",
        "numerics.flip_ratio": 0.99,
        "numerics.dx": 0.01,
        "events.between": "reseed",
    }
    assert {path: value_at(scene, path) for path in printed} == printed
    assert printed.items() <= deviating_settings(5).items()  # whatever the presets have
    assert deviating_trimming() == "equal_pace" != DEFAULT_TRIMMING
    assert deviating_trimming(["slip"]) == deviating_trimming([]) == DEFAULT_TRIMMING


@pytest.mark.parametrize(("chapter", "seconds"), [(3, 2.0833), (4, 2.5), (5, 4.1667)])
def test_events_are_cut_at_the_frames_of_each_chapter(chapter, seconds):
    settings = deviating_settings(chapter, ["frames"])
    assert settings == {"events.max_time": pytest.approx(seconds, abs=1e-4)}


def test_the_package_offers_the_same_deviations_with_the_settings_of_panels():
    assert list(package.DEVIATIONS) == list(DEVIATIONS)
    assert package.deviating_settings() == deviating_settings(5)


@pytest.mark.parametrize("name", DEVIATIONS)
def test_each_alone_changes_its_own_settings(name):
    one = DEVIATIONS[name]
    assert one.thesis.endswith(".") and one.here.endswith(".") and one.reason.endswith(".")
    assert one.trimming is None or one.trimming in TRIMMINGS
    everything = deviating_settings(5)
    alone = deviating_settings(5, [name])
    assert alone.items() <= everything.items()
    others = deviating_settings(5, [other for other in DEVIATIONS if other != name])
    assert set(alone).isdisjoint(others) and {**alone, **others} == everything
    assert bool(alone) == one.simulated


def test_what_is_unknown_is_refused():
    with pytest.raises(InputError, match="deviation: 'sleep' is unknown; allowed: slip, damping"):
        deviations_named(["sleep"])
    with pytest.raises(InputError, match="chapter: 2; allowed: 3, 4, 5"):
        deviating_settings(2)


def test_the_data_set_of_panels_with_deviations():
    def scenes(*names):
        study = geometry_study("carry", dx=0.015, deviations=names)
        return study, [json.loads(run.scene) for run in study.runs()]

    study, frames = scenes("frames", "trimming")
    assert study.name == "geometry-carry-frames" and "events.max_time" in study.axes
    assert {one["events"]["max_time"] for one in frames} == {100 / 24}
    assert {one["numerics"]["dx"] for one in frames} == {0.015} and len(frames) == 122
    study, thesis = scenes("all")
    assert study.name == "geometry-thesis"
    assert {one["events"]["between"] for one in thesis} == {"reseed"}
    assert {one["numerics"]["dx"] for one in thesis} == {0.01}
    assert {one["panel"]["condition"] for one in thesis} == {"slip"}
    assert scenes("reseed")[0].name == "geometry-reseed"
