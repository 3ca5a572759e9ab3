"""The caller of the package, and messages in its words.

A message holds the arguments and calls of Python beside the options and commands that do the same.
The program `snowshed` tells that it is the caller; else the caller is a script.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Optional

from snowshed.base.paths import shell_words

# Not a context variable, because messages are made in threads, too.
_caller = {"is_shell": False}


@contextmanager
def called_from_shell() -> Iterator[None]:
    """Make the messages of a block name options and commands."""
    before = _caller["is_shell"]
    _caller["is_shell"] = True
    try:
        yield
    finally:
        _caller["is_shell"] = before


def is_called_from_shell() -> bool:
    """Return whether messages name options and commands."""
    return _caller["is_shell"]


def either(in_python: str, in_shell: str) -> str:
    """Return the words for the present caller.

    Examples
    --------
    >>> words = ("`Study.run`", "`snowshed study run`")
    >>> print("start one with", either(*words))
    start one with `Study.run`
    >>> with called_from_shell():
    ...     print("start one with", either(*words))
    start one with `snowshed study run`
    """
    return in_shell if _caller["is_shell"] else in_python


def argument(name: str, value: object = None, *, option: Optional[str] = None) -> str:
    """Return an argument of a function, or the option of the command line for it.

    Parameters
    ----------
    name
        The argument, such as ``max_thickness``.
    value
        Its value; True stands for an option without a value, None for an argument without one.
    option
        The name of the option if it differs from that of the argument.

    Examples
    --------
    >>> def shown():
    ...     print(argument("max_thickness"), argument("resume", True), argument("threshold", 0.5))
    >>> shown()
    `max_thickness=` `resume=True` `threshold=0.5`
    >>> with called_from_shell():
    ...     shown()
    --max-thickness --resume --threshold 0.5
    """
    text = "" if value is None else str(value)
    words = f"--{(option or name).replace('_', '-')}"
    return either(f"`{name}={text}`", words if text in ("", "True") else f"{words} {text}")


def resuming_command(scene: object, folder: object) -> str:
    """Return the command that resumes a run, as a shell reads it.

    Examples
    --------
    >>> resuming_command("out/scene.json", "my runs")
    "snowshed run out/scene.json -o 'my runs' --resume"
    """
    return shell_words("snowshed", "run", scene, "-o", folder, "--resume")


def resuming_call(scene: object, folder: object) -> str:
    """Return what resumes a run, for messages.

    Examples
    --------
    >>> resuming_call("out/scene.json", "out")
    "`snowshed.run('out/scene.json', 'out', resume=True)`"
    >>> with called_from_shell():
    ...     resuming_call("my runs/scene.json", "my runs")
    "`snowshed run 'my runs/scene.json' -o 'my runs' --resume`"
    """
    return either(
        f"`snowshed.run({str(scene)!r}, {str(folder)!r}, resume=True)`",
        f"`{resuming_command(scene, folder)}`",
    )


STUDY_RUN = ("`Study.run`", "`snowshed study run`")
STUDY_RESUME = ("`snowshed.study.resume`", "`snowshed study resume`")
