"""Interrupts that wait for a safe point."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any, Optional, Union

from snowshed.base.callers import resuming_command

Handler = Union[Callable[[int, Optional[FrameType]], Any], int, None]


class Interrupted(KeyboardInterrupt):
    """A run was interrupted and left a checkpoint in `folder`."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        super().__init__(f"interrupted; resume with: {resume_run_command(folder)}")


def resume_run_command(folder: Path) -> str:
    """Return the command that resumes an interrupted run."""
    return resuming_command(folder / "scene.json", folder)


@dataclass
class InterruptRequest:
    """True once an interrupt has been requested."""

    requested: bool = False


@contextmanager
def deferred_interrupts() -> Iterator[InterruptRequest]:
    """Turn Ctrl-C (SIGINT), SIGTERM and SIGHUP into a request; a second signal acts immediately.

    An ignored signal stays ignored, such as SIGHUP of a command started with nohup. If one block is
    within another, both are asked to stop.

    Outside the main thread nothing changes, because only the main thread may handle signals.
    """
    request = InterruptRequest()
    if threading.current_thread() is not threading.main_thread():
        yield request
        return
    signals = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    handlers = {number: signal.getsignal(number) for number in signals}
    before: dict[int, Handler] = {
        int(number): old for number, old in handlers.items() if old is not signal.SIG_IGN
    }

    def restore() -> None:
        for number, handler in before.items():
            signal.signal(number, handler)

    def note(number: int, frame: Optional[FrameType]) -> None:
        request.requested = True
        restore()
        outer = before[signal.Signals(number)]
        if callable(outer) and getattr(outer, "defers", False):
            outer(number, frame)

    note.defers = True  # type: ignore[attr-defined]

    for number in before:
        signal.signal(number, note)
    try:
        yield request
    finally:
        restore()
