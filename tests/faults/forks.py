"""Commands in forks of a process that has imported their modules, which saves most of a start.

The program reads one request per line, and answers with the exit code of the fork that ran it.
"""

from __future__ import annotations

import importlib
import json
import os
import runpy
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

TIME_LIMIT_S = 300


class Forks:
    """A process that runs command lines in forks of itself."""

    def __init__(self, folder: Path, preloaded: Path) -> None:
        self._folder = folder
        self._process = subprocess.Popen(
            [sys.executable, __file__],
            env={**os.environ, "LD_PRELOAD": str(preloaded)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __enter__(self) -> Forks:
        return self

    def __exit__(self, *exception: object) -> None:
        self._process.communicate()

    def run(self, words: list[str], environment: dict[str, str]) -> subprocess.CompletedProcess:
        """Run a script of Python, or a module with ``-m``, as `subprocess.run` does."""
        output = self._folder / "output.txt"
        modules = self._folder / "modules.json"
        request = {"words": words, "environment": environment}
        request |= {"output": str(output), "modules": str(modules)}
        print(json.dumps(request), file=self._process.stdin, flush=True)
        code = json.loads(self._process.stdout.readline())
        return subprocess.CompletedProcess(words, code, stderr=output.read_text())


def serve() -> None:
    """Fork for each request; then import the modules that it needed, for later requests."""
    sys.path.append(str(Path.cwd()))
    for line in sys.stdin:
        request = json.loads(line)
        modules = Path(request["modules"])
        modules.unlink(missing_ok=True)
        child = os.fork()
        if child == 0:
            answer(request)
        _, status = os.waitpid(child, 0)
        if modules.is_file():  # the fork was not killed
            for name in json.loads(modules.read_text()):
                if name not in sys.modules:
                    with suppress(ImportError):
                        importlib.import_module(name)
        print(os.waitstatus_to_exitcode(status), flush=True)


def answer(request: dict) -> None:
    """Run a request and end with the exit code of its program."""
    signal.alarm(TIME_LIMIT_S)
    os.environ.update(request["environment"])
    with Path(request["output"]).open("w") as output, Path(os.devnull).open() as nothing:
        os.dup2(nothing.fileno(), 0)
        os.dup2(output.fileno(), 1)
        os.dup2(output.fileno(), 2)
    sys.argv = request["words"]
    try:
        if sys.argv[1] == "-m":
            sys.path[0] = str(Path.cwd())
            del sys.argv[:2]
            runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
        else:
            runpy.run_path(sys.argv[0], run_name="__main__")
    finally:
        Path(request["modules"]).write_text(json.dumps([*sys.modules]))
    sys.exit(0)


if __name__ == "__main__":
    serve()
