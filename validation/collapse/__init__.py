"""The collapse of a granular column."""
