"""Candidate release areas, and maps of many slides: the probability and intensity of snow."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
