"""Stacks of the laboratory experiment."""
