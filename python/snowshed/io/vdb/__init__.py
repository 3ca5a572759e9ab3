"""OpenVDB files of the snow, for Houdini, Blender and other programs."""

from snowshed.io.vdb.program import available
from snowshed.io.vdb.writing import WrittenVdb, write_vdb

__all__ = ["WrittenVdb", "available", "write_vdb"]
