"""OpenVDB files of the snow, for Houdini, Blender and whatever else opens them."""

from snowshed.io.vdb.program import available
from snowshed.io.vdb.writing import WrittenVdb, write_vdb
from snowshed.run.vdb_export import Exported, export_folder

__all__ = ["Exported", "WrittenVdb", "available", "export_folder", "write_vdb"]
