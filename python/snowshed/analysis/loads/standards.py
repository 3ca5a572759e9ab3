"""Rules of standards for the loads of snow, as formulas with their clauses, inputs and limits.

None of the standards was available in the original. The page of loads says so, and names where each
formula was read. A rule whose inputs are not given is not evaluated: no factor is assumed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.callers import argument

#: Width over which sliding snow is spread on a lower roof, m (15 ft).
SPREAD = 4.572
#: Weight density of snow in the rule for overhangs, kN/m3.
OVERHANG_WEIGHT = 3.0
ICE = 917.0  # density, kg/m3


@dataclass(frozen=True)
class Rule:
    """A rule with its inputs and its value.

    Attributes
    ----------
    name
        Name of the load.
    clause
        Standard and clause.
    formula
        The formula in symbols.
    inputs
        The values of the symbols.
    value, unit
        The load; None if inputs are missing.
    missing
        Arguments that would give the missing inputs.
    limits
        Where the rule ends.
    source
        Where the formula was read.
    """

    name: str
    clause: str
    formula: str
    inputs: str
    value: Optional[float]
    unit: str
    missing: Sequence[str]
    limits: str
    source: str


@checked
@dataclass(frozen=True)
class RuleInputs:
    """Inputs of the rules that no scene contains. None: not given.

    Attributes
    ----------
    snow_load
        Characteristic snow load on the roof or panel, kN per m2 of its plan.
    snow_depth
        Depth of the snow cover, m: on the roof for an overhang, on the ground for creep.
    snow_density
        Mean density of the snow cover on the ground, kg/m3.
    creep_factor, glide_factor
        Factors K and N of the Swiss guideline.
    efficiency
        Pressure on a narrow post over that on a wall of the same width.
    """

    snow_load: Optional[float] = None
    snow_depth: Optional[float] = None
    snow_density: Optional[float] = None
    creep_factor: Optional[float] = None
    glide_factor: Optional[float] = None
    efficiency: Optional[float] = None

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None and not (math.isfinite(value) and 0.0 < value <= 1e4):
                raise InputError(f"{name}: {value:g} is not allowed; above 0 and at most 10000")
        if self.snow_load is not None and self.snow_depth is not None:
            density = 1000.0 * self.snow_load / 9.81 / self.snow_depth
            if density > ICE:
                raise InputError(
                    f"snow_load, snow_depth: {self.snow_load:g} kN/m2 in {self.snow_depth:g} m is "
                    f"a density of {density:.0f} kg/m3; at most that of ice, {ICE:g}"
                )


@checked
def rules(slope_length: float, tilt: float, inputs: RuleInputs) -> list[Rule]:
    """Return the rules for a roof or panel; those without their inputs have no value.

    Parameters
    ----------
    slope_length
        Length along the slope from the edge to the ridge, m.
    tilt
        Tilt, degrees.
    inputs
        The other inputs.

    Examples
    --------
    >>> sliding = rules(4.0, 60.0, RuleInputs(snow_load=3.0))[0]
    >>> round(sliding.value, 3), sliding.unit
    (2.4, 'kN per m of edge')
    """
    run = slope_length * math.cos(math.radians(tilt))
    return [
        _sliding(run, inputs.snow_load),
        _overhang(inputs.snow_load, inputs.snow_depth),
        _guards(run, tilt, inputs.snow_load),
        _creep(inputs),
        _post(inputs),
    ]


def _sliding(run: float, load: Optional[float]) -> Rule:
    value = None if load is None else 0.4 * load * run
    spread = "" if value is None else f"; {value / SPREAD:.2f} kN/m2 over {SPREAD:.2f} m (15 ft)"
    return Rule(
        "snow that slides onto a lower roof",
        "ASCE 7-22, 7.9",
        "0.4 p_f W",
        f"{_given('p_f', load, 'kN/m2')}, W = {run:.2f} m (plan length of the slope){spread}",
        value,
        "kN per m of edge",
        _missing(snow_load=load),
        "Adds to the snow that lies on the lower roof. Not the impact of the fall. The clause is "
        "known to reduce the load on a lower roof narrower than 15 ft in proportion: not done "
        "here.",
        "a public summary of the clause",
    )


def _overhang(load: Optional[float], depth: Optional[float]) -> Rule:
    value = None
    if load is not None and depth is not None:
        value = min(3.0 / depth, depth * OVERHANG_WEIGHT) * load**2 / OVERHANG_WEIGHT
    return Rule(
        "snow that overhangs the edge",
        "EN 1991-1-3, 6.3",
        "k s² / γ, k = 3 / d, at most d γ, γ = 3 kN/m³",
        f"{_given('s', load, 'kN/m2')}, {_given('d', depth, 'm')}",
        value,
        "kN per m of edge",
        _missing(snow_load=load, snow_depth=depth),
        "Sites above 800 m in many countries; the standard ends at 1500 m unless a national annex "
        "says otherwise. It leaves out impact of sliding snow and lateral loads (1.1).",
        "the documentation of a design program; national annexes differ",
    )


def _guards(run: float, tilt: float, load: Optional[float]) -> Rule:
    value = None if load is None else load * run * math.sin(math.radians(tilt))
    return Rule(
        "force on a snow guard at the edge, without friction",
        "EN 1991-1-3, 6.4",
        "s b sin α",
        f"{_given('s', load, 'kN/m2')}, b = {run:.2f} m, α = {tilt:g}°",
        value,
        "kN per m of guard",
        _missing(snow_load=load),
        "b is the plan distance to the next guard or the ridge. Static: not the impact of snow.",
        "public summaries of the clause",
    )


def _creep(inputs: RuleInputs) -> Rule:
    needed = {
        "snow_density": inputs.snow_density,
        "snow_depth": inputs.snow_depth,
        "creep_factor": inputs.creep_factor,
        "glide_factor": inputs.glide_factor,
    }
    return Rule(
        "creep and glide of the snow cover against a long wall",
        "Swiss guideline on defence structures (2007), equation 11",
        "ρ g H² / 2 K N",
        ", ".join(
            (
                _given("ρ", inputs.snow_density, "kg/m3"),
                _given("H", inputs.snow_depth, "m"),
                _given("K", inputs.creep_factor, ""),
                _given("N", inputs.glide_factor, ""),
            )
        ),
        _creep_pressure(inputs),
        "kN per m of wall, along the slope",
        _missing(**needed),
        "K depends on slope and density (table 6), N on the ground (table 7) of the guideline. "
        "Takes weeks: no simulation here contains it.",
        "the guideline; its tables 6 and 7 were not available",
    )


def _post(inputs: RuleInputs) -> Rule:
    pressure, efficiency = _creep_pressure(inputs), inputs.efficiency
    value = None if pressure is None or efficiency is None else pressure * efficiency
    wall = {} if pressure is not None else {"the inputs of the wall": None}
    return Rule(
        "creep and glide of the snow cover against a narrow post",
        "Margreth (2007, doi:10.1016/j.coldregions.2006.08.020)",
        "S'_N η_F",
        f"{_given('η_F', efficiency, '')}, S'_N as in the row above",
        value,
        "kN per m of the post's width",
        _missing(efficiency=efficiency, **wall),
        "η_F is above 1: a post holds snow beside it, too. The paper relates it to depth over "
        "width and to the glide.",
        "the abstract of the paper; its equation for η_F was not available",
    )


def _creep_pressure(inputs: RuleInputs) -> Optional[float]:
    values = (inputs.snow_density, inputs.snow_depth, inputs.creep_factor, inputs.glide_factor)
    if None in values:
        return None
    density, depth, creep, glide = (float(value or 0.0) for value in values)
    return density * 9.81 * depth**2 / 2.0 * creep * glide / 1000.0


def _given(symbol: str, value: Optional[float], unit: str) -> str:
    return f"{symbol} not given" if value is None else f"{symbol} = {value:g} {unit}".rstrip()


def _missing(**values: Optional[float]) -> list[str]:
    return [
        argument(name) if "_" in name or name == "efficiency" else name
        for name, value in values.items()
        if value is None
    ]
