"""Packs the QGIS plugin for its installation: ``python -m tools.qgis_archive FILE.zip``."""

from __future__ import annotations

import sys
import zipfile
from pathlib import Path

PLUGIN = Path(__file__).parents[1] / "qgis" / "snowshed_qgis"


def pack(archive: Path) -> None:
    """Write the archive, in which the plugin's folder is the only one."""
    archive.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as target:
        for file in sorted(PLUGIN.rglob("*")):
            if file.is_file() and "__pycache__" not in file.parts:
                target.write(file, file.relative_to(PLUGIN.parent))


if __name__ == "__main__":
    pack(Path(sys.argv[1]))
