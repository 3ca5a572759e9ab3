"""The contacts between grains at a time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import snowshed._core as _core
from snowshed.base.arrays import Booleans, Floats, Integers
from snowshed.base.core_simulation import AnySimulation, core_of
from snowshed.base.missing_result import MissingResultError
from snowshed.base.units import with_units
from snowshed.io.csv_table import read_csv
from snowshed.io.run_files import check_run_file

if TYPE_CHECKING:
    import pandas as pd

CONTACTS = "contacts.csv"  # in the results folder


@dataclass(frozen=True)
class GrainContacts:
    """Grains that touch, and the spheres they consist of.

    Attributes
    ----------
    spheres : (s, 3)
        Centres, m.
    sphere_grains : (s,)
        The grain of each sphere.
    grains : (n, 2)
        The two grains of each contact.
    points : (n, 3)
        Points of contact, m.
    forces : (n, 3)
        Force on the first of the two grains, N.
    bonded : (n,)
        Whether a bond still holds them together.
    """

    spheres: Floats
    sphere_grains: Integers
    grains: Integers
    points: Floats
    forces: Floats
    bonded: Booleans

    @property
    def centres(self) -> Floats:
        """Mean of the spheres of each grain, (g, 3), m."""
        count = np.bincount(self.sphere_grains)
        sums = [np.bincount(self.sphere_grains, self.spheres[:, axis]) for axis in range(3)]
        return np.asarray(np.stack(sums, axis=1) / count[:, None])

    def arms(self, side: int) -> tuple[Floats, Booleans]:
        """Return the vectors from the first (0) or second (1) grains' centres to the contacts.

        The second array, (n,), is False for vectors that leave a periodic sample at one side and
        enter it at the other.
        """
        arms = self.points - self.centres[self.grains[:, side]]
        half = 0.5 * np.ptp(self.spheres, axis=0)
        return arms, np.asarray((np.abs(arms) <= half).all(axis=1))

    @property
    def normal_forces(self) -> Floats:
        """Force of each contact along the line of its grains' centres, pressing > 0, (n,), N."""
        (to, first), (back, second) = self.arms(0), self.arms(1)
        line = np.where(second[:, None], back, 0.0) - np.where(first[:, None], to, 0.0)
        length = np.maximum(np.linalg.norm(line, axis=1), 1e-300)
        return np.asarray(np.einsum("ij,ij->i", self.forces, line) / length)

    def table(self) -> pd.DataFrame:
        """Return the contacts as a table, a row each; ``attrs["units"]`` has the units."""
        import pandas as pd

        columns: dict[str, Any] = {"grain": self.grains[:, 0], "other": self.grains[:, 1]}
        columns.update({f"{axis}_m": self.points[:, k] for k, axis in enumerate("xyz")})
        columns.update({f"force_{axis}_n": self.forces[:, k] for k, axis in enumerate("xyz")})
        columns["bonded"] = self.bonded.astype(int)
        return with_units(pd.DataFrame(columns))

    def text(self) -> str:
        """Return the contacts as CSV."""
        lines = ["grain,other,x_m,y_m,z_m,force_x_n,force_y_n,force_z_n,bonded"]
        for pair, point, force, bonded in zip(self.grains, self.points, self.forces, self.bonded):
            numbers = (repr(float(value)) for value in (*point, *force))
            lines.append(",".join([str(pair[0]), str(pair[1]), *numbers, str(int(bonded))]))
        return "\n".join(lines) + "\n"


def grain_contacts(simulation: AnySimulation) -> GrainContacts:
    """Return the grains that touch now.

    Parameters
    ----------
    simulation
        A `snowshed.Simulation`.

    Raises
    ------
    InputError
        If the scene's method is another.
    """
    core = core_of(simulation)
    spheres, grain = core.grains_spheres()
    return GrainContacts(spheres, grain, *core.grains_contacts())


def read_forces(folder: Path) -> pd.DataFrame:
    """Read the contacts between grains, and their forces, at the end of a loading test.

    Returns
    -------
    pandas.DataFrame
        A row per contact: the numbers of its two grains, the point of contact, the force on the
        first grain, and whether a bond holds them together; ``attrs["units"]`` has the units.

    Raises
    ------
    MissingResultError
        If they are missing.
    InputError
        If they are damaged.
    """
    file = folder / CONTACTS
    if not file.is_file():
        raise MissingResultError(f"{file}: missing; a run writes it at its end")
    check_run_file(file)
    return with_units(read_csv(file))


def present_forces(core: _core.Simulation, scene: Mapping[str, Any]) -> pd.DataFrame:
    """Return the contacts of a loading test now, as `read_forces` does."""
    return grain_contacts(core).table()
