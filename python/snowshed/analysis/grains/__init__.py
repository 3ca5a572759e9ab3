"""Analyses of loading tests of grains: sensitivity of the strength, and fitted snow."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
