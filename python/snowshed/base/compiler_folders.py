"""Folders of NVIDIA's packages that hold the runtime compiler for graphics cards."""

from __future__ import annotations

import sys
from pathlib import Path

#: Folders of the compiler's library in its packages for CUDA 13 and 12, below a folder of packages.
IN_PACKAGES = ("nvidia/cu13/lib", "nvidia/cuda_nvrtc/lib")


def compiler_folders() -> list[str]:
    """Return the folders that exist, in the order in which Python looks for packages.

    The core calls this when a run asks for a graphics card. The packages are not imported.

    Examples
    --------
    >>> all(folder.endswith("lib") for folder in compiler_folders())
    True
    """
    candidates = (Path(entry or ".") / part for entry in sys.path for part in IN_PACKAGES)
    return [str(folder) for folder in candidates if folder.is_dir()]
