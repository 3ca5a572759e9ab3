"""The fields of a simulation: quantities of its particles, read from their memory.

Positions and velocities have the components x, y and z, in 2D, too, where y is zero.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, Optional

import numpy as np

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arrays import Numbers
from snowshed.results.particle_dataset import AXES

#: Fields whose components are fields, too.
VECTORS = ("position", "velocity")
Order = Literal["id", "storage"]


def checked_order(order: Order) -> Order:
    """Return an order of particles.

    Raises
    ------
    InputError
        If it is neither "id" nor "storage".
    """
    if order not in ("id", "storage"):
        raise InputError(f'order: {order!r}; allowed: "id", "storage"')
    return order


@dataclass(frozen=True)
class Field:
    """A quantity of all particles; each access reads the present values.

    Attributes
    ----------
    name, unit, description
        Name, SI unit ("1" where it has none) and meaning.
    dtype
        Type of the elements of `values`.
    stored
        Whether the particles store this quantity, so that `values` is a view; otherwise `values` is
        computed.

    Examples
    --------
    >>> from snowshed import Scene, Simulation
    >>> simulation = Simulation(Scene.preset("lab-50").update({"dimension": 2}))
    >>> simulation.begin_event()
    >>> simulation.fields["density"]
    Field('density', 'kg/m3', 'Current density', float64, computed)
    """

    name: str
    unit: str
    description: str
    dtype: np.dtype[np.generic]
    stored: bool
    _simulation: _core.Simulation = field(repr=False)
    _part: Optional[tuple[str, int]] = field(default=None, repr=False)  # of a vector: its column

    @property
    def values(self) -> Numbers:
        """The values, in the order of storage; an array that cannot be written to.

        Where `stored`, the array shows the particles' memory without a copy. It is valid until the
        next call that changes the simulation. Then take a new one, because particles move to other
        memory when they are sorted, and the old array may show anything; copy values that you need
        later. The array never points to freed memory. Between two such calls all fields have the
        same order.
        """
        if self._part is not None:
            name, column = self._part
            return self._simulation.field(name)[:, column]
        return self._simulation.field(self.name)

    def by_id(self) -> Numbers:
        """Return a copy ordered by the particles' ids, in double precision or 64-bit integers."""
        if self._part is not None:
            name, column = self._part
            return self._simulation.field_by_id(name)[:, column].copy()
        return self._simulation.field_by_id(self.name)

    def __repr__(self) -> str:
        how = "stored" if self.stored else "computed"
        return f"Field({self.name!r}, {self.unit!r}, {self.description!r}, {self.dtype}, {how})"


def _components(vector: Field) -> list[Field]:
    return [
        replace(
            vector,
            name=f"{vector.name}_{axis}",
            description=f"{vector.description}; component {axis}",
            stored=False,
            _part=(vector.name, column),
        )
        for column, axis in enumerate(AXES)
    ]


class Fields(Mapping[str, Field]):
    """The fields of a simulation by name; a KeyError lists the names."""

    def __init__(self, core: _core.Simulation) -> None:
        stored = {info[0]: Field(*info, core) for info in core.fields()}
        self._fields: dict[str, Field] = {}
        for name, given in stored.items():
            self._fields.setdefault(name, given)
            for part in _components(given) if name in VECTORS else ():
                self._fields[part.name] = stored.get(part.name, part)

    def __getitem__(self, name: str) -> Field:
        try:
            return self._fields[name]
        except KeyError:
            raise KeyError(f"no field {name!r}; allowed: {', '.join(self._fields)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def __repr__(self) -> str:
        return f"Fields({', '.join(self._fields)})"
