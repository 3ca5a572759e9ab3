"""Images of snow: synthetic images, their measurements, and their grains."""
