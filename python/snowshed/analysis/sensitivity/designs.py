"""The studies of chapter 3."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Optional

from snowshed._core import InputError
from snowshed.analysis.sensitivity.parameter_values import GROUPS, PAIRS, VALUES
from snowshed.analysis.sensitivity.sampling import SAMPLERS
from snowshed.base.arguments import checked
from snowshed.scene.components import Snow
from snowshed.scene.scene import Scene
from snowshed.study.definition import Study
from snowshed.study.factors import Factor, Part, axis


@dataclass(frozen=True)
class Size:
    """The size of a study of one method.

    Attributes
    ----------
    seeds
        Random seeds per point, for methods that repeat points.
    samples
        Base points (Sobol) or trajectories (Morris).
    """

    seeds: int = 1
    samples: int = 0


#: Sizes of full studies.
FULL: Mapping[str, Size] = {
    "s": Size(seeds=4),
    "fixation": Size(seeds=2),
    "sobol": Size(samples=128),
    "morris": Size(samples=20),
}
#: Sizes of trials.
QUICK: Mapping[str, Size] = {
    "s": Size(seeds=3),
    "fixation": Size(seeds=2),
    "sobol": Size(samples=8),
    "morris": Size(samples=4),
}
METHODS = tuple(FULL)
#: Descriptions of the studies, for readers of their files.
DESCRIPTIONS: Mapping[str, str] = {
    "s": "Single-parameter variation, section 3.3: nominal and altered values of Table 3.3.1, all "
    "other parameters at the reference values of Table 3.2.1.",
    "fixation": "Single-parameter fixation, section 3.4: the values of Table 3.2.1. Parameters of "
    "the yield criterion vary with the hardening law at its reference, and the other way round.",
    "sobol": "{count} base points of Sobol's sequence, arranged after Saltelli, in the ranges of "
    "Table 3.2.1. The order of the points is the design.",
    "morris": "{count} trajectories after Morris on a grid of 4 levels, in the ranges of Table "
    "3.2.1. The order of the points is the design.",
}
#: Settings of Table 3.2.1, and of a trial.
FULL_SCENE: Mapping[str, object] = {"dimension": 3, "events.count": 3, "numerics.dx": 0.01}
QUICK_SCENE: Mapping[str, object] = {"dimension": 2, "events.count": 2, "numerics.dx": 0.03}


@checked
def sensitivity_study(
    method: str = "s",
    *,
    quick: bool = False,
    seeds: Optional[int] = None,
    samples: Optional[int] = None,
) -> Study:
    """Return the study of one method of sensitivity analysis.

    Parameters
    ----------
    method
        "s": single-parameter variation (3.3); "fixation": single-parameter fixation (3.4);
        "sobol" or "morris": a sample of the same ranges.
    quick
        Whether to use 2D, a coarse grid and two events, for a trial whose numbers are not
        meaningful.
    seeds
        Random seeds per point, for "s" and "fixation".
    samples
        Base points of "sobol" (a power of two), trajectories of "morris".

    Raises
    ------
    InputError
        If the method is unknown, or a number is out of its range or not used by this method.

    Examples
    --------
    >>> len(sensitivity_study("fixation", seeds=1).runs())  # 27 + 9, with the reference in both
    35
    """
    if method not in METHODS:
        raise InputError(f"method: {method!r} is unknown; allowed: {', '.join(METHODS)}")
    size = (QUICK if quick else FULL)[method]
    sampled = method in SAMPLERS
    if sampled and seeds is not None:
        raise InputError(f"seeds: not for {method}, where the seed is one of the inputs")
    if not sampled and samples is not None:
        raise InputError(f"samples: not for {method}, whose points are those of the thesis")
    seeds = _positive_or_default("seeds", seeds, size.seeds)
    samples = _positive_or_default("samples", samples, size.samples)
    scene = Scene.preset("sensitivity").update({"snow": Snow.preset("reference").to_data()})
    return Study(
        scene.update(QUICK_SCENE if quick else FULL_SCENE),
        _parts(method, samples),
        f"sensitivity-{method}{'-quick' if quick else ''}",
        None if sampled else range(1, seeds + 1),
        DESCRIPTIONS[method].format(count=samples),
    )


def _parts(method: str, samples: int) -> list[Part]:
    if method in SAMPLERS:
        return [[Factor(SAMPLERS[method](samples))]]
    if method == "s":
        return [[axis(path, values)] for path, values in PAIRS.items()]
    return [[axis(path, VALUES[path]) for path in group] for group in GROUPS.values()]


def _positive_or_default(name: str, given: Optional[int], default: int) -> int:
    if given is not None and given < 1:
        raise InputError(f"{name}: {given} is not positive")
    return default if given is None else given
