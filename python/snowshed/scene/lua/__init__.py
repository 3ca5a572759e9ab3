"""Scenes from Lua scripts, as in the thesis (A.3.1). Needs ``snowshed[lua]``."""
