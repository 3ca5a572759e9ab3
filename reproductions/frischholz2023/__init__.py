"""The thesis reproduced: its tables, figures and claims beside our own numbers."""
