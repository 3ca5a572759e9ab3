"""A study: a scene, and the parameters that vary in it."""

from __future__ import annotations

import contextlib
import copy
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

from snowshed._core import InputError
from snowshed.scene.scene import PathLike, Scene
from snowshed.study.factors import Factor, axis
from snowshed.study.scene_hash import Run

if TYPE_CHECKING:
    import pandas as pd

    from snowshed.study.session import Reporter

LARGEST_STUDY = 1_000_000  # runs
SEED = "seeding.seed"

#: What may not be varied, because it does not change a result: all its values are the same run.
WITHOUT_EFFECT = ("title", "output", "numerics.threads")

Part = Sequence[Factor]


@dataclass(frozen=True)
class Study:
    """A scene and the parameters that vary in it.

    Parameters
    ----------
    scene
        What all runs have in common. It may be incomplete where a factor completes it.
    parts
        Each part is a sequence of factors and stands for their product; the study is the union of
        its parts. A run that several parts ask for is one run.
    name
        The study's name in its store.
    seeds
        Seeds of the particles' placement; every point is run with each of them. None keeps the
        scene's own.

    Raises
    ------
    InputError
        If a factor names what a scene does not have, what does not change a result, or what
        another factor of the same part names too; or if there are too many runs.

    Examples
    --------
    >>> from snowshed.study import axis, linear
    >>> study = Study.product(
    ...     Scene.preset("sensitivity").update({"dimension": 2, "numerics.dx": 0.02}),
    ...     {"snow.cohesion": [0.1, 0.2], "panel.tilt": linear(40, 60, step=10)},
    ...     seeds=[1, 2],
    ... )
    >>> len(study.runs())
    12
    """

    scene: Scene
    parts: Sequence[Part] = ((),)
    name: str = "study"
    seeds: Optional[Sequence[int]] = None

    @classmethod
    def product(
        cls,
        scene: Scene,
        axes: Mapping[str, Sequence[Any]],
        *,
        name: str = "study",
        seeds: Optional[Sequence[int]] = None,
    ) -> Study:
        """Return the study of all combinations of the values of some parameters.

        Parameters
        ----------
        scene, name, seeds
            As of `Study`.
        axes
            For each parameter, by its dotted path such as ``"snow.cohesion"``, its values.
        """
        return cls(scene, [[axis(path, values) for path, values in axes.items()]], name, seeds)

    @classmethod
    def load(cls, file: PathLike) -> Study:
        """Read a study file (TOML).

        Raises
        ------
        InputError
            Naming the file, the key, what is wrong with it, and what is allowed.
        OSError
            If the file cannot be read.
        """
        from snowshed.study.study_file import load

        return load(Path(file))

    def __post_init__(self) -> None:
        if not self.name or not self.name.isprintable():
            raise InputError(f"name: {self.name!r} is not a name of printable characters")
        if not self.parts:
            raise InputError("has no parts; give at least one, which may be empty")
        for part in self.parts:
            self._check(part)
        count = sum(math.prod(len(factor) for factor in part) for part in self._seeded())
        if count > LARGEST_STUDY:
            raise InputError(f"has {count} runs; at most {LARGEST_STUDY} are allowed")

    @property
    def axes(self) -> list[str]:
        """The dotted paths of the parameters that vary, seeds not among them."""
        paths = (path for part in self.parts for factor in part for path in factor.columns)
        return list(dict.fromkeys(paths))

    def runs(self) -> list[Run]:
        """Return the runs in order, the last factor varying fastest, seeds faster still.

        Raises
        ------
        InputError
            If the scene of a run is wrong, naming its values.
        OSError
            If a file that the scene names cannot be read.
        """
        runs: dict[str, Run] = {}
        for point in self._points():
            run = self._run(point)
            runs.setdefault(run.hash, run)
        return list(runs.values())

    def run(
        self,
        folder: PathLike,
        *,
        jobs: Optional[int] = None,
        threads: Optional[int] = None,
        scheduler: Any = None,
        retry_failed: bool = False,
        progress: Optional[Reporter] = None,
    ) -> pd.DataFrame:
        """Compute what is not yet in the store in `folder`, and return the study's table.

        Whenever this is interrupted, even killed, calling it again goes on from there, and the
        table is the same, bit for bit, as if nothing had happened.

        Parameters
        ----------
        folder
            Where the store is: new, empty, or with a store in it, which studies may share. A
            study of the same name that is already in it is replaced; runs it has computed stay.
        jobs
            Local processes at once; None: as many as there are cores.
        threads
            Threads of each run; None: so many that the cores are full.
        scheduler
            Address of a Dask scheduler (or its .json file, a cluster or a client) that computes
            instead of local processes.
        retry_failed
            Whether to compute failed runs again.
        progress
            Called with a `StudyProgress` a few times a second.

        Returns
        -------
        pandas.DataFrame
            The study's table, as `read_table` returns it; failed runs are rows in it.

        Raises
        ------
        InputError
            If a scene is wrong, or the folder does not serve.
        StudyError
            If the study cannot go on, for example because the disk is full. What has been
            computed is safe.
        StudyInterrupted
            After Ctrl-C.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
        >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.05}})
        >>> study = Study.product(tiny, {"panel.friction": [0.2, 0.3]})
        >>> with TemporaryDirectory() as folder:
        ...     table = study.run(folder, jobs=1)
        >>> table[["panel.friction", "event", "ended"]].values.tolist()
        [[0.2, 1, 'time_limit'], [0.3, 1, 'time_limit']]
        """
        from snowshed.study.session import run_study
        from snowshed.study.table import read_table

        run_study(
            self,
            folder,
            jobs=jobs,
            threads=threads,
            scheduler=scheduler,
            retry_failed=retry_failed,
            progress=progress,
        )
        return read_table(folder, self.name)

    def _seeded(self) -> Iterator[Part]:
        seeds = [] if self.seeds is None else [axis(SEED, self.seeds)]
        for part in self.parts:
            yield [*part, *seeds]

    def _points(self) -> Iterator[dict[str, Any]]:
        for part in self._seeded():
            for points in itertools.product(*(factor.points() for factor in part)):
                yield {path: value for point in points for path, value in point.items()}

    def _run(self, point: Mapping[str, Any]) -> Run:
        scene = copy.deepcopy(self.scene)
        try:
            for path, value in point.items():
                scene.set(path, value)
            return Run.of(scene.resolve())
        except InputError as error:
            values = ", ".join(f"{path} = {value}" for path, value in point.items())
            raise InputError(f"{values}: {error}" if values else str(error)) from None

    def _check(self, part: Part) -> None:
        paths = [path for factor in part for path in factor.columns]
        for path in paths:
            if paths.count(path) > 1:
                raise InputError(f"{path}: varied by two factors of the same product")
            if any(path == name or path.startswith(f"{name}.") for name in WITHOUT_EFFECT):
                raise InputError(f"{path}: cannot be varied; it does not change a result")
        if self.seeds is not None and SEED in paths:
            raise InputError(f"{SEED}: varied by a factor and by the study's seeds")
        scene = copy.deepcopy(self.scene)
        for factor in part:
            for path, values in factor.columns.items():
                _try_to_set(scene, path, values[0])


def _try_to_set(scene: Scene, path: str, value: Any) -> None:
    try:
        scene.set(path, None)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    with contextlib.suppress(InputError):  # the run with this value says what is wrong with it
        scene.set(path, value)
