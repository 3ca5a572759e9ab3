"""A study: a scene, and the parameters that vary in it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.field_type import shown
from snowshed.base.notes import ResultNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.base.progress import Reporter
from snowshed.io.atomic import write_text
from snowshed.io.input_file import read_input
from snowshed.results.computed_record import record_kind
from snowshed.scene.scene import Scene
from snowshed.study import session, study_file, study_record
from snowshed.study.errors import StudyInterrupted
from snowshed.study.factors import SEED, Part, axis
from snowshed.study.named_laws import NamedLaws
from snowshed.study.scene_hash import RunKey
from snowshed.study.season_part import SEASON_PATHS, SeasonPart
from snowshed.study.store import Store
from snowshed.study.table import read_table
from snowshed.study.unusual_factors import note_on_unusual_values

if TYPE_CHECKING:
    import pandas as pd

MAX_RUNS = 1_000_000  # runs

#: Parameters that cannot vary, because they do not change a result.
WITHOUT_EFFECT = ("title", "output", "numerics.threads", "numerics.device")


@checked
@dataclass(frozen=True)
class Study:
    """A scene and the parameters that vary in it.

    Parameters
    ----------
    scene
        The scene that all runs have in common. It may lack values that a factor sets. The study has
        a copy: later changes of the scene do not change the study.
    parts
        Each part is a sequence of factors and stands for their product. The study is the union of
        its parts. A run that is in several parts is one run.
    name
        The study's name in its store.
    seeds
        Seeds of the particles' placement; every point is run with each of them. None keeps the
        scene's own.
    description
        Purpose of the study, for readers of its file.
    season
        A winter, if the runs are seasons: the snow of each panel gathers, slides off and piles up,
        and every slide-off is an event. The thickness of the slab and the number of events are
        those of the winter. None: the events are those of the scene.
    laws
        Laws of one's own, named so that every process can make them; None: those of the scene.

    Warns
    -----
    SnowshedNote
        If a factor has an unusual value, such as a tilt in radians.

    Raises
    ------
    InputError
        If a factor names a parameter that a scene does not have, that does not change a result, or
        that another factor of the same part also names, if a value is of a wrong type, or if there
        are too many runs.

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
    description: str = ""
    season: Optional[SeasonPart] = None
    laws: Optional[NamedLaws] = None

    @classmethod
    def product(
        cls,
        scene: Scene,
        axes: Mapping[str, Sequence[object]],
        *,
        name: str = "study",
        seeds: Optional[Sequence[int]] = None,
        season: Optional[SeasonPart] = None,
        laws: Optional[NamedLaws] = None,
    ) -> Study:
        """Return the study of all combinations of the values of some parameters.

        Parameters
        ----------
        scene, name, seeds, season, laws
            As for `Study`.
        axes
            The values of each parameter, by its dotted path such as ``"snow.cohesion"``.
        """
        factors = [axis(path, values) for path, values in axes.items()]
        return cls(scene, [factors], name, seeds, season=season, laws=laws)

    @classmethod
    def load(cls, file: PathLike) -> Study:
        """Read a study file (TOML), or the record that `compute` leaves in its folder.

        Warns
        -----
        SnowshedNote
            If a record is of another build, or files that it names have changed.

        Raises
        ------
        InputError
            If the file is wrong; the message has the key, its fault and the allowed values.
        OSError
            If the file cannot be read.
        """
        path = Path(file)
        with study_file.name_in_errors(path):
            is_record = record_kind(read_input(path)) is not None
            content = study_record.read_study(path) if is_record else study_file.read(path)
            study = cls(**vars(content))
            runs = study.runs()  # a wrong scene is the file's error
            if is_record:
                study_record.note_other_runs(path, runs)
        return study

    def to_toml(self) -> str:
        """Return the study as the text of a study file, which `load` reads.

        Raises
        ------
        InputError
            If the study holds a value that TOML cannot express.

        Examples
        --------
        >>> scene = Scene().update({"dimension": 2, "panel.height": 1.5})
        >>> print(Study.product(scene, {"panel.tilt": [40, 50]}, name="tilts", seeds=[1]).to_toml())
        name = "tilts"
        seeds = [1]
        <BLANKLINE>
        [scene]
        snowshed = 2
        dimension = 2
        panel.height = 1.5
        <BLANKLINE>
        [axes]
        panel.tilt = [40, 50]
        <BLANKLINE>
        """
        return study_file.text(self._content)

    def save(self, file: PathLike) -> None:
        """Write the study to a study file; see `to_toml`."""
        write_text(file, self.to_toml())

    def __post_init__(self) -> None:
        object.__setattr__(self, "scene", self.scene.copy())
        if not self.name or not self.name.isprintable():
            raise InputError(f"name: {self.name!r} is not a name of printable characters")
        if self.laws is not None:
            self.laws.laws()  # a wrong name is the study's error
        if not self.parts:
            raise InputError("has no parts; give at least one, which may be empty")
        count = sum(math.prod(len(factor) for factor in part) for part in self._seeded_parts())
        if count > MAX_RUNS:  # before the values are checked, which takes long for many
            raise InputError(f"has {count} runs; at most {MAX_RUNS} are allowed")
        for part in self.parts:
            self._check(part)
        note_on_unusual_values(self.scene, self.parts)

    @property
    def axes(self) -> list[str]:
        """The dotted paths of the parameters that vary, without the seeds."""
        paths = (path for part in self.parts for factor in part for path in factor.columns)
        return list(dict.fromkeys(paths))

    def runs(self) -> list[RunKey]:
        """Return the runs in order, the last factor varying fastest, seeds faster still.

        Raises
        ------
        InputError
            If the scene of a run is wrong; the message has its values.
        OSError
            If a file that the scene names cannot be read.
        """
        runs: dict[str, RunKey] = {}
        for point in self._points():
            run = self._run(point)
            runs.setdefault(run.hash, run)
        return list(runs.values())

    def compute(
        self,
        folder: PathLike,
        *,
        jobs: Optional[int] = None,
        threads: Optional[int] = None,
        scheduler: object = None,
        retry_failed: bool = False,
        keep_particles: bool = False,
        same_version: bool = False,
        progress: Optional[Reporter] = None,
    ) -> None:
        """Compute the runs that are missing in the store in `folder`.

        After an interruption, even a kill, the same call resumes. The results are the same, bit for
        bit, as without the interruption. The record ``NAME.json`` in the folder is enough to
        compute the study again (`snowshed.repeat`).

        Parameters
        ----------
        folder
            Folder of the store: new, empty, or with a store in it, which studies may share. A study
            of the same name is replaced; its computed runs stay.
        jobs
            Local processes at once; None: as many as there are cores, or graphics cards if the runs
            ask for one.
        threads
            Threads of each run; None: as many as use all cores.
        scheduler
            Address of a Dask scheduler (or its .json file, a cluster or a client) that computes
            instead of local processes.
        retry_failed
            Whether to compute failed runs again.
        keep_particles
            Whether to store the particles after each event, too, for runs that are not computed
            yet, so that `snowshed.study.remeasure` can measure their stacks differently.
        same_version
            Whether results of another build of the same version count. Otherwise, a note says how
            many runs are computed again; the earlier results stay in the store.
        progress
            Called with a `Progress` a few times a second.

        Raises
        ------
        InputError
            If a scene is wrong, or the folder cannot be used.
        StudyError
            If the study cannot continue, for example because the disk is full. Computed results are
            safe.
        StudyInterrupted
            After Ctrl-C.
        """
        runs = self.runs()
        try:
            session.compute_runs(
                folder,
                self.name,
                self.axes,
                runs,
                jobs=jobs,
                threads=threads,
                scheduler=scheduler,
                retry_failed=retry_failed,
                keep_particles=keep_particles,
                same_version=same_version,
                progress=progress,
            )
        except StudyInterrupted:
            study_record.write_record(folder, self._content, runs)
            raise
        study_record.write_record(folder, self._content, runs)

    def run(
        self,
        folder: PathLike,
        *,
        jobs: Optional[int] = None,
        threads: Optional[int] = None,
        scheduler: object = None,
        retry_failed: bool = False,
        keep_particles: bool = False,
        same_version: bool = False,
        progress: Optional[Reporter] = None,
    ) -> pd.DataFrame:
        """Compute the runs that are missing in the store in `folder`, and return the study's table.

        Parameters
        ----------
        folder, jobs, threads, scheduler, retry_failed, keep_particles, same_version, progress
            As for `compute`, which raises the same errors.

        Returns
        -------
        pandas.DataFrame
            The study's table, as `read_table` returns it; failed runs are rows in it, and a note.

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
        self.compute(
            folder,
            jobs=jobs,
            threads=threads,
            scheduler=scheduler,
            retry_failed=retry_failed,
            keep_particles=keep_particles,
            same_version=same_version,
            progress=progress,
        )
        _issue_failures(folder, self.name)
        return read_table(folder, self.name)

    def expected_duration(self, *, jobs: Optional[int] = None) -> tuple[float, int]:
        """Return the expected time of all runs on this machine, s, and the number of runs at once.

        The machine's speed is measured for a fraction of a second.

        Parameters
        ----------
        jobs
            As for `compute`.
        """
        return session.expected_duration([run.scene for run in self.runs()], jobs=jobs)

    @property
    def _content(self) -> study_file.Content:
        return study_file.Content(
            self.scene,
            self.parts,
            self.name,
            self.seeds,
            self.description,
            self.season,
            self.laws,
        )

    def _seeded_parts(self) -> Iterator[Part]:
        seeds = [] if self.seeds is None else [axis(SEED, self.seeds)]
        for part in self.parts:
            yield [*part, *seeds]

    def _points(self) -> Iterator[dict[str, object]]:
        for part in self._seeded_parts():
            for points in itertools.product(*(factor.points() for factor in part)):
                yield {path: value for point in points for path, value in point.items()}

    def _run(self, point: Mapping[str, object]) -> RunKey:
        try:
            resolved = self.scene.with_(point).resolve()
            if self.season is not None:
                return self.season.run(resolved, self.laws)
            return RunKey.of(resolved, laws=self.laws)
        except InputError as error:
            values = ", ".join(f"{path} = {value}" for path, value in point.items())
            raise InputError(f"{values}: {error}" if values else str(error)) from None

    def _check(self, part: Part) -> None:
        paths = [path for factor in part for path in factor.columns]
        for path in paths:
            if paths.count(path) > 1:
                raise InputError(f"{path}: varied by two factors of the same product")
            inner = next((other for other in paths if other.startswith(f"{path}.")), None)
            if inner is not None:
                raise InputError(f"{path}: contains {inner}, which varies in the same product")
            if any(path == name or path.startswith(f"{name}.") for name in WITHOUT_EFFECT):
                raise InputError(f"{path}: cannot be varied; it does not change a result")
            if self.season is not None and any(path.startswith(name) for name in SEASON_PATHS):
                raise InputError(f"{path}: cannot be varied; the weather of the season sets it")
        if self.seeds is not None and SEED in paths:
            raise InputError(f"{SEED}: varied by a factor and by the study's seeds")
        scene = self.scene.copy()
        for factor in part:
            for path, values in factor.columns.items():
                _check_values(scene, path, values, another_method="method" in paths)


def _issue_failures(folder: PathLike, study: str) -> None:
    """Issue a note on the runs that failed."""
    with Store.open(folder) as store:
        runs = store.runs(study)
    failed = [run for run in runs if run.status == "failed"]
    if failed:
        first = f"{failed[0].hash[:12]}: {failed[0].error}"
        issue_note(f"{len(failed)} of {len(runs)} runs failed: {first}", ResultNote)


def _check_values(
    scene: Scene, path: str, values: Sequence[object], *, another_method: bool
) -> None:
    """Refuse a path that the scene lacks and values of a wrong type; leave the first value set.

    Where the method varies, the types of other values do, too; the run with a wrong one raises the
    error.
    """
    try:
        scene.set(path, None)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    for value in (*values, values[0]):
        try:
            scene.set(path, value)
        except InputError as error:
            if not another_method:
                raise InputError(f"{path} = {shown(value)}: {error}") from None
