"""Scenes from Lua scripts, as in the thesis (A.3.1). Needs ``snowshed[lua]``."""

from snowshed.scene.lua.builder import LuaRun
from snowshed.scene.lua.limits import Limits
from snowshed.scene.lua.loading import load_lua

__all__ = ["Limits", "LuaRun", "load_lua"]
