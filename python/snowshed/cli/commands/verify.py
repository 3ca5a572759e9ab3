"""The command ``snowshed verify``: the self-test of an installation."""

from __future__ import annotations

import shlex

import click


@click.command(context_settings={"ignore_unknown_options": True, "allow_extra_args": True})
@click.pass_context
def verify(context: click.Context) -> int:
    """Check this installation: solve problems with known answers, in seconds.

    Prints the error of each, and the bar that it must not exceed. The exit code is 1 if one does.
    The suite of verification cases comes with the source of snowshed: make verify.

    \b
    Example:
      snowshed verify
    """  # noqa: D301 - click wants the control character
    if context.args:
        suite = shlex.join(["python", "-m", "validation", *context.args])
        raise click.UsageError(
            "verify checks this installation and takes no options; the suite of verification cases "
            f"comes with the source of snowshed: run `{suite}` there"
        )
    from snowshed.cli.display.verify import print_facts, print_results
    from snowshed.cli.progress import progress_bar
    from snowshed.cli.self_test import CHECKS, run_checks

    print_facts()
    with progress_bar(width=24, transient=True) as progress:
        results = run_checks(CHECKS, progress)
    print_results(results)
    return int(not all(result.holds for result in results))
