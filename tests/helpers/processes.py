"""Commands in separate processes, which tests interrupt, kill, or search for imported modules."""

import os
import signal
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

#: The executable that runs scenes without Python.
EXECUTABLE = Path(sysconfig.get_path("scripts")) / "snowshed-run"


def snowshed_run(*arguments: object, **options) -> subprocess.CompletedProcess[str]:
    """Run ``snowshed-run`` to its end; its output is text."""
    command = [EXECUTABLE, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, **options)


def snowshed_command(*arguments: object, **options) -> subprocess.Popen:
    """Start ``snowshed``; its output is text in pipes."""
    return subprocess.Popen(
        [sys.executable, "-m", "snowshed", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        **options,
    )


def modules_after(code: str) -> set[str]:
    """Return the modules that a new Python process has loaded after it ran some code."""
    code += "; import sys; print(); print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.splitlines()[-1].split())


def children_of(pid: int) -> list[int]:
    """Return the processes that a process has started and that still run."""
    children = Path(f"/proc/{pid}/task/{pid}/children")
    try:
        return [int(child) for child in children.read_text().split()]
    except FileNotFoundError:
        return []


def kill_with_children(command: subprocess.Popen) -> None:
    """Kill a command and its workers, so that none of them does anything afterwards."""
    command.send_signal(signal.SIGSTOP)  # so that it starts no other worker meanwhile
    for child in children_of(command.pid):
        os.kill(child, signal.SIGKILL)
    command.kill()
    command.communicate()


def wait_for(condition, timeout: float = 120.0) -> None:
    """Wait until a condition holds."""
    end = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.01)
