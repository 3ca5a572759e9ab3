"""The process in which Lua runs: it reads a request in JSON and writes the calls of the scripts.

It is a separate program, without the rest of the package. Therefore it starts quickly, and holds
nothing that a script could misuse. Before the scripts run, it gives up the right to open files and
to start processes, and limits its memory and time. The Lua state holds no Python object.
"""

from __future__ import annotations

import contextlib
import importlib
import json
import resource
import signal
import sys
from pathlib import Path
from typing import Any

ADDRESS_SPACE = 512 << 20  # bytes; the Lua state's own limit is far below
BYTES = "latin-1"  # one character per byte: texts of a script need not be UTF-8
SPARE_BYTES = 1 << 20  # memory for the error message after a script has reached its limit
REDUCED_LIMITS = (
    (resource.RLIMIT_NOFILE, 0),
    (resource.RLIMIT_NPROC, 0),
    (resource.RLIMIT_FSIZE, 0),
    (resource.RLIMIT_CORE, 0),
    (resource.RLIMIT_AS, ADDRESS_SPACE),
)


def main() -> None:
    """Answer the request on stdin."""
    request = json.load(sys.stdin)
    sys.path.append(request["lupa_folder"])
    lua = _new_state(request["limits"]["memory_bytes"])
    host = _load_host(lua, request)
    texts = lua.table_from([_to_lua(text) for text in request["texts"]])
    _drop_rights(request["limits"])
    answer = _run(lua, host, texts, request["limits"])
    sys.stdout.buffer.write(answer.encode("ascii"))


def _new_state(memory: int) -> Any:
    lupa = importlib.import_module("lupa.lua54")
    return lupa.LuaRuntime(
        register_eval=False,
        register_builtins=False,
        max_memory=memory,
        unpack_returned_tuples=True,
        encoding=BYTES,
    )


def _load_host(lua: Any, request: dict[str, Any]) -> Any:
    """Load the Lua code that makes the sandbox."""
    folder = Path(__file__).parent
    loaded = [
        lua.compile((folder / f"{name}.lua").read_text(encoding="utf-8"), name=f"={name}", mode="t")
        for name in ("plain_data", "host")
    ]
    plain_data, host = loaded
    named = (lua.table_from(request[key]) for key in ("words", "shapes", "limits"))
    modules = {
        name: lua.table_from({"number": module["number"], "text": _to_lua(module["text"])})
        for name, module in request["modules"].items()
    }
    return host(plain_data(), *named, lua.table_from(modules))


def _drop_rights(limits: dict[str, Any]) -> None:
    for which, amount in REDUCED_LIMITS:
        with contextlib.suppress(ValueError, OSError):  # not every system has every limit
            resource.setrlimit(which, (amount, amount))
    # The default action of these signals ends the process, even during a call.
    signal.setitimer(signal.ITIMER_PROF, limits["hard_seconds"])
    signal.setitimer(signal.ITIMER_REAL, limits["wall_seconds"])


def _to_lua(text: str) -> str:
    return text.encode("utf-8").decode(BYTES)


def _from_lua(text: str) -> str:
    return text.encode(BYTES).decode("utf-8", "replace")


def _run(lua: Any, host: Any, texts: Any, limits: dict[str, Any]) -> str:
    message = host.run(texts)
    lua.set_max_memory(limits["memory_bytes"] + SPARE_BYTES)
    printed = [_from_lua(line) for line in host.printed.values()]
    unset = [_from_lua(entry).split(":", 2) for entry in host.unset.values()]
    if message is None:
        calls = [json.loads(_from_lua(call)) for call in host.calls.values()]
        return json.dumps({"printed": printed, "unset": unset, "calls": calls})
    script, line = host.place()
    error = {"message": _from_lua(message), "script": script, "line": line}
    return json.dumps({"printed": printed, "error": error})


if __name__ == "__main__":
    main()
