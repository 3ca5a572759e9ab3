"""Printed output: results, progress, costs."""
