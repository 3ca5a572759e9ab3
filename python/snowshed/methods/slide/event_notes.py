"""Notes on a slide: the releases during it, forest, dams, and the change of the ground."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any


def event_notes(facts: Mapping[str, Any]) -> tuple[str, ...]:
    """Return notes on the late releases, the detrainment, the dams and the ground of a slide.

    Parameters
    ----------
    facts
        ``slide_facts`` of the core's simulation.

    Examples
    --------
    >>> event_notes({"late_releases": [], "detrained_kg": 12.0, "dams": []})
    ('Forest took 12 kg of snow from the slide.',)
    """
    late = facts.get("late_releases", ())
    by_contact = [release for release in late if release["by_contact"]]
    inflows = groupby(
        (release for release in late if not release["by_contact"]), lambda each: each["name"]
    )
    return (
        *(_secondary_note(release) for release in by_contact),
        *(_inflow_note(name, list(pulses)) for name, pulses in inflows),
        *_forest_notes(facts.get("detrained_kg", 0.0)),
        *(_dam_note(dam) for dam in facts.get("dams", ())),
        *_ground_notes(facts),
    )


def _secondary_note(release: Mapping[str, Any]) -> str:
    name = _named("Secondary release", release["name"])
    if release["time_s"] is None:
        return f"{name} never started: no snow of the slide entered it."
    return f"{name} started after {release['time_s']:.2f} s, with {release['mass_kg']:,.0f} kg."


def _inflow_note(name: str, pulses: Sequence[Mapping[str, Any]]) -> str:
    entered = [pulse for pulse in pulses if pulse["time_s"] is not None]
    mass = sum(pulse["mass_kg"] for pulse in entered)
    note = f"{_named('Inflow', name)} brought {mass:,.0f} kg at {len(entered)} of its times."
    missed = sorted(pulse["planned_s"] for pulse in pulses if pulse["time_s"] is None)
    if missed:
        note += f" The slide ended before {missed[0]:g} s, when more snow was to enter."
    return note


def _forest_notes(detrained: float) -> tuple[str, ...]:
    return (f"Forest took {detrained:,.0f} kg of snow from the slide.",) if detrained > 0.0 else ()


def _dam_note(dam: Mapping[str, Any]) -> str:
    name = _named("Dam", dam["name"])
    if dam["passed_kg"] == 0.0:
        return f"{name}: no snow passed over it."
    return (
        f"{name}: {dam['passed_kg']:,.0f} kg of snow passed over it; snow counts each time that it "
        "passes."
    )


def _ground_notes(facts: Mapping[str, Any]) -> tuple[str, ...]:
    if "ground_gained_m3" not in facts:
        return ()
    volume, stopped = facts["ground_gained_m3"], facts["stopped_kg"]
    return (
        f"The ground gained {volume:,.1f} m3 by the snow; {stopped:,.0f} kg of snow stopped and "
        "became ground.",
    )


def _named(kind: str, name: str) -> str:
    return f"{kind} {name}" if name else kind
