"""Films of runs: the particles over time, as a run records them; docs/reference/film.md has the format."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import snowshed._core as _core
from snowshed.base.arrays import Floats, Integers
from snowshed.base.messages import shortened
from snowshed.base.paths import PathLike
from snowshed.base.printable import printable

#: Name of the film in a results folder.
FILM = "film.bin"
LINEAR_STEPS = 64.0  # up to about which codes are even steps


class FilmQuantity(NamedTuple):
    """A quantity of particles that a film holds, and the step in which small values are stored."""

    name: str
    unit: str
    meaning: str
    step: float

    def values(self, codes: NDArray[np.int32]) -> NDArray[np.float32]:
        """Return what codes stand for.

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
    """Return a text of the file as a page or a picture may show it."""
    return shortened(printable(text).replace("$", "?")) or "?"  # $ begins a formula in a picture


class FrameFacts(NamedTuple):
    """What is known of a frame before it is decoded: time (s), event and particles."""

    time: float
    event: int
    particles: int


@dataclass(frozen=True)
class FilmFrame:
    """The recorded particles at a time.

    Attributes
    ----------
    time
        s, through all events.
    event
        Whose event this is, from 1.
    ids : (n,)
        Of the particles, rising.
    events, materials : (n,)
        Which event and which of the scene's snows each particle is of.
    radii : (n,)
        m; empty where the method has none.
    positions : (n, 3)
        m; y is 0 in 2D.
    codes : (n, q)
        Of the film's quantities.
    """

    time: float
    event: int
    ids: Integers
    events: Integers
    materials: Integers
    radii: Floats
    positions: Floats
    codes: NDArray[np.int32]


class Film:
    """A film, read frame by frame.

    Parameters
    ----------
    path
        The file, such as ``film.bin`` in a results folder.

    Raises
    ------
    InputError
        If it cannot be read, is no film, or damaged. A last frame that is cut off, as a killed run
        leaves it, is left out; `whole` is false then, and `notes` say so.

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
        self.frames = tuple(FrameFacts(*one) for one in reader.frames)

    @property
    def notes(self) -> list[str]:
        """What should be known of the film as a record of the run."""
        if not self.whole:
            return ["the film ends within a frame: its run still goes on, or was killed"]
        if self.version == 1:
            return [
                "the film is of version 1, which knows the checksum of each frame, but not whether "
                "frames are missing at its end"
            ]
        return [] if self.closed else ["the film is not complete: its run has not come to its end"]

    def checksum(self, frames: int) -> str:
        """Return the checksum of the first so many frames, as run.json holds it."""
        return _core.FilmReader(self.path).checksum(frames)

    def __iter__(self) -> Iterator[FilmFrame]:
        reader = _core.FilmReader(self.path)
        for _ in reader.frames:
            yield self._frame(reader.next())

    def _frame(self, found: dict[str, object]) -> FilmFrame:
        places = np.asarray(found["positions"])
        positions = np.zeros((len(places), 3))
        positions[:, [0, 2] if self.dimension == 2 else [0, 1, 2]] = self.quantum * places
        return FilmFrame(
            time=float(found["time"]),  # type: ignore[arg-type]
            event=int(found["event"]),  # type: ignore[call-overload]
            ids=np.asarray(found["ids"]),
            events=np.asarray(found["events"]),
            materials=np.asarray(found["materials"]),
            radii=self.quantum * np.asarray(found["radii"]),
            positions=positions,
            codes=np.asarray(found["codes"]),
        )

    def __repr__(self) -> str:
        return f"Film({str(self.path)!r})"
