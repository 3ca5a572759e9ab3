"""Claims of section 3.4: effects of a parameter, on average over all other parameters.

The data are the table of `snowshed.analysis.sensitivity.fixation_table` with a column ``noise_m``:
the standard deviation that the seeding gives ``mean_m``. Numbers are those after the last event
unless an event is given. Values of the other parameters are a design, not a sample: only the
seeding is random.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

from reproductions.common.hypothesis_tests import (
    Claim,
    Estimate,
    Finding,
    all_of,
    is_negative,
    is_positive,
    is_small,
    mean_of,
)
from reproductions.frischholz2023.claims.s_index import (
    COHESION,
    HARDENING,
    MODULUS,
    PRESSURE,
    SLOPE,
)
from snowshed.base.formatting import percent
from snowshed.scene.labels import label

if TYPE_CHECKING:
    import pandas as pd

#: Largest relative change of the stack over the range of a parameter that hardly matters.
MAX_MINOR_CHANGE = 0.1
#: Cohesion below which the other parameters should matter little (3.4.1, takeaways).
MAX_WEAK_COHESION = 0.2
#: Largest relative deviation of an "almost insensitive" height.
MAX_INSENSITIVE_DEVIATION = 0.1
YIELD = (SLOPE, PRESSURE, COHESION)


def effect(table: pd.DataFrame, parameter: str, target: str) -> Estimate:
    """Return the change of the mean stack over the range of a parameter, last event, m."""
    rows = _last(_target_rows(table, target), parameter)
    low, high = (Estimate(row["mean_m"], row["noise_m"]) for row in (rows.iloc[0], rows.iloc[-1]))
    return high - low


def raises(table: pd.DataFrame, parameter: str, target: str) -> Finding:
    """Test whether the stack grows over the range of a parameter."""
    return is_positive(effect(table, parameter, target), _change(parameter, target), "m")


def lowers(table: pd.DataFrame, parameter: str, target: str) -> Finding:
    """Test whether the stack shrinks over the range of a parameter."""
    return is_negative(effect(table, parameter, target), _change(parameter, target), "m")


def shortens_at_first(table: pd.DataFrame, parameter: str) -> Finding:
    """Test whether all stacks shrink from the first value of a parameter to the second."""
    findings = []
    for event, rows in _by_event(_target_rows(table, "length"), parameter):
        low, high = (Estimate(row["mean_m"], row["noise_m"]) for _, row in rows.iloc[:2].iterrows())
        what = f"length, second minus lowest {label(parameter).symbol}, event {event:g}"
        findings.append(is_negative(high - low, what, "m"))
    return all_of(findings)


def hardly_matter(table: pd.DataFrame, target: str) -> Finding:
    """Test whether the stack changes little over the ranges of both hardening parameters."""
    findings = []
    for parameter in (HARDENING, MODULUS):
        mean = _last(_target_rows(table, target), parameter)["mean_m"].mean()
        change = effect(table, parameter, target).scaled(1 / mean)
        findings.append(is_small(change, MAX_MINOR_CHANGE, _change(parameter, target), "%"))
    return all_of(findings)


def events_matter_more(table: pd.DataFrame, target: str) -> Finding:
    """Test whether the events change the stack more than any parameter does over its range."""
    first, last = _ends(_target_rows(table, target))
    effects = {
        parameter: effect(table, parameter, target)
        for parameter in dict.fromkeys(table["parameter"])
    }
    rival = max(effects, key=lambda parameter: abs(effects[parameter].value))
    strongest = Estimate(abs(effects[rival].value), effects[rival].noise)
    lead = (last - first) - strongest
    text = f"{target}, growth by the events minus change by {label(rival).symbol}, the strongest"
    return is_positive(lead, text, "m")


def second_event_adds_most_length(table: pd.DataFrame) -> Finding:
    """Test whether the second event adds more length than the third."""
    rows = _target_rows(table, "length")
    events = sorted(rows["event"].unique())
    if len(events) < 3:
        raise LookupError("three events")
    first, second, third = (_mean(rows[rows["event"] == event]) for event in events[:3])
    more = 2 * second.value - first.value - third.value
    noise = math.sqrt(first.noise**2 + 4 * second.noise**2 + third.noise**2)
    return is_positive(
        Estimate(more, noise), "length, growth at the second minus at the third", "m"
    )


def cohesive_snow_is_more_sensitive(table: pd.DataFrame) -> Finding:
    """Test whether heights scatter more at the highest value of a yield parameter than the lowest.

    They scatter over the values of the other parameters.
    """
    findings = []
    for parameter in YIELD:
        rows = _last(_target_rows(table, "height"), parameter)
        low, high = (_deviation(row) for row in (rows.iloc[0], rows.iloc[-1]))
        what = f"scatter at the highest {label(parameter).symbol} minus at the lowest"
        findings.append(is_positive(high - low, what, "m"))
    return all_of(findings)


def mass_makes_sensitive(table: pd.DataFrame) -> Finding:
    """Test whether heights scatter more after the last event than after the first."""
    findings = []
    for parameter in YIELD:
        by_event = [rows for _, rows in _by_event(_target_rows(table, "height"), parameter)]
        first, last = (
            mean_of([_deviation(row) for _, row in rows.iterrows()])
            for rows in (by_event[0], by_event[-1])
        )
        what = f"mean scatter at values of {label(parameter).symbol}, last event minus first"
        findings.append(is_positive(last - first, what, "m"))
    return all_of(findings)


def cohesion_drives(table: pd.DataFrame) -> Finding:
    """Test whether heights of all events hardly scatter over M and p0 where beta is small."""
    findings = []
    for event, rows in _by_event(_target_rows(table, "height"), COHESION):
        for _, row in rows[rows["value"] < MAX_WEAK_COHESION * (1 - 1e-9)].iterrows():
            scatter = _deviation(row).scaled(1 / row["mean_m"])
            what = f"scatter at β {row['value']:g}, event {event:g}"
            findings.append(is_small(scatter, MAX_INSENSITIVE_DEVIATION, what, "%"))
    return all_of(findings)


def _target_rows(table: pd.DataFrame, target: str) -> pd.DataFrame:
    return table[table["target"] == target]


def _last(rows: pd.DataFrame, parameter: str) -> pd.DataFrame:
    return _by_event(rows, parameter)[-1][1]


def _by_event(rows: pd.DataFrame, parameter: str) -> list[tuple[Any, pd.DataFrame]]:
    """Return the rows of a parameter by event, each group sorted by the parameter's values."""
    rows = rows[rows["parameter"] == parameter]
    if rows["value"].nunique() < 2:
        raise LookupError(f"two values of {label(parameter).symbol}")
    return list(rows.sort_values("value").groupby("event"))


def _ends(rows: pd.DataFrame) -> tuple[Estimate, Estimate]:
    """Return the mean stack after the first and the last event."""
    first, last = rows["event"].min(), rows["event"].max()
    return _mean(rows[rows["event"] == first]), _mean(rows[rows["event"] == last])


def _mean(rows: pd.DataFrame) -> Estimate:
    """Return the mean over the values of the first parameter, which is the mean over its group."""
    rows = rows[rows["parameter"] == rows["parameter"].iloc[0]]
    return mean_of([Estimate(m, n) for m, n in zip(rows["mean_m"], rows["noise_m"])])


def _deviation(row: pd.Series[float]) -> Estimate:
    """Return the deviation over n points without the seeding's part, and its noise.

    A point's seeding has the variance s2 = n noise_m^2. The variance over the points is larger by
    s2, and has itself the variance (4 D^2 s2 + 2 s2^2) / (n - 1) to first order.
    """
    points = float(row["points"])
    if points < 2:
        raise LookupError("several points at each value")
    seeding = points * float(row["noise_m"]) ** 2
    squared = max(float(row["deviation_m"]) ** 2 - seeding, 0.0)
    of_squared = math.sqrt((4 * squared * seeding + 2 * seeding**2) / (points - 1))
    deviation = math.sqrt(squared)
    hidden = 4 * squared <= of_squared  # the noise is the deviation that seeding may hide
    return Estimate(deviation, math.sqrt(of_squared) if hidden else of_squared / (2 * deviation))


def _change(parameter: str, target: str) -> str:
    return f"{target}, highest minus lowest {label(parameter).symbol}"


RAISES_CRITERION = "mean over the others higher at the highest value than at the lowest, last event"
FIXATION: tuple[Claim[pd.DataFrame], ...] = (
    *(
        Claim(
            "3.4.1",
            f"{label(parameter).symbol} raises the stack.",
            RAISES_CRITERION,
            partial(raises, parameter=parameter, target="height"),
        )
        for parameter in YIELD
    ),
    *(
        Claim(
            "3.4.1",
            f"{label(parameter).symbol} shortens the stack.",
            RAISES_CRITERION.replace("higher", "lower"),
            partial(lowers, parameter=parameter, target="length"),
        )
        for parameter in (SLOPE, COHESION)
    ),
    Claim(
        "3.4.1",
        "p₀ lengthens the stack.",
        RAISES_CRITERION,
        partial(raises, parameter=PRESSURE, target="length"),
    ),
    *(
        Claim(
            source,
            f"ξ and E hardly matter for the {target}.",
            "over the whole range of each the mean changes by "
            f"less than {percent(MAX_MINOR_CHANGE)}",
            partial(hardly_matter, target=target),
        )
        for source, target in (("3.4.2", "height"), ("3.5", "length"))
    ),
    Claim(
        "3.4.2",
        "ξ lowers the stack when there is much snow.",
        RAISES_CRITERION.replace("higher", "lower"),
        partial(lowers, parameter=HARDENING, target="height"),
    ),
    Claim(
        "3.4.2",
        "ξ shortens the stack in the lowest part of its range, at every event.",
        "mean over the others lower at the second value than at the lowest",
        partial(shortens_at_first, parameter=HARDENING),
    ),
    *(
        Claim(
            "3.4",
            f"Events matter more for the {target} than snow parameters.",
            "growth from the first event to the last above the largest change over a parameter",
            partial(events_matter_more, target=target),
        )
        for target in ("height", "length")
    ),
    Claim(
        "3.4.1",
        "The length grows more at the second event than at the third.",
        "mean over the yield parameters",
        second_event_adds_most_length,
    ),
    Claim(
        "3.4.1",
        "The more cohesive the snow, the more sensitive the height.",
        "deviation over the other parameters larger at the highest value than at the lowest, for "
        "M, p₀ and β",
        cohesive_snow_is_more_sensitive,
    ),
    Claim(
        "3.4.1",
        "The more snow, the more sensitive the height.",
        "deviation over the other parameters larger after the last event than after the first, for "
        "M, p₀ and β, mean over their values",
        mass_makes_sensitive,
    ),
    Claim(
        "3.4.1",
        f"Below β {MAX_WEAK_COHESION:g}, β drives the height: M and p₀ hardly matter.",
        "deviation over M and p₀ "
        f"below {percent(MAX_INSENSITIVE_DEVIATION)} of the height, every event",
        cohesion_drives,
    ),
)
