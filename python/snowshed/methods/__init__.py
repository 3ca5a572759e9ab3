"""Settings and Python faces of the methods."""
