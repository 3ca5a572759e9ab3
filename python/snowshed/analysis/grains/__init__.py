"""Questions to loading tests of grains: what matters for the strength, and which snow it makes."""
