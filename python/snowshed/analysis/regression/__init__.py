"""Regression of stacks on panels, and predictions inside the data (chapter 5 of the thesis)."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
