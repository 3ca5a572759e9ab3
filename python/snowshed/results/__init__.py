"""Results folders: written, read and turned into other formats."""
