"""Errors of measurements against known answers."""
