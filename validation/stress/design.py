"""Samples of the parameter space: single parameters, pairs, and random combinations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from snowshed.base.extras import require
from validation.stress.space import PARAMETERS, Point, Value, reference

#: Number of random combinations in the full suite.
FULL_RANDOM = 3000


@dataclass(frozen=True)
class Trial:
    """One run of the suite.

    Parameters
    ----------
    design:
        ``"reference"``, ``"single"``, ``"pairwise"`` or ``"random"``.
    varied:
        Text for the parameter that differs from the reference; empty unless exactly one differs.
    point:
        Values of the parameters.
    steps:
        Planned number of steps of each event, in steps of the initial length.
    """

    design: str
    varied: str
    point: Point
    steps: int


def trials(full: bool, seed: int = 1) -> list[Trial]:
    """Return the runs of the quick or the full suite, in the order in which they are made.

    Examples
    --------
    >>> trials(full=False)[0].design
    'reference'
    """
    if full:
        plan = [*_singles(6000), *_pairwise(2000), *_random(FULL_RANDOM, seed, 400)]
    else:
        plan = [*_singles(400), *_pairwise(250), *_random(40, seed, 250)]
    return plan


def _singles(steps: int) -> Iterator[Trial]:
    """Yield the reference scene, then scenes with one parameter at an extreme.

    Parameters without effect in the reference scene (those of a thrown block) are varied in a scene
    in which they have one.
    """
    base = reference()
    yield Trial("reference", "", base, steps)
    for parameter in PARAMETERS:
        for level in parameter.levels[1:]:
            yield Trial("single", parameter.name, {**base, parameter.name: level}, steps)
    for kind in ("throw", "plate", "collide", "coincident", "single"):
        for speed in (0.1, 100.0):
            point = {**base, "kind": kind, "speed": speed}
            yield Trial("single", "speed", point, steps)


def _pairwise(steps: int) -> Iterator[Trial]:
    """Yield a covering array: every pair of levels of any two parameters occurs in some run.

    Raises
    ------
    InputError
        If `allpairspy` is not installed.
    """
    all_pairs = require("allpairspy", "validation", "the stress suite").AllPairs
    for row in all_pairs([list(p.levels) for p in PARAMETERS]):
        point = {p.name: value for p, value in zip(PARAMETERS, row)}
        yield Trial("pairwise", "", point, steps)


def _random(count: int, seed: int, steps: int) -> Iterator[Trial]:
    random = np.random.default_rng(seed)
    for _ in range(count):
        point: dict[str, Value] = {p.name: p.draw(random) for p in PARAMETERS}
        yield Trial("random", "", point, steps)
