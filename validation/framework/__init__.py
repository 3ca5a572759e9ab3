"""Shared parts of the cases: loading, measuring, comparing and reporting."""
