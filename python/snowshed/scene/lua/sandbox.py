"""Running scripts in a process of their own, and reading the calls that they made."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Optional, Union

from snowshed._core import InputError
from snowshed.base.extras import require
from snowshed.base.notes import InputNote, issue_note
from snowshed.scene.lua.limits import LuaLimits

PROGRAM = Path(__file__).with_name("child.py")
START_SECONDS = 60.0  # time to start and answer on a very busy machine, s
MAX_MESSAGE = 500
OUR_OWN_PLACE = re.compile(r"^(?:host|plain_data):\d+: ")
SCRIPT_PLACE = re.compile(r"^script(\d+):(\d+): ")
LOCAL_NAMES = re.compile(r"^\s*local\s+([\w\s,]+?)\s*(?:=|$)")


@dataclass(frozen=True)
class Script:
    """A script to run: its name in errors, and its text."""

    name: str
    text: str


@dataclass(frozen=True)
class ScriptLine:
    """A line of a script; 0 if it is not known."""

    script: str
    line: int

    def __str__(self) -> str:
        return f"{self.script}:{self.line}" if self.line else self.script


@dataclass(frozen=True)
class Call:
    """One call of the vocabulary."""

    word: str
    arguments: list[Any]
    script_line: ScriptLine


def run_sandboxed(
    scripts: Sequence[Script],
    functions: Sequence[str],
    shapes: Mapping[str, str],
    limits: Optional[LuaLimits] = None,
    echo: Optional[Callable[[str], None]] = None,
    modules: Sequence[Script] = (),
) -> list[Call]:
    """Run scripts one after the other in one Lua state.

    Parameters
    ----------
    scripts
        The scripts to run; a later script sees the globals of the earlier ones.
    functions
        Names of the functions whose calls are recorded.
    shapes
        Functions that make shapes from tables, and the types of these shapes.
    limits
        Limits of the scripts. [default: `LuaLimits()`]
    echo
        Called with every line that the scripts print, even if they fail after that.
    modules
        Scripts that others may ``require`` by the stem of their file.

    Returns
    -------
    list of Call
        The calls of `functions`, in their order.

    Raises
    ------
    InputError
        If Lua is not installed, or with script and line, if a script fails or exceeds a limit.

    Examples
    --------
    >>> run_sandboxed([Script("a.lua", "x = 2 gravity(9.81 * x)")], ["gravity"], {})
    [Call(word='gravity', arguments=[19.62], script_line=ScriptLine(script='a.lua', line=1))]
    """
    lupa = require("lupa.lua54", "lua", "running Lua scripts")
    limits = limits or LuaLimits()
    request = {
        "lupa_folder": str(Path(lupa.__file__).parents[1]),
        "texts": [script.text for script in scripts],
        "words": list(functions),
        "shapes": dict(shapes),
        "limits": asdict(limits),
        "modules": {
            Path(module.name).stem: {"number": number, "text": module.text}
            for number, module in enumerate(modules, start=len(scripts) + 1)
        },
    }
    names = [script.name for script in (*scripts, *modules)]
    answer = _ask(json.dumps(request), names[: len(scripts)], limits)
    if echo is not None:
        for line in answer["printed"]:
            echo(_printable(line))
    if "error" in answer:
        raise _failure(answer["error"], names, limits)
    for script_text in (*scripts, *modules):
        _note_hidden_words(script_text, {*functions, *shapes})
    for script, line, name in answer["unset"]:
        place = f"{names[int(script) - 1]}:{line}"
        issue_note(
            f"{place}: {_printable(name)} has no value; a setting without one stays as it is",
            InputNote,
        )
    return [
        Call(word, arguments, ScriptLine(names[script - 1], line))
        for word, script, line, arguments in answer["calls"]
    ]


def _note_hidden_words(script: Script, words: set[str]) -> None:
    """Note local variables that hide a word: ``local panel = {...}`` describes no panel."""
    for number, line in enumerate(script.text.splitlines(), start=1):
        match = LOCAL_NAMES.match(line.partition("--")[0])
        for name in re.split(r"[\s,]+", match[1]) if match else ():
            if name in words:
                issue_note(
                    f"{ScriptLine(script.name, number)}: the local variable {name} hides the word "
                    f'{name}; {name} {{...}} without "local" and "=" describes it',
                    InputNote,
                )


def _ask(request: str, names: list[str], limits: LuaLimits) -> dict[str, Any]:
    """Return the answer of the process that runs Lua."""
    # -I and -S: only the standard library is found; the request names the folder of lupa.
    command: list[Union[str, Path]] = [sys.executable, "-I", "-S", PROGRAM]
    both = " with ".join(names)
    try:
        done = subprocess.run(
            command, input=request.encode("ascii"), capture_output=True, timeout=START_SECONDS
        )
    except subprocess.TimeoutExpired:
        raise InputError(f"{both}: stopped: no answer within {START_SECONDS:g} s") from None
    if -done.returncode == signal.SIGPROF:
        raise InputError(
            f"{both}: stopped in one operation that takes more than the {limits.hard_seconds:g} s "
            "of processor time scripts have"
        )
    if -done.returncode == signal.SIGALRM:
        raise InputError(f"{both}: stopped after {limits.wall_seconds:g} s by the clock")
    if done.returncode != 0:
        reason = done.stderr.decode("utf-8", "replace").strip().rpartition("\n")[2]
        raise InputError(f"{both}: Lua ended unexpectedly: {_printable(reason or 'no reason')}")
    answer: dict[str, Any] = json.loads(done.stdout)
    return answer


def _failure(error: dict[str, Any], names: list[str], limits: LuaLimits) -> InputError:
    """Return the error with its script line in front, once."""
    message = OUR_OWN_PLACE.sub("", error["message"])
    script, line = error["script"], error["line"]
    own_place = SCRIPT_PLACE.match(message)
    if own_place and int(own_place[1]) in range(1, len(names) + 1):
        script, line = int(own_place[1]), int(own_place[2])
        message = message[own_place.end() :]
    if message == "not enough memory":
        message = f"stopped: more than {limits.memory_bytes / 2**20:g} MB of memory"
    return InputError(f"{ScriptLine(names[script - 1], line)}: {_printable(message)}")


def _printable(text: str) -> str:
    """Return text without control characters, shortened to `MAX_MESSAGE`."""
    if len(text) > MAX_MESSAGE:
        text = text[:MAX_MESSAGE] + "..."
    return "".join(c if c.isprintable() else " " for c in text)
