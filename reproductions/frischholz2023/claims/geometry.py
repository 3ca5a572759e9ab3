"""Claims of section 5.1: how stacks depend on the panel.

The data have one row per panel and event: ``event``, ``panel_height``, ``panel_length`` (m),
``panel_tilt`` (degrees), and ``ratio``, ``height``, ``length`` of the stack. Each input is judged
among rows that share all others, relative to the mean of these rows. The noise is the standard
error of a fitted slope, from the scatter about the fit. The events of a panel are not independent,
because each builds on the one before, so errors are summed by panel.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from reproductions.common.hypothesis_tests import (
    CONFIRMED,
    CONTRADICTED,
    UNDECIDED,
    Claim,
    Estimate,
    Finding,
    is_negative,
    is_positive,
    is_small,
)
from snowshed.base.arrays import Floats
from snowshed.base.formatting import percent

if TYPE_CHECKING:
    import pandas as pd

PANEL = ("panel_height", "panel_length", "panel_tilt")
INPUTS = ("event", *PANEL)
#: Smallest ratio of remaining variances at which a shape fits better.
MIN_VARIANCE_RATIO = 1.5
#: Largest departure of a parabola from a straight line, relative to the line's change.
MAX_CURVATURE = 0.25
#: Largest difference of slopes that count as equal, relative to the mean slope.
MAX_SLOPE_DIFFERENCE = 0.25
#: Largest relative change of the ratio over all tilts if it hardly depends on them.
MAX_TILT_EFFECT = 0.1

#: Units of the inputs in slopes.
UNITS = {
    "panel_length": "unit of ln L",
    "panel_height": "m of panel height",
    "panel_tilt": "degree of panel tilt",
}

Shape = Callable[[Floats], Floats]


@dataclass(frozen=True)
class Fit:
    """Slopes that all groups share, with an offset for each group.

    Attributes
    ----------
    slopes
        Change per unit of each shape, relative to the group's mean.
    variance
        Remaining variance, per degree of freedom.
    span
        Difference between the highest and the lowest input.
    """

    slopes: Sequence[Estimate]
    variance: float
    span: float


def fit(table: pd.DataFrame, varied: str, target: str, *shapes: Shape) -> Fit:
    """Fit a target to functions of one input, among rows that share all others.

    Standard errors allow for correlation within a panel (Liang and Zeger, 1986), and are at least
    those of independent errors.

    Raises
    ------
    LookupError
        If there are too few such rows.

    Examples
    --------
    >>> import pandas as pd
    >>> table = pd.DataFrame({name: 1.0 for name in INPUTS}, index=range(4))
    >>> table["panel_height"] = [1.0, 2.0, 3.0, 4.0]
    >>> table["ratio"] = 5 - table["panel_height"]
    >>> round(fit(table, "panel_height", "ratio", straight).slopes[0].value, 6)  # of a mean of 2.5
    -0.4
    """
    import pandas as pd

    others = [name for name in INPUTS if name != varied]
    table = table.reset_index(drop=True)
    panel = table.groupby(list(PANEL)).ngroup().to_numpy()
    groups = [rows for _, rows in table.groupby(others) if rows[varied].nunique() > 1]
    count = sum(map(len, groups))
    freedom = count - len(groups) - len(shapes)
    if freedom < 1:
        raise LookupError(f"enough rows that differ in nothing but {varied.replace('_', ' ')}")
    inputs = [rows[varied].to_numpy(float) for rows in groups]
    columns = np.concatenate(
        [_subtract_means([shape(x) for shape in shapes]) for x in inputs], axis=1
    ).T
    targets = np.concatenate([_relative(rows[target].to_numpy(float)) for rows in groups])
    slopes, *_ = np.linalg.lstsq(columns, targets, rcond=None)
    residuals = targets - columns @ slopes
    variance = float((residuals**2).sum() / freedom)
    inverse = np.linalg.pinv(columns.T @ columns)
    panels = np.concatenate([panel[rows.index] for rows in groups])
    sums = pd.DataFrame(columns * residuals[:, None]).groupby(panels).sum().to_numpy()
    clusters = len(sums)
    robust = inverse @ sums.T @ sums @ inverse * (clusters / max(clusters - 1, 1))
    errors = np.sqrt(np.maximum(variance * np.diag(inverse), np.diag(robust)))
    estimates = [Estimate(float(slope), float(error)) for slope, error in zip(slopes, errors)]
    return Fit(estimates, variance, float(np.ptp(np.concatenate(inputs))))


def straight(x: Floats) -> Floats:
    """Return the input itself."""
    return x


def _subtract_means(columns: Sequence[Floats]) -> Floats:
    return np.array([column - column.mean() for column in columns])


def _relative(values: Floats) -> Floats:
    return np.asarray(values / values.mean() - 1)


def grows_with(table: pd.DataFrame, varied: str, target: str) -> Finding:
    """Test whether a target grows with an input."""
    return is_positive(*_slope(table, varied, target))


def falls_with(table: pd.DataFrame, varied: str, target: str) -> Finding:
    """Test whether a target falls with an input."""
    return is_negative(*_slope(table, varied, target))


def _slope(table: pd.DataFrame, varied: str, target: str) -> tuple[Estimate, str]:
    """Return the slope of a target on an input (or the length's logarithm), and its name."""
    slope = fit(table, varied, target, np.log if varied == "panel_length" else straight).slopes[0]
    return slope, f"relative change of {_name(target)} per {UNITS[varied]}"


def slopes_are_the_same(table: pd.DataFrame) -> Finding:
    """Test whether the slope of H/L on the panel's height is the same at every event."""
    slopes = []
    for _, rows in table.groupby("event"):
        slope = fit(rows, "panel_height", "ratio", straight).slopes[0]
        slopes.append(slope.scaled(float(rows["ratio"].mean() / table["ratio"].mean())))
    if len(slopes) < 2:
        raise LookupError("several events")
    low, high = min(slopes, key=_value), max(slopes, key=_value)
    mean = abs(sum(map(_value, slopes))) / len(slopes)
    if not mean:
        raise LookupError("a slope")
    text = "largest difference between slopes of two events, of the mean slope"
    return is_small((high - low).scaled(1 / mean), MAX_SLOPE_DIFFERENCE, text, "%")


def is_logarithmic(table: pd.DataFrame) -> Finding:
    """Test whether a logarithm of the panel's length fits H/L better than a straight line."""
    line = fit(table, "panel_length", "ratio", straight).variance
    logarithm = fit(table, "panel_length", "ratio", np.log).variance
    better = line / logarithm
    verdict = UNDECIDED
    if better > MIN_VARIANCE_RATIO:
        verdict = CONFIRMED
    elif better < 1 / MIN_VARIANCE_RATIO:
        verdict = CONTRADICTED
    text = "variance left by a straight line over that left by a logarithm"
    return Finding(verdict, f"{text}: {better:.2f}")


def is_linear_in_height(table: pd.DataFrame) -> Finding:
    """Test whether H/L departs little from a straight line in the panel's height."""
    middle = (table["panel_height"].min() + table["panel_height"].max()) / 2
    parabola = fit(table, "panel_height", "ratio", straight, lambda x: (x - middle) ** 2)
    slope, bend = parabola.slopes
    change = slope.value * parabola.span
    departure = bend.scaled((parabola.span / 2) ** 2 / change)
    return is_small(departure, MAX_CURVATURE, "departure from a line, of the line's change", "%")


def hardly_depends_on_tilt(table: pd.DataFrame) -> Finding:
    """Test whether the mean H/L of any two tilts differs little."""
    first, *others = sorted(table["panel_tilt"].unique())
    if not others:
        raise LookupError("several tilts")
    offsets = fit(table, "panel_tilt", "ratio", *(partial(_equal, value=tilt) for tilt in others))
    means = [Estimate(0.0, 0.0), *offsets.slopes]  # relative to the first tilt
    low, high = min(means, key=_value), max(means, key=_value)
    tilts = [first, *others]
    text = f"{tilts[means.index(high)]:g} and {tilts[means.index(low)]:g} degrees"
    return is_small(
        high - low, MAX_TILT_EFFECT, f"largest relative difference of H/L, of {text}", "%"
    )


def _equal(x: Floats, value: float) -> Floats:
    return np.asarray(x == value, dtype=float)


def _value(estimate: Estimate) -> float:
    return estimate.value


def _name(target: str) -> str:
    return "H/L" if target == "ratio" else f"stack {target}"


def _grows(text: str, varied: str, target: str) -> Claim[pd.DataFrame]:
    of_what = " on ln L" if varied == "panel_length" else ""
    judge = partial(grows_with, varied=varied, target=target)
    return Claim("5.1.2", text, f"slope{of_what} above zero", judge)


def _falls(text: str, varied: str, target: str) -> Claim[pd.DataFrame]:
    judge = partial(falls_with, varied=varied, target=target)
    return Claim("5.1.2", text, "slope below zero", judge)


GEOMETRY: tuple[Claim[pd.DataFrame], ...] = (
    _grows("H/L grows with the panel's length.", "panel_length", "ratio"),
    Claim(
        "5.1.2",
        "H/L grows with the logarithm of the panel's length.",
        f"a logarithm leaves {MIN_VARIANCE_RATIO} "
        "times less variance than a straight line (no noise)",
        is_logarithmic,
    ),
    _grows("The stack's height grows with the panel's length.", "panel_length", "height"),
    _grows("The stack's length grows with the panel's height.", "panel_height", "length"),
    _grows("The stack's height grows with the panel's height too.", "panel_height", "height"),
    _falls("H/L falls with the panel's height.", "panel_height", "ratio"),
    Claim(
        "5.1.2",
        "H/L falls linearly with the panel's height.",
        f"a parabola departs from the line by less than {percent(MAX_CURVATURE)} "
        "of the line's change",
        is_linear_in_height,
    ),
    Claim(
        "5.1.2",
        "H/L falls with the same slope at every event.",
        f"no two events' slopes differ by more than {percent(MAX_SLOPE_DIFFERENCE)} "
        "of the mean slope",
        slopes_are_the_same,
    ),
    Claim(
        "5.1.2",
        "H/L hardly depends on the tilt.",
        f"between no two tilts it changes by more than {percent(MAX_TILT_EFFECT)} of itself",
        hardly_depends_on_tilt,
    ),
    _grows("The stack's length grows slightly with the tilt.", "panel_tilt", "length"),
    _falls("The stack's height falls slightly with the tilt.", "panel_tilt", "height"),
    _falls("H/L falls slightly with the tilt.", "panel_tilt", "ratio"),
)
