"""The return mapping against closed forms."""

from __future__ import annotations

import math

import snowshed._core as _core
from snowshed.analysis.accuracy.calibrated_snow import calibrated_snow

#: Plastic volumetric strains of snow beyond its strength, in compression and tension.
STRAINS = (-0.01, -1e-4, 1e-5, 1e-4)


def hardening_error() -> float:
    """Return the largest error of p over p0 after isotropic compression and tension.

    Isotropic stress lies on the yield surface at p = p0(e_v) in compression and -beta p0(e_v) in
    tension, where p0 = K sinh(xi max(-e_v, 0)). A trial stress that lies beyond it by K times a
    change of e_v must return to it with that change.
    """
    constants, strength = calibrated_snow()
    law = _core.CamClay(*constants)
    initial = -math.asinh(strength / law.bulk) / constants.hardening_factor
    errors = [law.preconsolidation(initial) / strength - 1]
    for change in STRAINS:
        hardened = law.bulk * math.sinh(constants.hardening_factor * max(-initial - change, 0.0))
        exact = hardened if change < 0 else -constants.cohesion * hardened
        p, q, plastic = law.return_map(exact - law.bulk * change, 0.0, initial)
        errors += [(p - exact) / strength, q / strength, (plastic - initial - change) / initial]
    return max(map(abs, errors))


def critical_state_error() -> float:
    """Return the largest error of p or q, over p0, of snow sheared at its critical state.

    At the centre of the yield ellipse, p = (1 - beta) p0/2, flow is purely deviatoric: p and e_v
    stay, and q returns to the ellipse's height M (p + beta p0)/sqrt(1 + 2 beta).
    """
    constants, strength = calibrated_snow()
    law = _core.CamClay(*constants)
    initial = law.initial_plastic_strain(strength)
    centre = (1 - constants.cohesion) / 2 * strength
    height = constants.critical_state_slope * (centre + constants.cohesion * strength)
    height /= math.sqrt(1 + 2 * constants.cohesion)
    inside = law.return_map(centre, height / 2, initial)  # elastic: nothing may change
    p, q, plastic = law.return_map(centre, 3 * height, initial)
    errors = [(p - centre) / strength, (q - height) / strength, plastic / initial - 1]
    errors += [(mapped - trial) / strength for mapped, trial in zip(inside, (centre, height / 2))]
    return max(map(abs, errors))
