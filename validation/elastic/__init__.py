"""Elastic bodies that vibrate and spin."""
