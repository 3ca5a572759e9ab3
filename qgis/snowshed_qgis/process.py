"""Runs a program with its progress, and stops it on request; needs no QGIS."""

from __future__ import annotations

import os
import re
import select
import signal
import subprocess
from collections.abc import Sequence
from typing import Protocol

PERCENT = re.compile(rb"(\d{1,3})%")
#: Codes that move the cursor and colour the text of a terminal.
CODES = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
POLL_S = 0.2
STOP_S = 30.0  # a run writes its checkpoint before it stops


class Feedback(Protocol):
    """The part of QgsProcessingFeedback that is used."""

    def isCanceled(self) -> bool:
        """Return whether the user has cancelled."""

    def setProgress(self, progress: float) -> None:
        """Show the progress, per cent."""

    def pushInfo(self, info: str) -> None:
        """Show a line of text."""


class ProgramError(RuntimeError):
    """A program that is missing, was cancelled, or ended with an error."""


def run_program(command: Sequence[str], feedback: Feedback) -> str:
    """Run a program and return its output; its progress and notes go to `feedback`.

    Raises
    ------
    ProgramError
        With the message of the program.
    """
    feedback.pushInfo(" ".join(command))
    try:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            # The progress is shown to terminals only.
            env={**os.environ, "FORCE_COLOR": "1", "TERM": "xterm", "COLUMNS": "120"},
        )
    except OSError as error:
        raise ProgramError(
            f"{command[0]}: {error.strerror}; install it with: pip install "
            '"snowshed[terrain]", or give its path'
        ) from None
    with process:
        output, errors = _read(process, feedback)
    if feedback.isCanceled():
        raise ProgramError("cancelled")
    notes = [line for line in _lines(errors) if line.startswith(("note:", "error:"))]
    if process.returncode != 0:
        raise ProgramError("\n".join(notes) or f"{command[0]} ended with {process.returncode}")
    for line in notes:
        feedback.pushInfo(line)
    text = "\n".join(_lines(output))
    feedback.pushInfo(text)
    return text


def _read(process: subprocess.Popen[bytes], feedback: Feedback) -> tuple[bytes, bytes]:
    """Read both streams until the program ends; interrupt it if the user cancels."""
    assert process.stdout is not None and process.stderr is not None
    texts = {process.stdout.fileno(): bytearray(), process.stderr.fileno(): bytearray()}
    streams, stopping = set(texts), False
    while streams:
        if feedback.isCanceled() and not stopping:
            process.send_signal(signal.SIGINT)
            stopping = True
        for stream in select.select(list(streams), [], [], POLL_S)[0]:
            part = os.read(stream, 1 << 16)
            texts[stream] += part
            if not part:
                streams.discard(stream)
            if shares := PERCENT.findall(part):
                feedback.setProgress(min(float(shares[-1]), 100.0))
    try:
        process.wait(STOP_S)
    except subprocess.TimeoutExpired:
        process.kill()
    return tuple(bytes(text) for text in texts.values())  # type: ignore[return-value]


def _lines(text: bytes) -> list[str]:
    """Return the lines of a text for a terminal, without its codes."""
    plain = CODES.sub("", text.decode("utf-8", errors="replace"))
    return [line.rstrip() for line in re.split(r"[\r\n]+", plain) if line.strip()]
