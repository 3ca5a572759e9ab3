"""Claims of section 3.3, about the single-parameter index S.

The data are the table of `snowshed.analysis.sensitivity.local_index`. S is taken after the last
event.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

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
from snowshed.scene.labels import label

if TYPE_CHECKING:
    import pandas as pd

SLOPE = "snow.critical_state_slope"
PRESSURE = "snow.preconsolidation_pressure"
COHESION = "snow.cohesion"
HARDENING = "snow.hardening_factor"
MODULUS = "snow.youngs_modulus"
#: Largest |S| of a negligible effect: doubling the parameter changes the stack by a tenth.
MAX_MINOR_INDEX = 0.1


def index(table: pd.DataFrame, parameter: str, target: str, *, last: bool = True) -> Estimate:
    """Return S of a parameter after the last event, or after the first."""
    return indices(table, parameter, target)[-1 if last else 0]


def indices(table: pd.DataFrame, parameter: str, target: str) -> list[Estimate]:
    """Return S of a parameter after each event."""
    rows = table[(table["parameter"] == parameter) & (table["target"] == target)]
    if rows.empty:
        raise LookupError(f"S of {label(parameter).symbol}, {target}")
    rows = rows.sort_values("event")
    return [Estimate(float(s), float(e)) for s, e in zip(rows["s"], rows["standard_error"])]


def _index_text(parameter: str, target: str) -> str:
    return f"S of {label(parameter).symbol}, {target}"


def raises(table: pd.DataFrame, parameter: str, target: str) -> Finding:
    """Test whether S of a parameter is above zero."""
    return is_positive(index(table, parameter, target), _index_text(parameter, target))


def lowers(table: pd.DataFrame, parameter: str, target: str) -> Finding:
    """Test whether S of a parameter is below zero."""
    return is_negative(index(table, parameter, target), _index_text(parameter, target))


def hardly_matter(table: pd.DataFrame, target: str) -> Finding:
    """Test whether |S| of both hardening parameters is below `MAX_MINOR_INDEX`."""
    return all_of(
        [is_small(index(table, parameter, target), MAX_MINOR_INDEX, _index_text(parameter, target))
         for parameter in (HARDENING, MODULUS)]
    )  # fmt: skip


def cohesion_is_strongest(table: pd.DataFrame) -> Finding:
    """Test whether |S| of beta exceeds that of every other parameter."""
    others = [parameter for parameter in _parameters(table) if parameter != COHESION]
    magnitudes = {parameter: _magnitude(index(table, parameter, "height")) for parameter in others}
    rival = max(magnitudes, key=lambda parameter: magnitudes[parameter].value)
    lead = _magnitude(index(table, COHESION, "height")) - magnitudes[rival]
    return is_positive(lead, f"|S| of β minus |S| of {label(rival).symbol}, the next, height")


def length_less_than_height(table: pd.DataFrame) -> Finding:
    """Test whether the mean |S| over the parameters is smaller for the length than the height."""
    parameters = _parameters(table)
    differences = [
        _magnitude(index(table, parameter, "height"))
        - _magnitude(index(table, parameter, "length"))
        for parameter in parameters
    ]
    return is_positive(mean_of(differences), "mean |S| of height minus that of length")


def cohesion_gains_with_mass(table: pd.DataFrame) -> Finding:
    """Test whether S of beta for the height is larger after the last event than after the first."""
    gain = index(table, COHESION, "height") - index(table, COHESION, "height", last=False)
    return is_positive(gain, "S of β for the height, last event minus first")


def slope_needs_mass(table: pd.DataFrame) -> Finding:
    """Test whether M matters for the height after the last event, but hardly before."""
    *before, last = indices(table, SLOPE, "height")
    what = _index_text(SLOPE, "height")
    beyond = _magnitude(last) - Estimate(MAX_MINOR_INDEX, 0.0)
    return all_of(
        [
            *(
                is_small(estimate, MAX_MINOR_INDEX, f"{what}, event {event}")
                for event, estimate in enumerate(before, 1)
            ),
            Finding(is_positive(beyond, "").verdict, f"after the last: {last.text()}"),
        ]
    )


def length_effects_gain_with_mass(table: pd.DataFrame) -> Finding:
    """Test whether S of M and of beta for the length falls from the first event to the last."""
    return all_of(
        [
            is_negative(
                index(table, parameter, "length") - index(table, parameter, "length", last=False),
                f"{_index_text(parameter, 'length')}, last event minus first",
            )
            for parameter in (SLOPE, COHESION)
        ]
    )


def _parameters(table: pd.DataFrame) -> list[str]:
    parameters = list(dict.fromkeys(table["parameter"]))
    if len(parameters) < 2:
        raise LookupError("several parameters")
    return parameters


def _magnitude(estimate: Estimate) -> Estimate:
    return Estimate(abs(estimate.value), estimate.noise)


S_INDEX: tuple[Claim[pd.DataFrame], ...] = (
    Claim(
        "3.3",
        "β has the strongest impact on the height.",
        "|S| of β above that of every other parameter, last event",
        cohesion_is_strongest,
    ),
    Claim(
        "3.3",
        "The effect of β on the height is positive.",
        "S above zero, last event",
        partial(raises, parameter=COHESION, target="height"),
    ),
    Claim(
        "3.3",
        "The effect of β on the height increases with the mass.",
        "S after the last event above that after the first",
        cohesion_gains_with_mass,
    ),
    Claim(
        "3.3",
        "p₀ lowers the height (the thesis says the opposite in 3.4.1).",
        "S below zero, last event",
        partial(lowers, parameter=PRESSURE, target="height"),
    ),
    Claim(
        "3.3",
        "M matters for the height only when there is much snow.",
        f"|S| above {MAX_MINOR_INDEX} after the last event, below it after those before",
        slope_needs_mass,
    ),
    Claim(
        "3.3",
        "ξ and E hardly matter for the height.",
        f"|S| of both below {MAX_MINOR_INDEX}, last event",
        partial(hardly_matter, target="height"),
    ),
    Claim(
        "3.3",
        "M shortens the stack.",
        "S below zero, last event",
        partial(lowers, parameter=SLOPE, target="length"),
    ),
    Claim(
        "3.3",
        "β shortens the stack.",
        "S below zero, last event",
        partial(lowers, parameter=COHESION, target="length"),
    ),
    Claim(
        "3.3",
        "M and β shorten the stack the more, the more snow there is.",
        "S of both lower after the last event than after the first",
        length_effects_gain_with_mass,
    ),
    Claim(
        "3.3",
        "ξ and E hardly matter for the length.",
        f"|S| of both below {MAX_MINOR_INDEX}, last event",
        partial(hardly_matter, target="length"),
    ),
    Claim(
        "3.3",
        "Snow parameters matter less for the length than for the height.",
        "mean |S| over the parameters smaller, last event",
        length_less_than_height,
    ),
)
