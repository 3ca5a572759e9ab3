"""Columns that settle under their own weight."""
