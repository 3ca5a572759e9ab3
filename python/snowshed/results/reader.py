"""Reading a results folder: tables as pandas, particles and histories as xarray."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, cast

import numpy as np

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.extras import require
from snowshed.base.missing_result import MissingResultError
from snowshed.base.paths import PathLike
from snowshed.base.units import unit_of_column
from snowshed.io.csv_table import read_csv
from snowshed.io.film import FILM, Film
from snowshed.io.json_file import read_object
from snowshed.io.run_files import check_run_file, issue_unfinished_note, read_run_record
from snowshed.io.vtk.pvd import read_series
from snowshed.io.vtk.vtp import read_particles
from snowshed.methods.registry import method_of
from snowshed.methods.summary import Summary
from snowshed.results.film import film_dataset, run_film
from snowshed.results.folder import ENERGY, EVENTS, event_table, read_scene
from snowshed.results.grid import grid_dataset, stored_grid
from snowshed.results.html import results_html
from snowshed.results.method_results import MethodResults
from snowshed.results.obstacle_forces import FacePressures
from snowshed.results.particle_dataset import particle_dataset
from snowshed.results.particle_table import particle_table
from snowshed.results.provenance import recorded_origin, with_origin
from snowshed.scene.scene import ResolvedScene
from snowshed.snow.stack.measure import StackMeasure

if TYPE_CHECKING:
    import pandas as pd
    import xarray

HISTORY = "energy_history.csv"


@checked
class Results(MethodResults):
    """The results folder of a run, as `snowshed.run` and ``snowshed run`` write it.

    All methods have particles, a film and, on request, energies. Further attributes depend on the
    method: `events`, `stack`, `forces`, `loads` and `pressures`, or `summary`, `maps`, `curve` and
    `forces`. An attribute that the method of the scene does not have, or that the run did not
    write, raises an InputError that is also an AttributeError: `hasattr` returns False.

    A note says if the run is not finished. Files are read on access. Every table has a dict of
    units by column in ``attrs["units"]``, every variable of a Dataset its ``units`` and
    ``long_name`` in `attrs`. A damaged file raises InputError.

    Parameters
    ----------
    folder
        The folder; it holds a ``scene.json``.

    Raises
    ------
    InputError
        If it is not a results folder.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene, run_events
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}})
    >>> with TemporaryDirectory() as folder:
    ...     _ = run_events(tiny, folder, pictures=False)
    ...     results = Results(folder)
    ...     results.events.attrs["units"]["height_m"], results.run["status"]
    ('m', 'finished')
    """

    def __init__(self, folder: PathLike) -> None:
        self.folder = Path(folder)
        if not (self.folder / "scene.json").is_file():
            raise InputError(f"{folder}: no results; it holds no scene.json")
        read_scene(self.folder)  # a damaged scene is refused before any note
        issue_unfinished_note(self.folder)

    @classmethod
    def of_run(cls, folder: PathLike, scene: ResolvedScene) -> Results:
        """Return the results of a run of this process, whose scene is in memory."""
        results = cls.__new__(cls)
        vars(results).update(folder=Path(folder), scene=scene)
        return results

    @cached_property
    def scene(self) -> ResolvedScene:
        """The complete scene that made the results."""
        return read_scene(self.folder)

    @property
    def run(self) -> dict[str, object]:
        """Version, machine, size, speed and status of the run (run.json)."""
        path = self.folder / "run.json"
        if not path.is_file():
            raise MissingResultError(f"{path}: missing; a run writes it with its first checkpoint")
        return dict(read_object(path))

    @property
    def events(self) -> pd.DataFrame:
        """One row per event: its stack, duration and end (events.csv)."""
        if not (self.folder / EVENTS).is_file():
            method = method_of(self.scene.data)
            if "stack" not in method.results:
                raise method.missing("events", self.folder)
            path = self.folder / EVENTS
            raise MissingResultError(f"{path}: missing; a run that ended an event writes it")
        return with_origin(event_table(self.folder), self._origin)

    @property
    def outline(self) -> pd.DataFrame:
        """The profile of the stack after each event: event, x and z, m (outline.csv)."""
        table = self._numbers("outline.csv", ("event", "x", "z"), "a run that ended an event")
        table.attrs["units"] = {"x": "m", "z": "m"}
        return with_origin(table, self._origin)

    @property
    def energy(self) -> xarray.Dataset:
        """The energy balance at the end of each event, J, along ``event`` (energy.csv).

        Needs xarray (extra ``study``).
        """
        table = self._numbers(ENERGY, ("event",), "a run with output.energy = true")
        library = require("xarray", "study", "a Dataset of energies")
        dataset: xarray.Dataset = library.Dataset.from_dataframe(table.set_index("event"))
        for name in dataset.data_vars:
            dataset[name].attrs["units"] = unit_of_column(str(name))
        return with_origin(dataset, self._origin)

    @property
    def energy_history(self) -> pd.DataFrame:
        """The energy balance over time, J: at least at both ends of events (energy_history.csv)."""
        columns = ("event", "time_s", "added_j")
        table = self._numbers(HISTORY, columns, "a run with output.energy = true")
        table.attrs["units"] = {str(name): unit_of_column(str(name)) for name in table.columns[1:]}
        return with_origin(table, self._origin)

    def particles(self, event: Optional[int] = None) -> xarray.Dataset:
        """Return the particles after an event.

        Parameters
        ----------
        event
            Its number, from 1; None: the last event.

        Returns
        -------
        xarray.Dataset
            Dimensions ``particle``, with the ids, and ``component``.
        """
        number, file = self._stored_event(event)
        dataset = particle_dataset(read_particles(file), number, self._duration(number))
        return with_origin(dataset, self._origin)

    def particle_table(self, event: Optional[int] = None) -> pd.DataFrame:
        """Return the particles after an event, as for `particles`, as a table; needs no xarray.

        Returns
        -------
        pandas.DataFrame
            A row for each particle, by id, with columns such as ``position_x`` and ``density``.
        """
        _, file = self._stored_event(event)
        return with_origin(particle_table(read_particles(file)), self._origin)

    def grid(self, event: Optional[int] = None) -> xarray.Dataset:
        """Return mass, velocity and density at the nodes of the grid after an event.

        They are computed from the stored particles, for runs by the material point method. With
        APIC the share of the affine velocities is missing; `Simulation.grid` includes it. The event
        is chosen as for `particles`.

        Returns
        -------
        xarray.Dataset
            Dimensions x, (y,) z, the nodes, and component.
        """
        number, file = self._stored_event(event)
        dataset = grid_dataset(stored_grid(self.scene.data, file), number, self._duration(number))
        return with_origin(dataset, self._origin)

    def _stored_event(self, event: Optional[int]) -> tuple[int, Path]:
        """Return the number of an event, the last by default, and the file of its particles."""
        file_by_event = {
            int(digits): file
            for file in (self.folder / "particles").glob("event_*.vtp")
            if (digits := file.stem.rpartition("_")[2]).isdecimal()
        }
        if not file_by_event:
            raise InputError(f"{self.folder / 'particles'}: holds no particles")
        number = max(file_by_event) if event is None else event
        if number not in file_by_event:
            allowed = ", ".join(map(str, sorted(file_by_event)))
            raise InputError(f"event: {event!r}; {self.folder / 'particles'} has {allowed}")
        return number, file_by_event[number]

    def _duration(self, event: int) -> float:
        """Return the duration of an event; only runs that make stacks have a table of events."""
        if (self.folder / EVENTS).is_file():
            return float(self.events.set_index("event")["sim_time_s"][event])
        finished = cast("Mapping[str, Any]", self.run)["finished_events"]
        return next(float(facts["sim_time_s"]) for facts in finished if facts["event"] == event)

    def snapshots(self) -> Iterator[xarray.Dataset]:
        """Yield the particles of each snapshot in order, in the form of `particles`.

        Their ``time`` counts through all events.
        """
        path = self.folder / "snapshots" / "snapshots.pvd"
        if not path.is_file():
            raise InputError(f"{path}: missing; a run with output.snapshot_interval writes it")
        for time, file in read_series(path):
            values = read_particles(file)
            dataset = particle_dataset(values, int(values["event"].max(initial=0)), time)
            yield with_origin(dataset, self._origin)

    @property
    def stack(self) -> StackMeasure:
        """The measure of the stack after the last event, from the stored particles."""
        return cast("StackMeasure", self.result("stack"))

    @property
    def loads(self) -> pd.DataFrame:
        """The loads on each obstacle in each event: at rest, peaks and impulse (loads.csv)."""
        return cast("pd.DataFrame", self.result("loads"))

    @property
    def pressures(self) -> FacePressures:
        """The pressures on the faces of obstacles after the last event (``pressures/``)."""
        return cast("FacePressures", self.result("pressures"))

    @property
    def summary(self) -> Summary:
        """The figures of a slide or a loading test, as attributes."""
        return cast("Summary", self.result("summary"))

    def result(self, name: str) -> object:
        """Return a result of the scene's method by its name, such as "maps"."""
        value: object = method_of(self.scene.data).read(name, self.folder)
        return with_origin(value, self._origin)

    @property
    def film(self) -> Film:
        """The recorded film of the run, read frame by frame (film.bin)."""
        path = self.folder / FILM
        if not path.is_file():
            raise MissingResultError(f"{path}: missing; a run with output.film = true writes it")
        return run_film(path, read_run_record(self.folder))

    def film_dataset(self, every: int = 1) -> xarray.Dataset:
        """Return the film, or every `every`-th frame of it, as a Dataset.

        Dimensions ``frame``, ``particle`` and ``component``; ``time`` counts through all events.
        A position is exact to half a millimetre, and finer where the scene is small.
        """
        return with_origin(film_dataset(self.film, every), self._origin)

    @cached_property
    def _origin(self) -> dict[str, str]:
        return recorded_origin(self.scene, read_run_record(self.folder))

    def _numbers(self, name: str, columns: tuple[str, ...], writer: str) -> pd.DataFrame:
        """Return a table whose numbers are all finite."""
        path = self.folder / name
        if not path.is_file():
            raise MissingResultError(f"{path}: missing; {writer} writes it")
        check_run_file(path)
        table = read_csv(path)
        if missing := [column for column in columns if column not in table]:
            raise InputError(f"{path}: no column {', '.join(missing)}")
        for column in table if len(table) else ():
            if table[column].dtype.kind not in "if" or not np.isfinite(table[column]).all():
                raise InputError(f"{path}: no finite numbers in the column {column}")
        return table

    def __repr__(self) -> str:
        return f"Results({str(self.folder)!r})"

    def _repr_html_(self) -> str:
        """Return the picture and the table of the results for notebooks."""
        figures = {}
        if hasattr(self, "summary"):
            figures = {name: getattr(self.summary, name) for name in type(self.summary).columns()}
        return results_html(
            str(self.scene.data.get("title") or ""),
            self.folder,
            self.events if hasattr(self, "events") else None,
            figures,
            read_run_record(self.folder).get("notes", ()),
        )


def particle_files(folder: Path, *, snapshots: bool) -> list[Path]:
    """Return the files of the particles after events, or of the snapshots, in order.

    Raises
    ------
    InputError
        If there are no such files.
    """
    where, name = ("snapshots", "snapshot_*.vtp") if snapshots else ("particles", "event_*.vtp")
    files = sorted((folder / where).glob(name))
    if not files:
        raise InputError(f"{folder / where}: holds no particles")
    return files
