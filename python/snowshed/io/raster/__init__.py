"""Rasters: grids of elevations and thicknesses."""
