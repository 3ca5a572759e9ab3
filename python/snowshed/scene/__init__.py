"""Scenes: what is to be simulated, as data."""
