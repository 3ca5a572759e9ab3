"""OpenVDB files of the snow, for Houdini, Blender and whatever else opens them."""

from snowshed.vdb.export import Exported, export_folder
from snowshed.vdb.program import available
from snowshed.vdb.writing import WrittenVdb, write_vdb

__all__ = ["Exported", "WrittenVdb", "available", "export_folder", "write_vdb"]
