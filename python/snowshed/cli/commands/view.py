"""The command ``snowshed view``."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed.cli.progress import progress_bar
from snowshed.cli.quiet import quiet_option
from snowshed.cli.terminal import say

PATH = click.Path(path_type=Path)


@click.command()
@click.argument("results", type=PATH)
@click.option("-o", "--output", "page", type=PATH, help="The page; default: view.html in RESULTS.")
@click.option("--video", type=PATH, help="A film.mp4 or film.gif, in place of the page.")
@click.option("--seconds", type=float, help="How long the video is; default: 12 at most.")
@click.option("--width", type=int, default=960, show_default=True, help="Of the video, pixels.")
@click.option("--colour", help="What colours the video's snow, such as event or speed.")
@quiet_option
def view(
    results: Path,
    page: Optional[Path],
    video: Optional[Path],
    seconds: Optional[float],
    width: int,
    colour: Optional[str],
    quiet: bool,
) -> None:
    """Write the moving view of a run or a season, one page that opens in any browser.

    \b
    Example:
      snowshed view results
      snowshed view results --video film.mp4
    """  # noqa: D301 - click wants the control character
    if video is None:
        from snowshed.results.view import write_view

        written = write_view(results, page)
    else:
        from snowshed.results.video import write_video

        with progress_bar(quiet=quiet) as progress:
            written = write_video(
                results, video, seconds=seconds, width=width, colour=colour, progress=progress
            )
    if not quiet:
        say(f"{written}: {written.stat().st_size / 1e6:.1f} MB")
