"""The particles of a simulation as arrays, tables and Datasets."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

import snowshed._core as _core
from snowshed.base.arrays import Booleans, Floats, Integers, Numbers
from snowshed.results.fields import Fields, Order, checked_order
from snowshed.results.grid import grid_dataset, scene_grid
from snowshed.results.method_results import MethodResults
from snowshed.results.particle_dataset import DATASET, particle_dataset
from snowshed.results.particle_table import particle_table
from snowshed.results.provenance import present_origin, with_origin
from snowshed.scene.scene import ResolvedScene

if TYPE_CHECKING:
    import pandas as pd
    import xarray


class ReadsParticles(MethodResults):
    """The part of a simulation that reads its particles."""

    _core: _core.Simulation
    _scene: ResolvedScene

    @property
    def scene(self) -> ResolvedScene:
        """The complete scene."""
        return self._scene

    @property
    def event(self) -> int:
        """The number of the present event, from 1; 0 before the first."""
        return self._core.event

    @property
    def time(self) -> float:
        """Time in the present event, s."""
        return self._core.time_s

    @property
    def fields(self) -> Fields:
        """The quantities of the particles by name, in the order of storage, without copies."""
        return Fields(self._core)

    def positions(self, order: Order = "id") -> Floats:
        """Return the positions (n, 3), m; always a copy, since they are stored cell by cell.

        Parameters
        ----------
        order
            "id": a copy ordered by the particles' ids, in double precision and 64-bit integers.
            "storage": as `Field.values` of `fields`. All methods that read particles have this
            parameter.
        """
        return cast(Floats, self._read("position", order))

    def velocities(self, order: Order = "id") -> Floats:
        """Return the velocities (n, 3), m/s; a copy. The fields velocity_x, ... are views."""
        return cast(Floats, self._read("velocity", order))

    def masses(self, order: Order = "id") -> Floats:
        """Return the masses (n,), kg (per metre of width in 2D)."""
        return cast(Floats, self._read("mass", order))

    def densities(self, order: Order = "id") -> Floats:
        """Return the current densities (n,), kg/m3; computed."""
        return cast(Floats, self._read("density", order))

    def pressures(self, order: Order = "id") -> Floats:
        """Return the Kirchhoff pressures (n,), Pa, positive in compression; computed."""
        return cast(Floats, self._read("pressure", order))

    def plastic_strains(self, order: Order = "id") -> Floats:
        """Return the volumetric plastic strains (n,), negative in compaction."""
        return cast(Floats, self._read("volumetric_plastic_strain", order))

    def ids(self, order: Order = "id") -> Integers:
        """Return the ids (n,) of the particles."""
        return cast(Integers, self._read("id", order))

    def events(self, order: Order = "id") -> Integers:
        """Return the events (n,) that released the particles, from 1."""
        return cast(Integers, self._read("event", order))

    def material_ids(self, order: Order = "id") -> Integers:
        """Return the index into `snows` of each particle (n,)."""
        return cast(Integers, self._read("material_id", order))

    def on_panel(self, order: Order = "id") -> Booleans:
        """Return whether each particle (n,) lies on the panel."""
        on_panel = self._core.on_panel()
        if checked_order(order) == "storage":
            by_id, on_panel = on_panel, np.empty_like(on_panel)
            on_panel[self._core.order_by_id()] = by_id
        return on_panel

    def _read(self, name: str, order: Order) -> Numbers:
        read = self._core.field_by_id if checked_order(order) == "id" else self._core.field
        return read(name)

    def to_dataframe(self) -> pd.DataFrame:
        """Return the particles as a table, a row each, by id; copies.

        Returns
        -------
        pandas.DataFrame
            Columns such as ``position_x``, ``position_y``, ``position_z``, ``mass``; units by
            column in ``attrs["units"]``.

        Examples
        --------
        >>> from snowshed import Scene, Simulation
        >>> simulation = Simulation(Scene.preset("lab-50").update({"dimension": 2}))
        >>> simulation.begin_event()
        >>> len(simulation.to_dataframe()) == simulation.particle_count
        True
        """
        return with_origin(particle_table(self._values()), present_origin(self.scene))

    def _values(self) -> dict[str, Numbers]:
        return {name: self._core.field_by_id(name) for name in DATASET if name in self.fields}

    def to_xarray(self) -> xarray.Dataset:
        """Return the particles as a Dataset, ordered by id; copies.

        Returns
        -------
        xarray.Dataset
            Dimensions ``particle``, with the ids, and ``component``; units in `attrs`.

        Raises
        ------
        InputError
            If xarray (extra ``study``) is not installed.
        """
        dataset = particle_dataset(self._values(), self.event, self.time)
        return with_origin(dataset, present_origin(self.scene))

    def grid(self) -> xarray.Dataset:
        """Return mass, velocity and density at the nodes of the grid, computed from the particles.

        The next step of the material point method would begin with them.

        Returns
        -------
        xarray.Dataset
            Dimensions x, (y,) z, the nodes, m, and component.

        Raises
        ------
        InputError
            If the method has no grid, there are no particles, or xarray (extra ``study``) is not
            installed.
        """
        affine = cast(Floats, self._read("affine", "id")) if "affine" in self.fields else None
        arrays = self.positions(), self.velocities(), self.masses(), affine
        fields = scene_grid(self.scene.data, *arrays)
        dataset = grid_dataset(fields, self.event, self.time)
        return with_origin(dataset, present_origin(self.scene))
