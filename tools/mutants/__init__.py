"""Injected faults, by which the tests are tested; see docs/trust/injected-faults.md."""
