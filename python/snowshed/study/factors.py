"""Factors of a study: parameters of a scene, and the values they take together.

A study combines every point of a factor with every point of the others. Parameters that vary
together are one factor.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.messages import shortened
from snowshed.base.notes import InputNote, issue_note

MAX_COUNT = 1_000_000  # values of one factor; more are a mistyped range
SCALES = ("linear", "log")
#: Path of the seed of the particles' placement, which repeats a point of a study.
SEED = "seeding.seed"


@checked
@dataclass(frozen=True)
class Factor:
    """Parameters that vary together, value by value.

    Parameters
    ----------
    columns
        The values of each parameter, by its dotted path in a scene; all parameters have the same
        number of values. A pandas DataFrame has such columns, too.

    Raises
    ------
    InputError
        If there are no values, different numbers of them, or None among them.

    Examples
    --------
    >>> factor = Factor({"panel.height": [1.0, 2.0], "panel.length": [2.0, 4.0]})
    >>> factor.points()[1]
    {'panel.height': 2.0, 'panel.length': 4.0}
    """

    columns: Mapping[str, Sequence[object]]

    def __post_init__(self) -> None:
        columns = {str(path): list(_plain(values)) for path, values in self.columns.items()}
        object.__setattr__(self, "columns", columns)
        counts = {path: len(values) for path, values in self.columns.items()}
        if not counts:
            raise InputError("names no parameter; name at least one")
        for path, count in counts.items():
            if not 0 < count <= MAX_COUNT:
                raise InputError(f"{path}: {count} values; allowed are 1 to {MAX_COUNT}")
        for path, values in self.columns.items():
            if any(value is None for value in values):
                raise InputError(f"{path}: None is no value of a parameter that varies")
        if len(set(counts.values())) > 1:
            listed = ", ".join(f"{path} has {count}" for path, count in counts.items())
            raise InputError(
                f"parameters that vary together need equally many values, but {listed}"
            )
        self._note_repeated_points()

    def _note_repeated_points(self) -> None:
        """Issue a note if a point appears twice, because its runs are computed once."""
        seen: set[object] = set()
        for point in self.points():
            plain = tuple(each if isinstance(each, (str, float, int)) else repr(each)
                          for each in point.values())  # fmt: skip
            if plain in seen:
                values = ", ".join(f"{path} = {value}" for path, value in point.items())
                issue_note(f"{values}: appears twice, and is computed once")
                return
            seen.add(plain)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def points(self) -> list[dict[str, object]]:
        """Return the points, each as ``{path: value}``."""
        return [dict(zip(self.columns, values)) for values in zip(*self.columns.values())]


def _plain(values: Sequence[object]) -> Sequence[object]:
    """Return the values of an array or a column of a table as Python's own numbers."""
    plain = getattr(values, "tolist", None)
    return plain() if callable(plain) else values


#: Factors whose points a study combines with each other.
Part = Sequence[Factor]


@checked
def axis(path: str, values: Sequence[object]) -> Factor:
    """Return the factor of a single parameter.

    Examples
    --------
    >>> axis("snow.cohesion", [0.1, 0.2]).points()
    [{'snow.cohesion': 0.1}, {'snow.cohesion': 0.2}]
    """
    return Factor({path: values})


@checked
def linear(
    start: float, stop: float, *, step: Optional[float] = None, count: Optional[int] = None
) -> list[float]:
    """Return evenly spaced values from `start` to `stop`, both included.

    Parameters
    ----------
    start, stop
        First value, and upper limit of the last value.
    step
        Distance of the values; `stop` is one of them if a whole number of steps reaches it. A note
        says if none does.
    count
        Number of values, at least 2; give either this or `step`.

    Raises
    ------
    InputError
        If the numbers do not make a range.

    Examples
    --------
    >>> linear(0.1, 0.3, step=0.1), linear(40, 70, step=10), linear(0, 1, count=3)
    ([0.1, 0.2, 0.3], [40, 50, 60, 70], [0.0, 0.5, 1.0])
    """
    _check_finite(start, stop)
    if (step is None) == (count is None):
        raise InputError("needs either a step or a count")
    if count is not None:
        _check_count(count)
        return [_without_rounding(start + (stop - start) * i / (count - 1)) for i in range(count)]
    assert step is not None
    _check_finite(step)
    if step <= 0:
        raise InputError(f"the step {step} is not positive")
    if stop < start:
        raise InputError(f"the end {stop} is below the start {start}")
    steps = (float(stop) - float(start)) / step * (1 + 1e-9)
    if not steps < MAX_COUNT:
        raise InputError(f"has too many values; at most {MAX_COUNT} are allowed")
    values = [_without_rounding(start + i * step) for i in range(math.floor(steps) + 1)]
    if stop - values[-1] > 1e-6 * step:
        issue_note(
            f"the range from {start:g} to {stop:g} in steps of {step:g} ends at {values[-1]:g}",
            InputNote,
        )
    return values


@checked
def logarithmic(start: float, stop: float, count: int) -> list[float]:
    """Return `count` values (at least 2) from `start` to `stop` in constant ratio.

    Raises
    ------
    InputError
        If the numbers do not make such a range.

    Examples
    --------
    >>> logarithmic(1e5, 1e7, 3)
    [100000.0, 1000000.0, 10000000.0]
    """
    _check_finite(start, stop)
    _check_positive(start, stop)
    _check_count(count)
    ratio = math.log(stop / start)
    return [_without_rounding(start * math.exp(ratio * i / (count - 1))) for i in range(count)]


@checked
@dataclass(frozen=True)
class Span:
    """An interval that is sampled, evenly in the value (linear) or in its logarithm (log)."""

    low: float
    high: float
    scale: str = "linear"

    def __post_init__(self) -> None:
        _check_finite(self.low, self.high)
        if self.scale not in SCALES:
            raise InputError(f"scale {self.scale!r} is none of {', '.join(SCALES)}")
        if not self.low < self.high:
            raise InputError(f"the upper end {self.high} is not above the lower end {self.low}")
        if self.scale == "log":
            _check_positive(self.low, self.high)

    def at(self, fraction: float) -> float:
        """Return the value at a fraction, 0 to 1, of the span."""
        if self.scale == "linear":
            return _without_rounding(self.low + fraction * (self.high - self.low))
        return _without_rounding(self.low * (self.high / self.low) ** fraction)


@checked
def latin_hypercube(spans: Mapping[str, Span], count: int, *, seed: int = 1) -> Factor:
    """Return a Latin hypercube sample: each of `count` slices of each span is used once.

    Parameters
    ----------
    spans
        The interval of each parameter, by its dotted path.
    count
        Number of points.
    seed
        Seed of the random numbers; another seed gives another sample.

    Raises
    ------
    InputError
        If the count is not positive, or the seed is negative.

    Examples
    --------
    >>> sample = latin_hypercube({"snow.cohesion": Span(0.1, 0.3)}, 4)
    >>> sorted(int((value - 0.1) / 0.05) for value in sample.columns["snow.cohesion"])
    [0, 1, 2, 3]
    """
    return _sample("LatinHypercube", spans, count, seed)


@checked
def sobol(spans: Mapping[str, Span], count: int, *, seed: int = 1) -> Factor:
    """Return points of a scrambled Sobol sequence; `count` is a power of two.

    Parameters and errors are those of `latin_hypercube`. Counts that are not powers of two are
    refused, because the sequence is not balanced there.

    Examples
    --------
    >>> len(sobol({"panel.tilt": Span(30, 60), "panel.friction": Span(0, 0.4)}, 8))
    8
    """
    if count < 1 or count & (count - 1):
        raise InputError(f"count {count} is not a power of two, which Sobol's sequence needs")
    return _sample("Sobol", spans, count, seed)


def _sample(method: str, spans: Mapping[str, Span], count: int, seed: int) -> Factor:
    from scipy.stats import qmc

    if not 0 < count <= MAX_COUNT:
        raise InputError(f"count {count} is outside the allowed range (1 to {MAX_COUNT})")
    if seed < 0:
        raise InputError(f"seed {seed} is negative")
    if not spans:
        raise InputError("names no parameter; name at least one")
    points = getattr(qmc, method)(d=len(spans), seed=seed).random(count)
    return Factor(
        {
            path: [span.at(float(fraction)) for fraction in points[:, column]]
            for column, (path, span) in enumerate(spans.items())
        }
    )


def _without_rounding(value: float) -> float:
    """Return a value without rounding errors in its last digits, so that 0.1 + 2 * 0.1 is 0.3."""
    return value if isinstance(value, int) else float(f"{value:.12g}")


def _check_finite(*values: float) -> None:
    for value in values:
        if not abs(value) <= sys.float_info.max:  # or an integer beyond all floats
            raise InputError(f"{shortened(str(value), 20)} is not a finite number")


def _check_positive(*values: float) -> None:
    for value in values:
        if value <= 0:
            raise InputError(f"{value} is not positive, which a logarithmic scale needs")


def _check_count(count: int) -> None:
    if not 2 <= count <= MAX_COUNT:
        raise InputError(f"count {count} is outside the allowed range (2 to {MAX_COUNT})")
