"""Fluids by the moving particle semi-implicit method."""
