"""Claims about the laboratory's stacks: how they grow from event to event, and with the tilt.

The data are rows of runs: ``tilt``, ``seed``, ``event``, ``height``, ``length``, ``head``,
``tail`` (m, from the panel's centre), of one dimension and one panel friction.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from reproductions.common.hypothesis_tests import (
    CONTRADICTED,
    UNDECIDED,
    Claim,
    Estimate,
    Finding,
    is_near,
    is_negative,
    is_positive,
    is_small,
    widening,
)
from snowshed.base.formatting import percent

if TYPE_CHECKING:
    import pandas as pd

#: Ratio of thesis 5.1.
RATIO_3D_2D = 2 / 3
#: Its largest deviation that counts as "about".
RATIO_TOLERANCE = 0.1
#: Section 4.3: mean errors of 0.010 m, about 10 %, and 0.061 m, about 20 %, give the mean stack.
MEAN_HEIGHT, HEIGHT_TOLERANCE = 0.10, 0.010
MEAN_LENGTH, LENGTH_TOLERANCE = 0.30, 0.061
#: Largest motion of a tail that hardly moves, relative to the stack's length.
MAX_TAIL_MOTION = 0.1
#: Share of the snow of all events on the panel above which a slab counts as stayed.
MIN_STAYING_SHARE = 0.5

Metric = Callable[..., float]


def mean_over_runs(rows: pd.DataFrame, metric: Metric) -> Estimate:
    """Return the mean of a metric over runs and tilts, with its seeding noise.

    The noise is pooled over the tilts, and widened if there are few seedings.

    Parameters
    ----------
    rows
        See the module.
    metric
        Function from the rows of a run, by event, to a number.

    Examples
    --------
    >>> import pandas as pd
    >>> rows = pd.DataFrame({"tilt": 40, "seed": [1, 2], "event": 1, "height": [0.1, 0.2]})
    >>> mean_over_runs(rows, lambda run: run.loc[1, "height"]).text("m")
    '0.15 ± 0.35 m'
    """
    runs = [
        (tilt, float(metric(run.set_index("event").sort_index())))
        for (tilt, _), run in rows.groupby(["tilt", "seed"])
    ]
    by_tilt = [
        np.array([value for other, value in runs if other == tilt])
        for tilt in {tilt for tilt, _ in runs}
    ]
    freedom = sum(len(values) - 1 for values in by_tilt)
    squares = sum(float(((values - values.mean()) ** 2).sum()) for values in by_tilt)
    variance = squares / freedom if freedom else math.nan
    mean = float(np.mean([values.mean() for values in by_tilt]))
    noise = math.sqrt(sum(variance / len(values) for values in by_tilt)) / len(by_tilt)
    return Estimate(mean, noise * widening(freedom))


def _growth(run: pd.DataFrame, column: str) -> float:
    return float(run[column].iloc[-1] - run[column].iloc[0])


def head_walks_back(rows: pd.DataFrame) -> Finding:
    """Test whether the head moves toward the panel from the first event to the last."""
    moved = mean_over_runs(rows, lambda run: _growth(run, "head"))
    return is_negative(moved, "head, last event minus first", "m")


def tail_stays(rows: pd.DataFrame) -> Finding:
    """Test whether the tail moves by less than a tenth of the length after the first event."""
    moved = mean_over_runs(rows, lambda run: _growth(run, "tail") / run["length"].iloc[-1])
    return is_small(moved, MAX_TAIL_MOTION, "tail, last event minus first, of the last length", "%")


def head_makes_the_length(rows: pd.DataFrame) -> Finding:
    """Test whether the head contributes more to the growth of the length than the tail."""
    more = mean_over_runs(rows, lambda run: -_growth(run, "head") - _growth(run, "tail"))
    return is_positive(more, "growth by the head minus growth by the tail", "m")


def length_grows_most_at_second(rows: pd.DataFrame) -> Finding:
    """Test whether the second event adds more length than each later one."""
    leads = [
        mean_over_runs(
            rows,
            lambda run, at=event: (
                _event_growth(run, "length", 2) - _event_growth(run, "length", at)
            ),
        )
        for event in _later(rows)[1:]
    ]
    return is_positive(_least(leads), "second growth minus the largest later one", "m")


def height_grows_always(rows: pd.DataFrame) -> Finding:
    """Test whether the height grows at every event, on average over the runs."""
    growths = [
        mean_over_runs(rows, lambda run, at=event: _event_growth(run, "height", at))
        for event in _later(rows)
    ]
    return is_positive(_least(growths), "smallest growth of the height at an event", "m")


def _later(rows: pd.DataFrame) -> list[int]:
    """Return the events after the first."""
    return sorted(int(event) for event in rows["event"].unique())[1:]


def _event_growth(run: pd.DataFrame, column: str, event: int) -> float:
    return float(run[column][event] - run[column][event - 1])


def _least(estimates: Sequence[Estimate]) -> Estimate:
    """Return the smallest of several means: a minimum over single runs would favour noise."""
    if not estimates:
        raise LookupError("enough events")
    return min(estimates, key=lambda estimate: estimate.value)


def height_slope_falls(rows: pd.DataFrame) -> Finding:
    """Test whether the height grows less in the second half of the events than in the first."""

    def flattening(run: pd.DataFrame) -> float:
        added = run["height"].diff().dropna().to_numpy(float)
        half = len(added) // 2
        return float(added[:half].mean() - added[-half:].mean())

    return is_positive(mean_over_runs(rows, flattening), "growth at first minus at last", "m/event")


def steeper_throws_further(rows: pd.DataFrame) -> Finding:
    """Test whether the middle of the stack lies further out below the steepest panel."""
    tilts = sorted(rows["tilt"].unique())
    if len(tilts) < 2:
        raise LookupError("stacks of two tilts")
    ends = rows[rows["tilt"].isin([tilts[0], tilts[-1]])]

    def signed_middle(run: pd.DataFrame) -> float:
        """Return the middle of the stack, negative at the lower tilt."""
        middle = float((run["head"] + run["tail"]).mean() / 2)
        return middle if run["tilt"].iloc[0] == tilts[-1] else -middle

    what = f"middle of the stack, {tilts[-1]:g} minus {tilts[0]:g} degrees"
    return is_positive(mean_over_runs(ends, signed_middle).scaled(2.0), what, "m")


def mean_height(rows: pd.DataFrame) -> Finding:
    """Test whether the mean height over the events is about that of the laboratory."""
    height = mean_over_runs(rows, lambda run: float(run["height"].mean()))
    return is_near(height, MEAN_HEIGHT, HEIGHT_TOLERANCE, "mean height over the events", "m")


def mean_length(rows: pd.DataFrame) -> Finding:
    """Test whether the mean length over the events is about that of the laboratory."""
    length = mean_over_runs(rows, lambda run: float(run["length"].mean()))
    return is_near(length, MEAN_LENGTH, LENGTH_TOLERANCE, "mean length over the events", "m")


def ratio_of_dimensions(both: tuple[pd.DataFrame, pd.DataFrame]) -> Finding:
    """Test whether the last stack's height in 3D is about two thirds of that in 2D.

    Parameters
    ----------
    both
        Rows in 3D, and in 2D.
    """
    if any(rows.empty for rows in both):
        raise LookupError("stacks in 2D and in 3D")
    three, two = (mean_over_runs(rows, lambda run: float(run["height"].iloc[-1])) for rows in both)
    ratio = three.value / two.value
    parts = math.hypot(three.noise / three.value, two.noise / two.value)
    text = "3D over 2D height after the last event"
    return is_near(Estimate(ratio, ratio * parts), RATIO_3D_2D, RATIO_TOLERANCE, text)


def slabs_stop_at_30_degrees(rows: pd.DataFrame) -> Finding:
    """Test whether a slab at 30 degrees stays on a panel of any of the frictions.

    A single coefficient stops all slabs or none, so it cannot show whether slabs *sometimes* stay.

    Parameters
    ----------
    rows
        One row per run of 30 degrees, after its last event: ``friction``, and ``stayed``, the part
        of the snow that is still on the panel.
    """
    stayed = rows.groupby("friction")["stayed"].mean().sort_index()
    listed = ", ".join(f"{percent(part, 2)} at friction {mu:g}" for mu, part in stayed.items())
    verdict = CONTRADICTED if (stayed < MIN_STAYING_SHARE).all() else UNDECIDED
    return Finding(verdict, f"snow that stays on the panel: {listed} (tan 30° is 0.577)")


GROWTH: tuple[Claim[pd.DataFrame], ...] = (
    Claim(
        "2.4.1",
        "The head walks back toward the panel.",
        "head moves toward the panel from the first event to the last",
        head_walks_back,
    ),
    Claim(
        "2.4.1",
        "The tail hardly moves after the first event.",
        f"it moves by less than {percent(MAX_TAIL_MOTION)} of the last length",
        tail_stays,
    ),
    Claim(
        "2.4.1",
        "The length grows mainly by the head.",
        "the head adds more length than the tail",
        head_makes_the_length,
    ),
    Claim(
        "2.4.1, 3.4",
        "The length grows most at the second event.",
        "the second event adds more than each later one, on average",
        length_grows_most_at_second,
    ),
    Claim(
        "2.4.2",
        "The height grows steadily.",
        "the smallest mean growth from event to event is above zero",
        height_grows_always,
    ),
    Claim(
        "2.4.2",
        "The bigger the stack, the slower its height grows.",
        "mean growth in the first half of the events is above that in the second",
        height_slope_falls,
    ),
    Claim(
        "2.4.1",
        "Steeper panels throw further.",
        "the stack's middle (mean over the events) lies further out at 50 than at 40 degrees",
        steeper_throws_further,
    ),
    Claim(
        "4.3",
        "The calibrated snow's stacks are about 0.1 m high.",
        f"mean over events and tilts within {HEIGHT_TOLERANCE} m (the thesis's mean error) of "
        f"{MEAN_HEIGHT} m (that error is about 10 %)",
        mean_height,
    ),
    Claim(
        "4.3",
        "The calibrated snow's stacks are about 0.3 m long.",
        f"mean over events and tilts within {LENGTH_TOLERANCE} m (the thesis's mean error) of "
        f"{MEAN_LENGTH} m (that error is about 20 %)",
        mean_length,
    ),
)
DIMENSIONS: tuple[Claim[tuple[pd.DataFrame, pd.DataFrame]], ...] = (
    Claim(
        "5.1.1",
        "In 3D a stack is about 2/3 as high as in 2D when height and width are comparable.",
        f"ratio after the last event within {RATIO_TOLERANCE} of 2/3; the panel is 0.33 m high and "
        "0.213 m wide",
        ratio_of_dimensions,
    ),
)
RELEASE: tuple[Claim[pd.DataFrame], ...] = (
    Claim(
        "2.3",
        "At 30 degrees slabs sometimes stop on the panel.",
        "cannot be, since one friction coefficient stops all slabs or none; contradicted if none "
        "of the frictions does",
        slabs_stop_at_30_degrees,
    ),
)
