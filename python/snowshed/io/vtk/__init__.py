"""VTK files."""
