"""A film as a video file, MP4 or GIF, drawn without a screen."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.extras import require
from snowshed.base.messages import suggestion
from snowshed.base.paths import PathLike
from snowshed.base.progress import Progress, Reporter
from snowshed.io.atomic import replacing
from snowshed.io.film import Film, FilmFrame
from snowshed.plot.film_picture import FilmPainter
from snowshed.plot.film_summary import Colouring, FilmSummary, summarise_film
from snowshed.results.view import shown_results, view_content


def pillow() -> Any:
    """Return the module of Pillow that reads and writes pictures."""
    return require("PIL.Image", "video", "a video")


RATE = {".mp4": 30.0, ".gif": 12.5}  # pictures per second
MAX_DURATION = 12.0  # s, unless asked for
HOLD_S = 0.6  # s that the end of an event is shown
DPI = 100
COLOURS_OF_GIF = 128


@checked
def write_video(
    results: PathLike,
    video: PathLike,
    *,
    seconds: Optional[float] = None,
    width: int = 960,
    colour: Optional[str] = None,
    progress: Optional[Reporter] = None,
) -> Path:
    """Write the film of a results folder as a video, and return its path.

    Parameters
    ----------
    results
        The folder of a run of any method, or of a season.
    video
        The file: .mp4 (needs the extra ``video``) or .gif.
    seconds
        Duration of the video. [default: as long as the snow moves, 12 s at most]
    width
        Width of its pictures, pixels.
    colour
        "event", "material" or a quantity of the film. [default: as on the page]
    progress
        Called with a `Progress` after every picture.

    Raises
    ------
    InputError
        If there is no film, the kind of video or the colour is unknown, or a library is missing;
        nothing has been drawn then.
    """
    file = Path(video)
    kind = file.suffix.lower()
    if kind not in RATE:
        raise InputError(f"{file}: unknown kind of video; allowed: .mp4, .gif")
    if not 64 <= width <= 4096:
        raise InputError(f"width: {width}; 64 to 4096 pixels are allowed")
    if seconds is not None and not 0.1 <= seconds <= 600:
        raise InputError(f"seconds: {seconds:g}; 0.1 to 600 are allowed")
    encoder = require("imageio_ffmpeg", "video", "an MP4 video") if kind == ".mp4" else None
    run = shown_results(results)
    film = run.film
    summary = summarise_film(film)
    colouring = _colouring(summary, colour)
    content = view_content(run, film)
    painter = FilmPainter(film, summary, content.solids, content.focus, width=width / DPI)
    times = _times(film, seconds, RATE[kind])
    palette = _picture(painter, summary.last, colouring)  # has all colours
    pictures = _pictures(film, painter, colouring, times, progress)
    with replacing(file) as beside:
        if encoder is not None:
            _write_mp4(encoder, beside, pictures)
        else:
            _write_gif(beside, pictures, palette)
    return file


def _colouring(summary: FilmSummary, name: Optional[str]) -> Colouring:
    if name is None:
        return summary.colourings[0]
    known = {colouring.name: colouring for colouring in summary.colourings}
    if name not in known:
        raise InputError(f"colour: {name!r} is none of {', '.join(known)}{suggestion(name, known)}")
    return known[name]


def _times(film: Film, seconds: Optional[float], rate: float) -> Sequence[float]:
    """Return the positions of the pictures among the frames; 2.5 is half-way after the third."""
    starts = [0.0]
    for before, after in zip(film.frames, film.frames[1:]):
        turn = after.event != before.event
        starts.append(starts[-1] + (0.0 if turn else max(0.0, after.time - before.time)))
    moving = starts[-1] or 1.0
    turns = np.cumsum([b.event != a.event for a, b in zip(film.frames, film.frames[1:])])
    held = np.concatenate([[0.0], turns]) * HOLD_S
    length = seconds if seconds is not None else min(MAX_DURATION, moving + held[-1] + HOLD_S)
    slower = max(length - held[-1] - HOLD_S, 0.3 * length) / moving
    shown = np.array(starts) * slower + held * min(1.0, length / (held[-1] + HOLD_S))
    wanted = np.arange(0.0, length, 1.0 / rate)
    numbers = np.interp(wanted, shown, np.arange(len(shown)))
    return list(numbers.tolist())


def _pictures(
    film: Film,
    painter: FilmPainter,
    colouring: Colouring,
    times: Sequence[float],
    progress: Optional[Reporter],
) -> Iterator[Any]:
    frames = iter(film)
    number, now = 0, next(frames)
    after = next(frames, now)
    for count, place in enumerate(times):
        while number < int(place):
            now, after = after, next(frames, after)
            number += 1
        yield _picture(painter, _interpolated_frame(now, after, place - number), colouring)
        if progress is not None:
            progress(Progress((count + 1) / len(times), count + 1, len(times), "pictures"))


def _picture(painter: FilmPainter, frame: FilmFrame, colouring: Colouring) -> Any:
    file = io.BytesIO()
    painter.draw(frame, colouring).savefig(file, format="png", dpi=DPI)
    return pillow().open(file).convert("RGB")


def _interpolated_frame(now: FilmFrame, after: FilmFrame, part: float) -> FilmFrame:
    if now.event != after.event or part <= 0 or not np.array_equal(now.ids, after.ids):
        return now
    return replace(now, positions=now.positions + part * (after.positions - now.positions))


def _write_gif(file: Path, pictures: Iterator[Any], palette: Any) -> None:
    """Write a GIF with the colours of a single picture, which keeps it small."""
    few = palette.quantize(COLOURS_OF_GIF, dither=pillow().Dither.NONE)
    quantized = (picture.quantize(palette=few, dither=pillow().Dither.NONE) for picture in pictures)
    first, others = next(quantized), quantized
    first.save(
        file,
        format="GIF",
        save_all=True,
        append_images=others,
        duration=round(1e3 / RATE[".gif"]),
        loop=0,
        optimize=True,
    )


def _write_mp4(encoder: Any, file: Path, pictures: Iterator[Any]) -> None:
    first = next(pictures)
    width, height = (side - side % 2 for side in first.size)  # the encoder needs even numbers
    stream = encoder.write_frames(
        str(file), (width, height), fps=RATE[".mp4"], codec="libx264", quality=7,
        macro_block_size=2, output_params=["-f", "mp4"],
    )  # fmt: skip
    stream.send(None)
    for picture in (first, *pictures):
        stream.send(np.ascontiguousarray(np.asarray(picture.crop((0, 0, width, height)))))
    stream.close()
