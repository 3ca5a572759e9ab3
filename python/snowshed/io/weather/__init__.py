"""Weather files as their providers write them, recognised by their content."""
