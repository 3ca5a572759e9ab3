"""The error of a stack, measured by repeating its scene on coarser grids and with other seeds.

Three seeds on each of three grids give means and their scatter. The means are extrapolated linearly
in dx to dx = 0. The error is assumed to be linear, because contact of snow with snow and ground
errs by about a cell.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.paths import PathLike
from snowshed.base.progress import Reporter
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.methods.registry import settings_of
from snowshed.scene.scene import ResolvedScene, Scene
from snowshed.study.definition import Study

if TYPE_CHECKING:
    import pandas as pd

#: Sizes of the cells over those of the scene, and seeds on each grid.
WIDTHS = (1.0, 2**0.5, 2.0)
SEEDS = (1, 2, 3)
#: Measures that are compared, by their columns.
COMPARED_QUANTITIES: Mapping[str, str] = {
    "height": "height_m",
    "length": "length_m",
    "centre of mass": "centre_height_m",
    "spread": "spread_m",
}


@dataclass(frozen=True)
class MeasuredError:
    """The error of one measure of a stack.

    Attributes
    ----------
    name
        Name of the measure.
    means : tuple of float
        Mean over the seeds on each grid, from the finest, m.
    scatter
        Standard deviation of a single run over the seeds, relative to the mean.
    limit
        Value of the straight line through the means at cells of size zero, m.
    limit_error
        Standard error of that value, m.

    Examples
    --------
    >>> error = MeasuredError("height", (0.11, 0.114, 0.12), 0.02, 0.1, 0.002)
    >>> error.sentence
    'height 0.110 m (scatter of a run 2 %): 10 % above the limit of fine grids, 0.100 ± 0.002 m'
    """

    name: str
    means: tuple[float, ...]
    scatter: float
    limit: float
    limit_error: float

    @property
    def bias(self) -> float:
        """Deviation of the mean on the finest grid from the limit, relative to the limit."""
        return self.means[0] / self.limit - 1

    @property
    def sentence(self) -> str:
        """The error in a sentence."""
        side = "above" if self.bias > 0 else "below"
        deviation = (
            f"{100 * abs(self.bias):.0f} % {side} the limit of fine grids, "
            if self.limit > 0
            else "the limit of fine grids is not positive, so the grid is too coarse: "
        )
        return (
            f"{self.name} {self.means[0]:.3f} m (scatter of a run {100 * self.scatter:.0f} %): "
            f"{deviation}{self.limit:.3f} ± {self.limit_error:.3f} m"
        )


def check_has_companions(scene: ResolvedScene) -> None:
    """Raise InputError unless the scene lays slabs and uses the material point method."""
    if not isinstance(settings_of(scene.data), MpmSettings) or scene.data.get("slab") is None:
        raise InputError("the error is measured for slabs of the material point method only")


def companions(scene: Scene) -> Study:
    """Return the study of a scene on its own and on coarser grids, with several seeds.

    Raises
    ------
    InputError
        If the scene lays no slabs, or uses another method than the material point method.

    Examples
    --------
    >>> len(companions(Scene.preset("lab-50")).runs())
    9
    """
    resolved = scene.resolve()
    check_has_companions(resolved)
    sizes = [float(f"{width * resolved.data['numerics']['dx']:.6g}") for width in WIDTHS]
    return Study.product(scene, {"numerics.dx": sizes}, name="check", seeds=SEEDS)


def measured_errors(
    scene: Scene, folder: PathLike, *, progress: Optional[Reporter] = None
) -> list[MeasuredError]:
    """Run the companions of a scene, and return the errors of its last stack.

    After an interruption the same call resumes.

    Parameters
    ----------
    scene
        The scene.
    folder
        Folder of the study's store.
    progress
        Called with the state of the runs.

    Returns
    -------
    list of MeasuredError
        One for each of `COMPARED_QUANTITIES`.

    Raises
    ------
    InputError
        If the scene is wrong, or a run failed.
    """
    table = companions(scene).run(folder, progress=progress)
    failed = [str(error) for error in table["error"].dropna() if error]
    if failed:
        raise InputError(f"{folder}: {len(failed)} of the companions failed: {failed[0]}")
    last = table[table["event"] == table["event"].max()]
    return [errors_of(name, last, column) for name, column in COMPARED_QUANTITIES.items()]


def errors_of(name: str, table: pd.DataFrame, column: str) -> MeasuredError:
    """Return the error of one column from a table of runs with several dx and seeds.

    Examples
    --------
    >>> import pandas as pd
    >>> rows = [(dx, 0.1 + dx + s) for dx in (0.01, 0.014, 0.02) for s in (-0.001, 0, 0.001)]
    >>> table = pd.DataFrame(rows, columns=["numerics.dx", "height_m"])
    >>> error = errors_of("height", table, "height_m")
    >>> round(error.limit, 6), round(error.bias, 6), error.limit_error < 0.002
    (0.1, 0.1, True)
    """
    groups = table.groupby("numerics.dx")[column]
    sizes = np.sort(table["numerics.dx"].unique().astype(float))
    means = np.array([groups.get_group(size).mean() for size in sizes])
    variance = float(np.mean([groups.get_group(size).var(ddof=1) for size in sizes]))
    counts = np.array([len(groups.get_group(size)) for size in sizes])
    # Least squares with equal weights: the limit is a weighted sum of the means.
    design = np.column_stack([np.ones_like(sizes), sizes])
    weights = np.linalg.pinv(design)[0]
    return MeasuredError(
        name=name,
        means=tuple(float(mean) for mean in means),
        scatter=float(np.sqrt(variance) / means[0]),
        limit=float(weights @ means),
        limit_error=float(np.sqrt(variance * np.sum(weights**2 / counts))),
    )
