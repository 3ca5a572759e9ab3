"""Injected faults, by which the tests are tested; see docs/develop/injected-faults.md."""
