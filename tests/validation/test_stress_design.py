"""The design of the stress suite: ranges, coverage of pairs, scenes that the core accepts."""

from collections.abc import Callable
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from validation.stress.design import trials
from validation.stress.scenes import build, max_event_duration
from validation.stress.space import KINDS, PARAMETERS, Range, reference

from snowshed import InputError, _core

QUICK = trials(full=False)


def trials_of(design: str) -> list[Any]:
    return [t for t in QUICK if t.design == design]


def test_single_changes_cover_every_extreme_and_choice() -> None:
    levels = {(name, t.point[name]) for t in trials_of("single") for name in t.point}
    assert levels >= {(p.name, level) for p in PARAMETERS for level in p.levels}
    for trial in trials_of("single"):
        changed = [name for name, value in reference().items() if trial.point[name] != value]
        assert set(changed) <= {trial.varied, "kind"}


def test_pairwise_covers_every_pair_of_levels() -> None:
    points = [t.point for t in trials_of("pairwise")]
    for a, b in combinations(PARAMETERS, 2):
        pairs = {(point[a.name], point[b.name]) for point in points}
        assert pairs == {(x, y) for x in a.levels for y in b.levels}


def test_random_points_stay_in_their_ranges_and_spread_evenly() -> None:
    random = np.random.default_rng(3)
    for parameter in PARAMETERS:
        drawn = [parameter.draw(random) for _ in range(400)]
        if not isinstance(parameter, Range):
            assert set(drawn) == set(parameter.levels)
            continue
        values = np.array(drawn, float)
        assert values.min() >= parameter.low and values.max() <= parameter.high
        if parameter.log:
            middle = np.sqrt(parameter.low * parameter.high)
            assert 0.4 < np.mean(values < middle) < 0.6


def test_a_seed_fixes_the_random_points() -> None:
    def drawn(seed: int) -> list[Any]:
        return [t.point for t in trials(full=False, seed=seed) if t.design == "random"]

    assert drawn(1) == drawn(1)
    assert drawn(1) != drawn(2)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_scenes_contain_the_extreme_that_they_test(kind: str, dimension: int) -> None:
    point = {**reference(), "kind": kind, "dimension": dimension, "thickness": 0.3, "speed": 7.0}
    resolved = build(point).resolve()
    simulation = _core.Simulation(resolved.json)
    simulation.begin_event()
    speeds = np.linalg.norm(simulation.velocities(), axis=1)
    assert speeds.max() == pytest.approx(3.5 if kind == "collide" else 7.0, rel=1e-6)
    assert simulation.particle_count < 1500
    if kind == "single":
        assert simulation.particle_count == 1
    if kind == "coincident":
        half = simulation.particle_count // 2
        positions = simulation.positions()
        assert np.array_equal(positions[:half], positions[half:])
    if kind == "plate":
        distance = simulation.obstacle_distance(simulation.positions())
        assert distance.min() > 0


def test_free_flight_ends_before_snow_is_scattered_wide() -> None:
    point = {**reference(), "kind": "collide", "speed": 100.0}
    assert max_event_duration(point) == pytest.approx(50 * 0.06 / 100)


def test_without_allpairspy_the_error_says_what_to_install(
    hide: Callable[[str], None],
) -> None:
    hide("allpairspy")
    with pytest.raises(InputError, match=r'allpairspy.*pip install "snowshed\[validation\]"'):
        trials(full=False)
