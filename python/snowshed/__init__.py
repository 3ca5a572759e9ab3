"""snowshed: simulation of snow that slides off solar panels and down slopes.

A scene is set value by value and run event by event; the stack below the panel is measured.
``__init__.pyi`` lists the public names. Each is imported when it is first used, so that commands
start at once.

Examples
--------
>>> from snowshed import Scene
>>> scene = Scene.preset("lab-50").set("snow.density", 250)
>>> scene.panel.tilt
50.0
"""

import lazy_loader as _lazy

_public, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
__all__.remove("io")  # after `from snowshed import *`, `io` stays the standard library's


def __getattr__(name: str) -> object:
    if name == "__version__":
        from snowshed._core import version

        return version
    return _public(name)
