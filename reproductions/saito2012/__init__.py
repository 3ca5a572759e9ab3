"""Reproduction of Saito and others (2012) on avalanches by the MPS method."""
