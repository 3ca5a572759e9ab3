"""Snow: relations between its properties, the measurement of a stack, and its recorded errors."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
