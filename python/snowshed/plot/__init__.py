"""Figures, their labels and style, HTML pages."""
