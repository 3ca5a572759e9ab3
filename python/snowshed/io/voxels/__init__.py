"""Three-dimensional images: stacks, folders of slices, raw files with a header, NumPy arrays."""
