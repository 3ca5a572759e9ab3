"""Analyses of loading tests of grains: sensitivity of the strength, and fitted snow."""
