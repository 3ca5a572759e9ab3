"""Measuring a stack of snow (thesis A.4)."""
