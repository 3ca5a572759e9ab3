"""The error of a stack, measured with further runs."""
