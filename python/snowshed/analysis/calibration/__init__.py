"""Calibration of the snow on measured stacks (chapter 4 of the thesis)."""
