"""Recorded errors of stacks: measurements on several grids, and the error of a scene's stack."""
