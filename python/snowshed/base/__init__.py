"""Basics for every room: records, arrays, texts, notes, the pool of processes."""
