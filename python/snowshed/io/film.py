"""Films of runs: the particles over time (docs/reference/film.md has the format)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import snowshed._core as _core
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats, Integers
from snowshed.base.messages import printable, shortened
from snowshed.base.paths import PathLike

#: Name of the film in a results folder.
FILM = "film.bin"
LINEAR_STEPS = 64.0  # up to about this code, steps are even


class FilmQuantity(NamedTuple):
    """A quantity of particles in a film, and the step in which small values are stored."""

    name: str
    unit: str
    meaning: str
    step: float

    def values(self, codes: NDArray[np.int32]) -> NDArray[np.float32]:
        """Return the values of codes.

        Examples
        --------
        >>> speed = FilmQuantity("speed", "m/s", "Speed", 0.05)
        >>> [round(float(one), 2) for one in speed.values(np.array([0, 1, 64]))]
        [0.0, 0.05, 3.76]
        """
        scale = LINEAR_STEPS * self.step
        decoded: NDArray[np.float32] = (scale * np.sinh(codes / LINEAR_STEPS)).astype(np.float32)
        return decoded


def _shown(text: str) -> str:
    """Return a text of the file for a page or a picture, without harmful characters."""
    return shortened(printable(text).replace("$", "?")) or "?"  # $ begins a formula in a picture


class FrameFacts(NamedTuple):
    """Facts about a frame before it is decoded: time (s), event and particles."""

    time: float
    event: int
    particles: int


@dataclass(frozen=True)
class FilmFrame:
    """The recorded particles at a time.

    Attributes
    ----------
    time
        Times of the frames, through all events, s.
    event
        Number of the event, from 1.
    ids : (n,)
        Ids of the particles, rising.
    events, materials : (n,)
        Event of each particle, and its index among the scene's snows.
    radii : (n,)
        Grid size, m; empty if the method has none.
    positions : (n, 3)
        m; y is 0 in 2D.
    codes : (n, q)
        Codes of the film's quantities.
    """

    time: float
    event: int
    ids: Integers
    events: Integers
    materials: Integers
    radii: Floats
    positions: Floats
    codes: NDArray[np.int32]


@checked
class Film:
    """A film, read frame by frame.

    Parameters
    ----------
    path
        The file, such as ``film.bin`` in a results folder.

    Raises
    ------
    InputError
        If the file cannot be read, is not a film, or is damaged. An incomplete last frame, such as
        a killed run leaves, is dropped; then `whole` is false, and `notes` mention it.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene, run_events
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}})
    >>> with TemporaryDirectory() as folder:
    ...     _ = run_events(tiny, folder, pictures=False)
    ...     film = Film(f"{folder}/film.bin")
    ...     film.frames[-1].event, film.quantities[0].name, next(iter(film)).time
    (1, 'speed', 0.0)
    """

    def __init__(self, path: PathLike) -> None:
        self.path = Path(path)
        reader = _core.FilmReader(self.path)
        self.dimension = reader.axes
        self.quantum = reader.quantum_m
        self.interval = reader.interval_s
        self.share = reader.share
        self.version = reader.version
        self.whole = reader.whole
        self.closed = reader.closed
        self.quantities = tuple(
            FilmQuantity(_shown(name), _shown(unit), _shown(meaning), step)
            for name, unit, meaning, step in reader.quantities
        )
        self.frames = tuple(FrameFacts(*frame) for frame in reader.frames)

    @property
    def notes(self) -> list[str]:
        """Notes on the limits of the film as a record of the run."""
        if not self.whole:
            return ["the film ends within a frame: its run is still active, or was killed"]
        if self.version == 1:
            return ["the film is of version 1, which does not detect missing frames at its end"]
        return [] if self.closed else ["the film is not complete: its run has not come to its end"]

    def checksum(self, frames: int) -> str:
        """Return the checksum of the first frames, as run.json holds it."""
        return _core.FilmReader(self.path).checksum(frames)

    def __iter__(self) -> Iterator[FilmFrame]:
        reader = _core.FilmReader(self.path)
        for _ in reader.frames:
            yield self._frame(reader.next())

    def _frame(self, decoded: dict[str, object]) -> FilmFrame:
        points = np.asarray(decoded["positions"])
        positions = np.zeros((len(points), 3))
        positions[:, [0, 2] if self.dimension == 2 else [0, 1, 2]] = self.quantum * points
        return FilmFrame(
            time=float(decoded["time"]),  # type: ignore[arg-type]
            event=int(decoded["event"]),  # type: ignore[call-overload]
            ids=np.asarray(decoded["ids"]),
            events=np.asarray(decoded["events"]),
            materials=np.asarray(decoded["materials"]),
            radii=self.quantum * np.asarray(decoded["radii"]),
            positions=positions,
            codes=np.asarray(decoded["codes"]),
        )

    def __repr__(self) -> str:
        return f"Film({str(self.path)!r})"
