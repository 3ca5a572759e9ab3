"""Helpers that several test modules share: files, scenes, processes, and the project's paths."""
