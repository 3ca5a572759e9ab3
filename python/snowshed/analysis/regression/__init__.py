"""Regression of stacks on panels, and predictions inside the data (chapter 5 of the thesis)."""
