"""Scenes from the project folders of AvaFrame."""
