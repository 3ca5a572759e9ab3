"""A slab that tips over the edge of a panel."""
