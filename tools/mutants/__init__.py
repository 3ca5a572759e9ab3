"""Injected faults, which test the tests. See docs/trust/injected-faults.md."""
