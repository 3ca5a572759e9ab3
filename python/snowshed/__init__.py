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

import os

import lazy_loader as _lazy

# The solver's threads meet twice a step. By default OpenMP's runtime makes early threads spin for a
# long time, which on a busy machine takes the processor from the thread they wait for. The runtime
# reads this variable once, when the core is loaded; a setting of the user is kept.
if "OMP_WAIT_POLICY" not in os.environ:
    os.environ.setdefault("GOMP_SPINCOUNT", "2000")

_public, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
__all__.remove("io")  # after `from snowshed import *`, `io` stays the standard library's


def __getattr__(name: str) -> object:
    if name == "__version__":
        from snowshed._core import version

        return version
    return _public(name)
