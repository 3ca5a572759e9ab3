"""Discrete elements of snow: images, grains and their settings."""
