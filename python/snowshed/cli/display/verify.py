"""What ``snowshed verify`` shows: what runs here, and a table of the checks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import click

from snowshed import _core
from snowshed.cli.terminal import one_bar, plain_table, wide_console
from snowshed.io.formatting import number
from snowshed.run.machine import cpu_name
from snowshed.run.self_test import Check, Result
from snowshed.scene.scene import Scene


def print_facts() -> None:
    """Print the version, the processor, the kernels and the number of threads."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02}).resolve()
    plan = _core.plan(scene.json, scene.base_dir)
    threads = f"{plan['threads']} threads at most"
    click.echo(f"snowshed {_core.version}, {plan['kernels']} kernels, {threads}, {cpu_name()}")


def track(results: Iterable[Result], checks: Sequence[Check]) -> list[Result]:
    """Return the results, and show meanwhile which check is running."""
    found: list[Result] = []
    with one_bar(width=24, transient=True) as bar:
        bar.show(0.0, checks[0].title)
        for result in results:
            found.append(result)
            coming = checks[min(len(found), len(checks) - 1)]
            bar.show(len(found) / len(checks), coming.title)
    return found


def print_results(results: Iterable[Result]) -> None:
    """Print the error and the bar of each check, and whether it holds."""
    table = plain_table("")
    for title, justify in (("check", "left"), ("error", "right"), ("bar", "right"), ("", "left")):
        table.add_column(title, justify="right" if justify == "right" else "left")
    for result in results:
        verdict = "ok" if result.holds else " ".join(["FAILED", result.failure]).strip()
        style = "none" if result.holds else "bold red"
        error, bar = number(abs(result.error)), number(result.check.bar)
        table.add_row(result.check.title, error, bar, verdict, style=style)
    wide_console(120).print(table)
