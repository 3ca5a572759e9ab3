"""The command ``snowshed view``."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed.cli.options.common import PATH, quiet_option
from snowshed.cli.options.no_effect import refuse_without_effect
from snowshed.cli.output.progress import progress_bar
from snowshed.cli.output.terminal import say


@click.command()
@click.argument("results", type=PATH)
@click.option(
    "-o", "--output", "page", type=PATH, help="Page to write.  [default: view.html in RESULTS]"
)
@click.option(
    "--video", type=PATH, help="Video to write instead of the page: film.mp4 or film.gif."
)
@click.option("--seconds", type=float, help="Duration of the video [s].  [default: at most 12]")
@click.option(
    "--width", type=int, default=960, show_default=True, help="Width of the video [pixels]."
)
@click.option(
    "--colour", help="Quantity that colours the snow in the video, such as event or speed."
)
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
    """Write the moving view of a run or a season: a page that opens in any browser.

    \b
    Example:
      snowshed view results
      snowshed view results --video film.mp4
    """  # noqa: D301 - click wants the control character
    if video is None:
        refuse_without_effect(["seconds", "width", "colour"], "without --video")
        from snowshed.results.view import write_view

        written = write_view(results, page)
    else:
        refuse_without_effect(["page"], "with --video")
        from snowshed.results.video import write_video

        with progress_bar(quiet=quiet) as progress:
            written = write_video(
                results, video, seconds=seconds, width=width, colour=colour, progress=progress
            )
    if not quiet:
        say(f"{written}: {written.stat().st_size / 1e6:.1f} MB")
