"""Calibration of the snow on measured stacks (chapter 4 of the thesis)."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
