"""The command ``snowshed self-test``."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import click

import snowshed._core as _core
from snowshed.base.formatting import number
from snowshed.base.paths import shell_words
from snowshed.cli.output.terminal import plain_table, say, wide_console

if TYPE_CHECKING:
    from snowshed.cli.self_test import Result


@click.command(
    "self-test", context_settings={"ignore_unknown_options": True, "allow_extra_args": True}
)
@click.pass_context
def self_test(context: click.Context) -> int:
    """Test this installation: solve problems with known answers, in seconds.

    Prints the error of each problem and its tolerance. The exit code is 1 if an error exceeds its
    tolerance. The validation, a larger suite of problems, comes with the source of snowshed: make
    validation.

    \b
    Example:
      snowshed self-test
    """  # noqa: D301 - click wants the control character
    if context.args:
        suite = shell_words("python", "-m", "validation", *context.args)
        raise click.UsageError(
            "self-test takes no options; the validation, a larger suite of problems, comes with "
            f"the source of snowshed: run `{suite}` there"
        )
    from snowshed.cli.output.progress import progress_bar
    from snowshed.cli.self_test import CHECKS, run_checks

    print_facts()
    with progress_bar(width=24, transient=True) as progress:
        results = run_checks(CHECKS, progress)
    print_results(results)
    return int(not all(result.holds for result in results))


def print_facts() -> None:
    """Print the version, the processor, the kernels and the number of threads."""
    from snowshed.base.machine import cpu_name
    from snowshed.scene.scene import Scene

    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02}).resolve()
    plan = _core.plan(scene.core, scene.base_dir)
    threads = f"{plan['threads']} threads at most"
    say(f"snowshed {_core.version}, {plan['kernels']} kernels, {threads}, {cpu_name()}")


def print_results(results: Iterable[Result]) -> None:
    """Print the error and the tolerance of each check, and whether it holds."""
    table = plain_table("")
    table.add_column("check")
    table.add_column("error", justify="right")
    table.add_column("tolerance", justify="right")
    table.add_column()
    for result in results:
        verdict = "ok" if result.holds else " ".join(["FAILED", result.failure]).strip()
        style = "none" if result.holds else "bold red"
        error, tolerance = number(abs(result.error)), number(result.check.tolerance)
        table.add_row(result.check.title, error, tolerance, verdict, style=style)
    wide_console(120).print(table)
