"""Maps of many slides: the probability that snow reaches a place, and its intensity."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
