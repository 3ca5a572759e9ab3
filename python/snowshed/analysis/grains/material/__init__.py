"""From loading tests of grains to snow for the material point method."""
