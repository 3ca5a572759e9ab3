"""A self-test of an installation: problems with known answers, solved within seconds."""

from snowshed.cli.self_test.check import Check, Result, run_checks
from snowshed.cli.self_test.checks import CHECKS

__all__ = ["CHECKS", "Check", "Result", "run_checks"]
