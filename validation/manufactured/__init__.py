"""Manufactured motions of an elastic body."""
