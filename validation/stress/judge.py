"""Verdict on a run, which passes if it ends in a sound state or stops with a clear error."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

#: Outcomes of a run, and their meanings.
OUTCOMES = {
    "rest": "the snow came to rest",
    "time_limit": "ran soundly to the time limit",
    "step_limit": "ran soundly until the suite's own limit on steps",
    "refused": "bad input, refused with a clear error before it ran",
    "stopped": "stopped with a clear error and a sound checkpoint",
    "failed": "anything else",
}

#: Largest change of the mass by reseeding; without reseeding mass is exact, bit by bit.
MASS_BOUND = 1e-9

#: Largest allowed energy residual relative to the added energy. The balance is of first order in
#: the time step, and soft snow takes steps that are not small compared with its fall or impact.
ENERGY_BOUND = 0.2

#: Largest allowed excess of kinetic and elastic energy over the input for one or two steps.
#: Colliding bodies strain before they slow down, because symplectic Euler oscillates about a
#: slightly different energy, by up to the energy of the colliding particles.
SWING_BOUND = 0.1
#: Largest allowed excess at the end of a run.
GAIN_BOUND = 0.01

#: Words of clear errors: a place in the scene, a parameter, a particle, or the treatment between
#: events.
_NAMES = re.compile(
    r"^/\w+|\b(snow|numerics|events|seeding|panel|slab)\.\w+|particle \d+|reseed", re.ASCII
)


def momentum_bound(precision: str, steps: int) -> float:
    """Return the allowed relative error of the momentum: a few roundings in every step.

    Examples
    --------
    >>> momentum_bound("double", 1000) < 1e-12
    True
    """
    epsilon = float(np.finfo(np.float32 if precision == "float" else np.float64).eps)
    return epsilon * (100 + steps)


def has_cause(message: str) -> bool:
    """Return whether an error names its cause, such as a parameter or a particle.

    Examples
    --------
    >>> has_cause("particle 7 at (0.1, 0.2) m: ...")
    True
    >>> has_cause("something went wrong")
    False
    """
    return _NAMES.search(message) is not None


def judge(record: Mapping[str, Any]) -> tuple[str, str]:
    """Return a run's outcome, one of `OUTCOMES`, and the reason if it failed."""
    ended = str(record["ended"])
    if ended not in OUTCOMES:
        return "failed", f"{ended}: {record['message']}"
    fault = _error_fault(record) if ended in ("refused", "stopped") else _state_fault(record)
    return ("failed", fault) if fault else (ended, "")


def _error_fault(record: Mapping[str, Any]) -> str:
    if not has_cause(str(record["message"])):
        return f"the error names no cause: {record['message']}"
    return _state_fault(record) if "finite" in record else ""


def _state_fault(record: Mapping[str, Any]) -> str:
    if not record["finite"]:
        return f"the state is not finite {record['message']}".strip()
    if not record["checkpoint"]:
        return "no checkpoint could be written and read"
    bounds = {
        "mass_error": MASS_BOUND,
        "momentum_error": momentum_bound(record["precision"], record["steps"]),
        "energy_error": ENERGY_BOUND,
        "stored_excess": SWING_BOUND,
        "final_excess": GAIN_BOUND,
    }
    for name, bound in bounds.items():
        if record[name] > bound:  # NaN (not measured) passes
            return f"{name} is {record[name]:.3g}, more than {bound:.3g}"
    return ""
