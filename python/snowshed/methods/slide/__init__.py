"""The snow slide on terrain."""
