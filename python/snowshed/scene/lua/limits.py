"""Limits of the resources that scripts may use."""

from __future__ import annotations

from dataclasses import dataclass

from snowshed.base.arguments import checked


@checked
@dataclass(frozen=True)
class LuaLimits:
    """The resources that the scripts of one scene may use together.

    A script that exceeds one of the first three is stopped with an error that names the line. The
    next two end the process, in case a single operation does not return. Processor time is limited,
    because it hardly depends on other load of the machine; a script cannot wait for anything.

    Attributes
    ----------
    instructions
        Instructions of Lua's virtual machine.
    memory_bytes
        Memory of the Lua state, bytes.
    soft_seconds
        Processor time, s, checked every few hundred instructions.
    hard_seconds
        Processor time, s, after which the operating system ends the process.
    wall_seconds
        Time by the clock, s, after which the operating system ends the process in any case.
    calls
        Calls of functions of the vocabulary.
    printed_lines
        Printed lines; further lines are dropped.
    line_length
        Bytes of a printed line that are kept.
    script_bytes
        Length of one script, bytes.
    """

    instructions: int = 10_000_000
    memory_bytes: int = 8 << 20
    soft_seconds: float = 0.25
    hard_seconds: float = 0.4
    wall_seconds: float = 30.0
    calls: int = 10_000
    printed_lines: int = 100
    line_length: int = 500
    script_bytes: int = 1 << 20
