"""Forces of snow and water on obstacles."""
