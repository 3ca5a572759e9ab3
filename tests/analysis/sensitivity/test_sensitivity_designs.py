"""The studies of chapter 3: numbers of runs, and their values."""

import json

import numpy as np
import pytest
from synthetic_studies import BETA, P0, REFERENCE, SEED, XI, E, M

from snowshed import InputError
from snowshed.analysis.sensitivity import sensitivity_study


def design_scenes(method, **options):
    return [json.loads(run.scene) for run in sensitivity_study(method, **options).runs()]


def value(scene, path):
    group, name = path.split(".")
    return scene[group][name]


def changed(scenes):
    """Return, scene by scene, the values that differ from the reference snow."""
    return [
        {path: value(scene, path) for path in REFERENCE if value(scene, path) != REFERENCE[path]}
        for scene in scenes
    ]


def test_single_parameter_variation_is_table_3_3_1():
    scenes = design_scenes("s", seeds=1)
    pairs = {M: (0.3, 0.6), P0: (3e3, 6e3), BETA: (0.15, 0.3), XI: (0.1, 0.2), E: (1e6, 2e6)}
    expected = {(path, number) for path, values in pairs.items() for number in values} - set(
        REFERENCE.items()
    )
    changes = changed(scenes)
    assert {item for change in changes for item in change.items()} == expected
    assert changes.count({}) == 1 and all(len(change) <= 1 for change in changes)
    assert len(scenes) == 9


def test_fixation_is_table_3_2_1():
    scenes = design_scenes("fixation", seeds=1)
    changes = changed(scenes)
    yielding = [change for change in changes if not change.keys() & {XI, E}]
    hardening = [change for change in changes if not change.keys() & {M, P0, BETA}]
    assert (len(yielding), len(hardening), len(scenes)) == (27, 9, 35)
    assert {value(scene, P0) for scene in scenes} == {2e3, 5e3, 8e3}
    for scene in scenes:
        assert scene["dimension"] == 3 and scene["numerics"]["dx"] == 0.01
        assert scene["panel"]["height"] == 0.5 and scene["panel"]["tilt"] == 40
        assert scene["events"]["count"] == 3


@pytest.mark.parametrize(("method", "size"), [("sobol", 8), ("morris", 7)])
def test_samples_stay_in_the_ranges_and_blocks_have_two_seeds(method, size):
    scenes = design_scenes(method, quick=True, samples=4)
    assert len(scenes) == 4 * size
    for path, (low, high) in {
        M: (0.3, 0.7), P0: (2e3, 8e3), BETA: (0.1, 0.3), XI: (0.1, 1.0), E: (1e6, 3e6)
    }.items():  # fmt: skip
        values = np.array([value(scene, path) for scene in scenes])
        assert values.min() >= low and values.max() <= high and np.ptp(values) > 0
    seeds = np.array([value(scene, SEED) for scene in scenes]).reshape(4, size)
    assert [set(block) for block in seeds] == [{1, 2}, {3, 4}, {5, 6}, {7, 8}]


def test_arguments_of_other_methods_are_refused():
    for arguments, message in (
        ({"method": "guess"}, "method: 'guess' is unknown; allowed: s, fixation, sobol, morris"),
        ({"method": "s", "seeds": 0}, "seeds: 0 is not positive"),
        ({"method": "s", "samples": 4}, "samples: not for s"),
        ({"method": "sobol", "seeds": 2}, "seeds: not for sobol"),
        ({"method": "sobol", "samples": 6}, "samples: 6 is not a power of two"),
    ):
        with pytest.raises(InputError, match=message):
            sensitivity_study(**arguments)
