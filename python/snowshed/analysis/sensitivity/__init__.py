"""Sensitivity of the stack to the parameters of the snow (chapter 3 of the thesis)."""
