"""Coordinate systems of maps."""
