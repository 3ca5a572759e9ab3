"""Loading tests of grains."""
