"""A season of snowfalls: accumulation on a panel, release, and the growth of the stack below it."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
