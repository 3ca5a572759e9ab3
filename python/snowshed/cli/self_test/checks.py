"""The checks of the self-test, in the order in which they run."""

from __future__ import annotations

from snowshed.cli.self_test.check import Check
from snowshed.cli.self_test.motion import column_error, fall_error, friction_error
from snowshed.cli.self_test.return_mapping import critical_state_error, hardening_error
from snowshed.cli.self_test.same_bits import checkpoint_error, executable_error, threads_error
from snowshed.cli.self_test.slide import coulomb_error, voellmy_error

CHECKS = (
    Check("return mapping: isotropic compression and tension", 1e-9, hardening_error),
    Check("return mapping: shear at the critical state", 1e-9, critical_state_error),
    Check("free fall: speed", 1e-6, fall_error),
    Check("block on an incline: acceleration with friction", 0.01, friction_error),
    Check("column at rest: mean pressure under its weight", 0.02, column_error),
    Check("snow slide: speed with Coulomb's friction", 0.005, coulomb_error),
    Check("snow slide: speed with Voellmy's friction", 0.005, voellmy_error),
    Check("two threads: the same bits as one", 0.0, threads_error),
    Check("checkpoint: the same bits after loading", 0.0, checkpoint_error),
    Check("snowshed-run: the same particles", 0.0, executable_error),
)
