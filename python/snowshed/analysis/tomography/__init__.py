"""Images of snow: synthetic ones, their numbers, and their grains."""
