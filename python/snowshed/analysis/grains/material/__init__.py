"""Snow for the material point method from loading tests of grains."""
