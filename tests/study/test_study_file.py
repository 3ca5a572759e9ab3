"""Study files: their meaning, and messages on errors."""

import json
import re

import numpy as np
import pytest
from study_helpers import tiny_scene

from snowshed import InputError
from snowshed.study import Study
from snowshed.study.study_file import TEMPLATE
from snowshed.study.table import value_at

SCENE = """
dimension = 2
events = 1
[scene]
preset = "lab-50"
[accuracy]
dx = 0.02
"""


@pytest.fixture
def load(tmp_path):
    def loaded(text):
        file = tmp_path / "study.toml"
        file.write_text(text)
        return Study.load(file)

    return loaded


def values(study, *paths):
    scenes = [json.loads(run.scene) for run in study.runs()]
    return [tuple(value_at(scene, path) for path in paths) for scene in scenes]


def test_the_template_has_its_axes_and_settings(load):
    study = load(TEMPLATE)
    assert study.name == "cohesion-and-slope"
    assert study.axes == ["snow.cohesion", "snow.critical_state_slope"]
    expected = [
        (cohesion, slope, seed)
        for cohesion in (0.1, 0.2, 0.3)
        for slope in (0.3, 0.5, 0.7)
        for seed in (1, 2)
    ]
    assert values(study, "snow.cohesion", "snow.critical_state_slope", "seeding.seed") == expected
    settings = ("dimension", "events.count", "panel.friction", "numerics.dx", "panel.height")
    assert set(values(study, *settings)) == {(2, 3, 0.2, 0.02, 0.5)}


def test_commented_lines_of_the_template_are_valid(load):
    code = re.sub(r"^# (?=\[|[a-z_.]+ = )", "", TEMPLATE, flags=re.MULTILINE)
    code = code.replace("[0.1, 0.2, 0.3]", "[0.1]").replace("seeds = 2", "seeds = 1")
    study = load(code.replace("count = 20", "count = 2").replace('file = "', '# file = "'))
    cohesion, slope, modulus, zipped, sample = 1, 3, 3, 2, 2
    common = [cohesion, slope, modulus, zipped, sample]
    assert [[len(factor) for factor in part] for part in study.parts] == [
        [*common, 1],
        [*common, 2],
    ]


def test_the_name_defaults_to_that_of_the_file(load):
    assert load(SCENE).name == "study"
    assert load('name = "other"' + SCENE).name == "other"


def test_axes_of_all_forms(load):
    study = load(
        SCENE
        + """
        [axes]
        panel.tilt = { from = 40, to = 60, step = 10 }
        snow.youngs_modulus = { from = 1e5, to = 1e7, count = 3, scale = "log" }
        "snow.cohesion" = [0.1]
        events.between = "reseed"
        """
    )
    paths = ("panel.tilt", "snow.youngs_modulus", "snow.cohesion", "events.between")
    assert values(study, *paths) == [
        (tilt, modulus, 0.1, "reseed") for tilt in (40, 50, 60) for modulus in (1e5, 1e6, 1e7)
    ]


def test_parameters_with_names_of_range_keys_may_be_nested(load):
    study = load(SCENE + "[axes]\nevents = { count = [1, 3] }\npanel.tilt = 40")
    assert values(study, "events.count") == [(1,), (3,)]


def test_zipped_groups_and_samples_are_crossed_with_axes(load):
    study = load(
        SCENE
        + """
        [axes]
        panel.tilt = [40, 50]
        [[zip]]
        panel.height = [1.0, 2.0]
        panel.length = [3.0, 4.0]
        [[sample]]
        method = "sobol"
        count = 4
        [sample.axes]
        panel.friction = { from = 0.1, to = 0.3 }
        snow.density = { from = 100, to = 400, scale = "log" }
        """
    )
    assert len(study.runs()) == 2 * 2 * 4
    assert set(values(study, "panel.height", "panel.length")) == {(1, 3), (2, 4)}
    sampled = set(values(study, "panel.friction", "snow.density"))
    assert len(sampled) == 4
    assert all(0.1 <= friction <= 0.3 and 100 <= density <= 400 for friction, density in sampled)


def test_parts_are_united_and_crossed_with_common_axes(load):
    study = load(
        SCENE
        + """
        [axes]
        panel.friction = [0.1, 0.2]
        [[part]]
        axes.panel.tilt = 40
        [[part]]
        axes.panel.tilt = [50, 60]
        axes.panel.height = [1.0]
        """
    )
    assert values(study, "panel.friction", "panel.tilt", "panel.height") == [
        (0.1, 40, 0.33),
        (0.2, 40, 0.33),
        (0.1, 50, 1),
        (0.1, 60, 1),
        (0.2, 50, 1),
        (0.2, 60, 1),
    ]


def test_seeds_are_a_count_or_a_list(load):
    assert values(load("seeds = 3" + SCENE), "seeding.seed") == [(1,), (2,), (3,)]
    assert values(load("seeds = [7, 3]" + SCENE), "seeding.seed") == [(7,), (3,)]
    assert values(load(SCENE), "seeding.seed") == [(1,)]


def test_later_sources_of_the_scene_override_earlier_ones(load, tmp_path):
    (tmp_path / "part.json").write_text(
        '{"panel": {"tilt": 33, "friction": 0.11}, "snow": {"cohesion": 0.3, "density": 99}}'
    )
    study = load(
        """
        dimension = 2
        [scene]
        preset = "lab-40"
        file = "part.json"
        snow_preset = "reference"
        panel.friction = 0.12
        numerics.dx = 0.03
        [accuracy]
        dx = 0.02
        """
    )
    paths = ("panel.height", "panel.tilt", "panel.friction", "snow.cohesion", "numerics.dx")
    assert values(study, *paths) == [(0.33, 33, 0.12, 0.1, 0.02)]


def test_paths_are_relative_to_the_file_that_contains_them(load, tmp_path):
    for folder in ("", "other"):
        (tmp_path / folder).mkdir(exist_ok=True)
        np.save(tmp_path / folder / "grid.npy", np.ones((3, 3)))
    shape = {"type": "grid", "file": "grid.npy", "origin": [3, 0], "spacing": 0.1}
    scene = tiny_scene().to_data() | {"obstacles": [{"shape": shape}]}
    (tmp_path / "other" / "scene.json").write_text(json.dumps(scene))
    from_scene_file = load('[scene]\nfile = "other/scene.json"')
    assert values(from_scene_file, "obstacles.0.shape.file") == [
        (str(tmp_path / "other" / "grid.npy"),)
    ]
    inline = load(
        SCENE.replace(
            "[accuracy]",
            'obstacles = [{ shape = { type = "grid", origin = [3, 0], spacing = 0.1 } }]\n'
            "[axes]\n"
            '"obstacles.0.shape.file" = ["grid.npy", "other/grid.npy"]\n[accuracy]',
        )
    )
    # Both files have the same content, so they give the same run.
    assert values(inline, "obstacles.0.shape.file") == [(str(tmp_path / "grid.npy"),)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("seeds = ", "not TOML: Invalid value"),
        ("seeds 3\n" + SCENE, "not TOML: .*line 1, column 7"),
        ("sedes = 3" + SCENE, "sedes: unknown key; allowed: name, scene"),
        ("events = 1", "scene: missing"),
        ("scene = 3", r"scene: 3 is not a table; write \[scene\]"),
        ('[scene]\npreset = "lab-60"', 'scene: preset: "lab-60" is none of "lab-40"'),
        ("[scene]\npreset = 60", "scene.preset: 60 is not a text"),
        ('[scene]\nsnow_preset = "wet"', '"wet" is none of "calibrated"'),
        ("[scene]\npanel.tlt = 3", "scene: /panel/tlt: unknown key; allowed: height"),
        ("events = 2.5" + SCENE.replace("events = 1", ""), "events: 2.5 is not a whole number"),
        ("seeds = 0" + SCENE, "seeds: 0 is neither"),
        ("seeds = true" + SCENE, "seeds: True is neither"),
        ("seeds = [1.5]" + SCENE, "seeds: .1.5. is neither"),
        (SCENE + "threads = 3", "accuracy.threads: unknown key; allowed: dx"),
        (SCENE + "[axes]\npanel.tlt = [1]", "panel.tlt: /panel/tlt: unknown key; allowed: height"),
        (SCENE + "[axes]\npanel.tilt = []", "axes: panel.tilt: 0 values"),
        (SCENE + "[axes]\npanel.tilt = [40, 95]", "panel.tilt = 95: /panel/tilt: 95 is outside"),
        (SCENE + '[axes]\npanel.tilt = ["a"]', "panel.tilt = 'a': /panel/tilt"),
        (SCENE + "[axes]\npanel.tilt = { from = 1 }", "axes.panel.tilt.to: missing"),
        (SCENE + "[axes]\npanel.tilt = { from = 1, to = 2 }", "panel.tilt: needs either a step"),
        (
            SCENE + "[axes]\npanel.tilt = { from = 1, till = 2 }",
            "axes.panel.tilt.till: unknown key; allowed: from, to, step, count, scale",
        ),
        (SCENE + '[axes]\npanel.tilt = { from = 1, to = "b" }', "panel.tilt.to: 'b' is not a num"),
        (
            SCENE + '[axes]\npanel.tilt = { from = 1, to = 2, step = 1, scale = "log" }',
            "panel.tilt: a logarithmic range needs a count",
        ),
        (
            SCENE + '[axes]\npanel.tilt = { from = 1, to = 2, count = 3, scale = "lg" }',
            "panel.tilt.scale: 'lg' is unknown; allowed: linear, log",
        ),
        (
            SCENE + "[axes]\npanel.tilt = {from=1, to=2, count=2.5}",
            "tilt.count: 2.5 is not a whole",
        ),
        (SCENE + "[zip]\npanel.tilt = [1]", r"zip: not a list of tables; write \[\[zip\]\]"),
        (
            SCENE + "[[zip]]\npanel.tilt = [1]\npanel.height = [1, 2]",
            r"zip\[1\]: parameters that vary together need equally many values",
        ),
        (SCENE + "[[sample]]\ncount = 3", r"sample\[1\]: names no parameter"),
        (SCENE + '[[sample]]\nmethod = "halton"', r"sample\[1\].method: 'halton' is unknown"),
        (SCENE + "[[sample]]\naxes.panel.tilt = 3", r"sample\[1\].count: missing"),
        (
            SCENE + "[[sample]]\ncount = 3\naxes.panel.tilt = [3]",
            r"sample\[1\].axes.panel.tilt: \[3\] is not a range",
        ),
        (
            SCENE + "[[sample]]\ncount = 3\naxes.panel.tilt = {from=1, to=2, step=1}",
            r"sample\[1\].axes.panel.tilt.step: unknown key; allowed: from, to, scale",
        ),
        (
            SCENE + "[[part]]\nseeds = 3",
            r"part\[1\].seeds: unknown key; allowed: axes, zip, sample",
        ),
        (SCENE + "[[part]]\naxes.numerics.threads = 3", "numerics.threads: cannot be varied"),
        ("seeds = 1_000_000_000" + SCENE, "seeds: 1000000000 is neither a number of seeds .1 to"),
        ("seeds = 9" + "9" * 30 + SCENE, "seeds: 9+ is neither"),
        ("seeds = 9" + "9" * 5000 + SCENE, "not TOML: "),
        ("name = " + "[" * 50_000, "not TOML: "),
        (SCENE + "[axes]\n" + ".".join("a" * 3000) + " = 1", "a key of more than 50 parts"),
        (
            SCENE + "[axes]\npanel.tilt = {from=1, to=1" + "0" * 400 + ", count=3}",
            "panel.tilt: 1000.* is not a finite number",
        ),
        (
            SCENE + "[axes]\npanel.tilt = {from=-1e308, to=1e308, step=1}",
            "panel.tilt: has too many values; at most 1000000",
        ),
        (SCENE + "[[sample]]\nmethod = [1]", r"sample\[1\].method: \[1\] is unknown"),
        (
            SCENE + "[[sample]]\ncount = 3\nseed = -1\naxes.panel.tilt = {from=1, to=2}",
            r"sample\[1\]: seed -1 is negative",
        ),
    ],
)
def test_errors_name_file_key_and_allowed_values(load, tmp_path, text, message):
    with pytest.raises(InputError, match=message) as caught:
        load(text)
    assert str(caught.value).startswith(f"{tmp_path / 'study.toml'}: ")
