"""The output of commands that run a scene, whatever its method is."""

from __future__ import annotations

from pathlib import Path

from rich.table import Table

from snowshed.cli.console import print_events
from snowshed.cli.terminal import PlainConsole
from snowshed.methods.registry import method_of
from snowshed.methods.summary import Summary
from snowshed.results.reader import Results


def print_results(results: Results) -> None:
    """Print the stack after each event, the summary of a run with one event, or the folder."""
    kinds = method_of(results.scene.data).results
    if "summary" in kinds:
        print_summary(results.summary, results.folder)
    elif "stack" in kinds:
        print_events(results)
    else:
        PlainConsole().print(f"results in {results.folder}")


def print_summary(summary: Summary, folder: Path) -> None:
    """Print the figures of a summary, its notes, and what else the folder holds."""
    shown = Table(title=summary.TITLE, show_header=False, box=None, title_justify="left")
    shown.add_column(style="bold")
    for name, value in summary.lines().items():
        shown.add_row(name, value)
    PlainConsole().print(shown)
    console = PlainConsole(soft_wrap=True)
    for note in getattr(summary, "notes", ()):
        console.note(note)
    console.print(f"results, {summary.OPENED} in {folder}")
