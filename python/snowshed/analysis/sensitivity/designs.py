"""The studies of chapter 3, as study files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Optional

from snowshed._core import InputError
from snowshed.analysis.sensitivity.sampling import SAMPLERS
from snowshed.study.template import filled


@dataclass(frozen=True)
class Size:
    """How large a study of one method is.

    Attributes
    ----------
    seeds
        Seedings of each point, where they are repeated.
    samples
        Base points (Sobol) or trajectories (Morris).
    """

    seeds: int = 1
    samples: int = 0


#: Runs enough for numbers that mean something.
FULL: Mapping[str, Size] = {
    "s": Size(seeds=4),
    "fixation": Size(seeds=2),
    "sobol": Size(samples=128),
    "morris": Size(samples=20),
}
#: Runs that show the way.
QUICK: Mapping[str, Size] = {
    "s": Size(seeds=3),
    "fixation": Size(seeds=2),
    "sobol": Size(samples=8),
    "morris": Size(samples=4),
}
METHODS = tuple(FULL)
DESIGNS = {
    "sobol": "{count} base points of Sobol's sequence, arranged after Saltelli",
    "morris": "{count} trajectories after Morris on a grid of 4 levels",
}
#: Dimension, grid size in m, and events, as Table 3.2.1 has them and for a trial.
FULL_SCENE = {"dimension": "3", "dx": "0.01", "events": "3"}
QUICK_SCENE = {"dimension": "2", "dx": "0.03", "events": "2"}


def sensitivity_study(
    method: str = "s",
    *,
    quick: bool = False,
    seeds: Optional[int] = None,
    samples: Optional[int] = None,
) -> str:
    """Return the study file of one method of sensitivity analysis.

    Parameters
    ----------
    method
        "s": single-parameter variation (3.3); "fixation": single-parameter fixation (3.4);
        "sobol" or "morris": a sample of the same ranges.
    quick
        Whether in 2D on a coarse grid with two events, to see the way; its numbers mean little.
    seeds
        Seedings of each point, for "s" and "fixation".
    samples
        Base points of "sobol" (a power of two), trajectories of "morris".

    Raises
    ------
    InputError
        If the method is unknown, or a number is out of its range or not for this method.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from pathlib import Path
    >>> from snowshed.study import Study
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "study.toml"
    ...     _ = file.write_text(sensitivity_study("fixation", seeds=1), encoding="utf-8")
    ...     len(Study.load(file).runs())  # 27 + 9, with the reference in both
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
    seeds = _checked("seeds", seeds, size.seeds)
    samples = _checked("samples", samples, size.samples)
    values = dict(QUICK_SCENE if quick else FULL_SCENE)
    values["name"] = f"sensitivity-{method}{'-quick' if quick else ''}"
    values["seeds"] = str(seeds)
    if sampled:
        values["design"] = DESIGNS[method].format(count=samples)
        values["points"] = _points(SAMPLERS[method](samples))
    return filled("snowshed.analysis.sensitivity", "sampled" if sampled else method, values)


def _checked(name: str, given: Optional[int], default: int) -> int:
    if given is not None and given < 1:
        raise InputError(f"{name}: {given} is not positive")
    return default if given is None else given


def _points(columns: Mapping[str, list[float]]) -> str:
    """Return the columns of a sample as TOML."""
    return "\n".join(f"{path} = {values!r}" for path, values in columns.items())
