"""Injected faults: which of them the tests catch. See docs/trust/injected-faults.md."""
