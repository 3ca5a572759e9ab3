"""Shared parts of the cases: how they are found and measured, compared and reported."""
