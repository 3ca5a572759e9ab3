"""Ageing of a stack between two slide-offs: it settles, and its bonds sinter."""

from snowshed.running.ageing.ageing import Ageing, Interval

__all__ = ["Ageing", "Interval"]
