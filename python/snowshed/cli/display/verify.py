"""The output of ``snowshed verify``: facts about the installation, and a table of the checks."""

from __future__ import annotations

from collections.abc import Iterable

import snowshed._core as _core
from snowshed.base.formatting import number
from snowshed.base.machine import cpu_name
from snowshed.cli.self_test import Result
from snowshed.cli.terminal import plain_table, say, wide_console
from snowshed.scene.scene import Scene


def print_facts() -> None:
    """Print the version, the processor, the kernels and the number of threads."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02}).resolve()
    plan = _core.plan(scene.core, scene.base_dir)
    threads = f"{plan['threads']} threads at most"
    say(f"snowshed {_core.version}, {plan['kernels']} kernels, {threads}, {cpu_name()}")


def print_results(results: Iterable[Result]) -> None:
    """Print the error and the bar of each check, and whether it holds."""
    table = plain_table("")
    table.add_column("check")
    table.add_column("error", justify="right")
    table.add_column("bar", justify="right")
    table.add_column()
    for result in results:
        verdict = "ok" if result.holds else " ".join(["FAILED", result.failure]).strip()
        style = "none" if result.holds else "bold red"
        error, bar = number(abs(result.error)), number(result.check.bar)
        table.add_row(result.check.title, error, bar, verdict, style=style)
    wide_console(120).print(table)
