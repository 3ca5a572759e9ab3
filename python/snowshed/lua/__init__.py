"""Scenes from Lua scripts, the thesis's way of working (A.3.1). Needs ``snowshed[lua]``."""

from snowshed.lua.builder import LuaRun
from snowshed.lua.limits import Limits
from snowshed.lua.loading import load_lua

__all__ = ["Limits", "LuaRun", "load_lua"]
