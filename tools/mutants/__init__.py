"""Injected faults: which of them the tests catch. See docs/trust/verification.md."""
