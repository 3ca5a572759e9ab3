"""The runs of a study."""

import json

import pytest
from study_helpers import tiny_scene, tiny_study

from snowshed import InputError, Scene
from snowshed.study import Factor, Study, axis, linear
from snowshed.study.table import value_at


def values(study, *paths):
    scenes = [json.loads(run.scene) for run in study.runs()]
    return [tuple(value_at(scene, path) for path in paths) for scene in scenes]


def test_the_last_axis_varies_fastest_and_seeds_faster_still():
    study = Study.product(
        tiny_scene(), {"panel.tilt": [40, 50], "snow.cohesion": [0.1, 0.2]}, seeds=[1, 2]
    )
    assert values(study, "panel.tilt", "snow.cohesion", "seeding.seed") == [
        (40, 0.1, 1),
        (40, 0.1, 2),
        (40, 0.2, 1),
        (40, 0.2, 2),
        (50, 0.1, 1),
        (50, 0.1, 2),
        (50, 0.2, 1),
        (50, 0.2, 2),
    ]
    assert study.axes == ["panel.tilt", "snow.cohesion"]


def test_factors_of_several_parameters_are_crossed_with_axes():
    dimensions = Factor({"panel.height": [1, 2], "panel.length": [3, 4]})
    study = Study(tiny_scene(), [[dimensions, axis("panel.tilt", [40, 50])]])
    assert values(study, "panel.height", "panel.length", "panel.tilt") == [
        (1, 3, 40),
        (1, 3, 50),
        (2, 4, 40),
        (2, 4, 50),
    ]


def test_the_union_of_parts_has_every_run_once():
    study = Study(
        tiny_scene(),
        [[axis("panel.tilt", [40, 50])], [axis("panel.tilt", [50, 60]), axis("panel.height", [1])]],
    )
    height = 0.33
    assert values(study, "panel.tilt", "panel.height") == [
        (40, height),
        (50, height),
        (50, 1),
        (60, 1),
    ]
    assert study.axes == ["panel.tilt", "panel.height"]
    twice = Study(tiny_scene(), [[axis("panel.tilt", [40, 50])], [axis("panel.tilt", [50, 60])]])
    assert values(twice, "panel.tilt") == [(40,), (50,), (60,)]


def test_the_geometry_study_of_the_thesis_has_610_rows():
    """Section 5.1: 385 rows at 40 degrees and 225 steeper ones, of five events each."""
    flat = [
        axis("panel.tilt", [40]),
        axis("panel.height", linear(1, 4, step=0.5)),
        axis("panel.length", [0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 6, 8, 10]),
    ]
    steep = [
        axis("panel.tilt", [50, 60, 70]),
        axis("panel.height", [2, 3, 4]),
        axis("panel.length", [0.5, 1.5, 2, 4, 8]),
    ]
    scene = Scene.preset("geometry")
    runs = Study(scene, [flat, steep]).runs()
    assert sum(json.loads(run.scene)["events"]["count"] for run in runs) == 610


def test_a_study_without_factors_runs_its_scene():
    assert values(Study(tiny_scene()), "panel.tilt") == [(50,)]


def test_a_study_does_not_change_its_scene():
    scene = tiny_scene()
    before = scene.to_data()
    Study.product(scene, {"obstacles": [[], []], "panel.tilt": [1, 2]}).runs()
    assert scene.to_data() == before


def test_words_may_vary():
    study = Study.product(tiny_scene(), {"events.between": ["carry", "reseed"]})
    assert values(study, "events.between") == [("carry",), ("reseed",)]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Study.product(tiny_scene(), {"panel.tlt": [1]}), "panel.tlt: /panel/tlt: unknown"),
        (lambda: Study.product(tiny_scene(), {"panel.tilt": []}), "panel.tilt: 0 values"),
        (
            lambda: Study.product(tiny_scene(), {"numerics.threads": [1]}),
            "numerics.threads: cannot",
        ),
        (lambda: Study.product(tiny_scene(), {"output.energy": [True]}), "output.energy: cannot"),
        (
            lambda: Study.product(tiny_scene(), {"seeding.seed": [1]}, seeds=[1]),
            "the study's seeds",
        ),
        (lambda: Study(tiny_scene(), [[axis("panel.tilt", [1]), axis("panel.tilt", [2])]]), "two"),
        (
            lambda: Study.product(tiny_scene(), {"panel.tilt": [40, ["a"]]}),
            r"panel.tilt = \['a'\]: /panel/tilt: \['a'\] is not a number",
        ),
        (lambda: Study.product(tiny_scene(), {"panel.tilt": ["40"]}), "'40' is not a number"),
        (
            lambda: Study.product(tiny_scene(), {"panel.condition": ["slip", "slp"]}),
            "did you mean slip",
        ),
        (lambda: Study(tiny_scene(), []), "no parts"),
        (lambda: tiny_study(name=""), "name: ''"),
        (lambda: tiny_study(name="a\nb"), "printable"),
        (
            lambda: Study.product(tiny_scene(), {"panel.tilt": range(10**6)}, seeds=[1, 2]),
            "2000000",
        ),
    ],
)
def test_wrong_studies_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_a_wrong_value_is_named_with_its_point():
    study = Study.product(tiny_scene(), {"snow.cohesion": [0.1], "panel.tilt": [40, 95]})
    with pytest.raises(InputError, match=r"snow.cohesion = 0.1, panel.tilt = 95: /panel/tilt: 95"):
        study.runs()
