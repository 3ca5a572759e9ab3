"""Scenes from Lua scripts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.io.input_file import read_input
from snowshed.scene.lua.builder import Builder, LuaRun
from snowshed.scene.lua.limits import LuaLimits
from snowshed.scene.lua.sandbox import Script, ScriptLine, run_sandboxed
from snowshed.scene.lua.vocabulary import SHAPES, WORDS, apply

MAX_MODULES = 50  # scripts that others may require


@checked
def load_lua(
    init: PathLike,
    update: Optional[PathLike] = None,
    *,
    echo: Optional[Callable[[str], None]] = None,
    limits: Optional[LuaLimits] = None,
) -> list[LuaRun]:
    """Run an initialisation script, then an update script, and return the scenes they describe.

    Parameters
    ----------
    init
        The initialisation script. Files that scripts name or ``require`` are found in its folder.
    update
        A script that runs after it, in the same state; its values override earlier ones.
    echo
        Called with every line that the scripts print, even if they fail after that.
    limits
        Limits of the scripts. [default: `LuaLimits()`]

    Returns
    -------
    list of LuaRun
        One scene for every call of ``run``; without such a call, the scene at the end of the
        scripts.

    Raises
    ------
    InputError
        If Lua is not installed, or with script and line, if a script fails, exceeds a limit or
        describes no valid scene.
    OSError
        If a script cannot be read.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     init = Path(folder) / "init.lua"
    ...     _ = init.write_text('preset "lab-50" for M = 3, 4 do material{M = M} run("M" .. M) end')
    ...     runs = load_lua(init)
    >>> [(run.name, run.scene.data["snow"]["critical_state_slope"]) for run in runs]
    [('M3', 3.0), ('M4', 4.0)]
    """
    limits = limits or LuaLimits()
    scripts = [_read(Path(file), limits) for file in (init, update) if file is not None]
    calls = run_sandboxed(scripts, WORDS, SHAPES, limits, echo, _modules(scripts, init, limits))
    builder = Builder(Path(init).parent)
    for call in calls:
        apply(call, builder)
    if not builder.runs:
        builder.request_run("", ScriptLine(scripts[-1].name, 0))
    return builder.runs


def _modules(scripts: Sequence[Script], init: PathLike, limits: LuaLimits) -> list[Script]:
    """Return the other scripts in the folder of `init`, if any script requires one."""
    if not any("require" in script.text for script in scripts):
        return []
    names = {Path(script.name).resolve() for script in scripts}
    files = sorted(path for path in Path(init).parent.glob("*.lua") if path.resolve() not in names)
    if len(files) > MAX_MODULES:
        raise InputError(
            f"{Path(init).parent}: {len(files)} scripts beside {Path(init).name}; `require` allows "
            f"{MAX_MODULES}"
        )
    return [_read(file, limits) for file in files]


def _read(file: Path, limits: LuaLimits) -> Script:
    content = read_input(file, limits.script_bytes)
    try:
        return Script(str(file), content.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: not a UTF-8 text: {error}") from None
