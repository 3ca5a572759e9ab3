"""The verification cases, one module each."""
