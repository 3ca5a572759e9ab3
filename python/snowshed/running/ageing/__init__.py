"""Ageing of a stack between two slide-offs: it settles, and its bonds sinter."""
