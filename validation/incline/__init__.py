"""A slab on an incline, with friction."""
