"""Ageing of a stack between two slide-offs: it settles, and its bonds sinter."""

from snowshed.run.ageing.ageing import AGEING_COLUMNS, Ageing, Interval

__all__ = ["AGEING_COLUMNS", "Ageing", "Interval"]
