"""Candidate release areas: parts of the terrain where slabs may be released, by its shape.

The rules follow Bühler et al. (2013), doi:10.5194/nhess-13-1321-2013, and Bühler et al. (2018),
doi:10.5194/nhess-18-3235-2018. They know neither snow nor wind nor weather.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.hazard.candidate_cells import (
    connected_cells,
    covered_cells,
    nearest_values,
    split_by_sectors,
    without_gaps,
    without_small,
)
from snowshed.analysis.hazard.terrain_shape import TerrainShape, terrain_shape
from snowshed.base.arguments import checked
from snowshed.base.arrays import Booleans, Floats, Integers
from snowshed.base.callers import argument
from snowshed.base.limits import MAX_CORNERS, MAX_POLYGONS
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.raster.areas import MapArea, Ring
from snowshed.io.raster.cell_outlines import cell_outlines, corner_count
from snowshed.io.raster.raster import Raster
from snowshed.scene.builders.terrain_checks import check_terrain, common_system

CAUTION = "candidate by the shape of the terrain alone, not a hazard assessment"
#: Cells for which the rules were made, m; other cells within a factor of two are taken silently.
RULE_CELL = 5.0
MAX_SECTORS = 72
MIN_WINDOW_CELLS, MAX_WINDOW_CELLS = 3, 401
MAX_CANDIDATES, MAX_CANDIDATE_CORNERS = 100_000, 1_000_000
#: Mean directions that are shorter stand for areas that face all sides.
MIN_DIRECTION = 0.1


@checked
@dataclass(frozen=True)
class ReleaseRules:
    """Limits on the shape of the ground in a candidate release area.

    Attributes
    ----------
    min_slope, max_slope
        Slope, degrees. 28 to 60 is for rare releases; frequent ones begin at 30 degrees (Bühler et
        al. 2018).
    max_plan_curvature
        Largest curvature across the slope, 1/m, so that ridges are left out. GIS programs give it
        per 100 m: 6 (Bühler et al. 2013). Gullies, where it is negative, stay.
    max_ruggedness
        Largest vector ruggedness measure: 0.08 for rare, 0.06 for frequent releases (Bühler et al.
        2018).
    ruggedness_window
        Side of the square in which the ruggedness is measured, m: 9 cells of 5 m.
    min_area
        Smallest area on the map, m2 (Bühler et al. 2013).
    max_gap
        Largest gap within an area that is filled, m2.
    sectors
        Number of sectors of the compass by which slopes are split, the first centred on north;
        1: not split. The aspect is averaged over the ruggedness window; parts below the smallest
        area join a neighbour (Bühler et al. 2013 split by 8 sectors, too).

    Raises
    ------
    InputError
        If a limit is negative, not finite, or above its upper limit.
    """

    min_slope: float = 28.0
    max_slope: float = 60.0
    max_plan_curvature: float = 0.06
    max_ruggedness: float = 0.08
    ruggedness_window: float = 45.0
    min_area: float = 500.0
    max_gap: float = 0.0
    sectors: int = 8

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not 0.0 <= value < math.inf:
                raise InputError(f"{name}: {value:g}; allowed: finite numbers from 0")
        if not 1 <= self.sectors <= MAX_SECTORS:
            raise InputError(f"sectors: {self.sectors}; allowed: 1 to {MAX_SECTORS}")
        if not self.min_slope < self.max_slope <= 90.0:
            raise InputError(
                f"slope: {self.min_slope:g} to {self.max_slope:g} degrees; the first number must "
                "be below the second, which is at most 90"
            )

    def window_cells(self, cell: float) -> int:
        """Return the odd number of cells of a size, m, along the window of the ruggedness."""
        count = 2 * round(0.5 * (self.ruggedness_window / cell - 1.0)) + 1
        if not MIN_WINDOW_CELLS <= count <= MAX_WINDOW_CELLS:
            raise InputError(
                f"ruggedness_window: {self.ruggedness_window:g} m are {max(count, 1)} cells of "
                f"{cell:g} m; allowed: {MIN_WINDOW_CELLS} to {MAX_WINDOW_CELLS} cells"
            )
        return count


@dataclass(frozen=True)
class ReleaseCandidate:
    """A candidate release area.

    Attributes
    ----------
    name
        Its name, such as "candidate 1".
    outline
        Its outline on the map, along the edges of cells.
    area, surface
        Area on the map, and along the ground, m2.
    slope, lowest_slope, highest_slope
        Mean, smallest and largest slope, degrees.
    aspect
        Mean direction that the ground faces, degrees clockwise from north; None if the area faces
        all sides.
    lowest, highest
        Elevations, m.
    thickness, largest_thickness
        Mean and largest thickness of the snow, m, normal to the ground; None if it is not given.
    volume
        Volume of this snow, m3; None if no thickness is given.
    """

    name: str
    outline: MapArea
    area: float
    surface: float
    slope: float
    lowest_slope: float
    highest_slope: float
    aspect: Optional[float]
    lowest: float
    highest: float
    thickness: Optional[float] = None
    largest_thickness: Optional[float] = None
    volume: Optional[float] = None


@dataclass(frozen=True)
class ReleaseCandidates:
    """Candidate release areas of a terrain, the largest first.

    Attributes
    ----------
    areas
        The candidates.
    rules
        The rules.
    crs
        Coordinate system of the terrain as text; empty if unknown.
    remaining
        Area on the map that remains after each rule, m2, in the order of the rules.
    """

    areas: Sequence[ReleaseCandidate]
    rules: ReleaseRules
    crs: str
    remaining: Mapping[str, float]

    @property
    def outlines(self) -> list[MapArea]:
        """The outlines of the candidates, which `snowshed.scene.slide_scene` takes as a release."""
        return [candidate.outline for candidate in self.areas]


@checked
def find_release_areas(
    terrain: Raster,
    rules: Optional[ReleaseRules] = None,
    *,
    forest: Union[Raster, Sequence[MapArea], None] = None,
    thickness: Union[float, Raster, None] = None,
) -> ReleaseCandidates:
    """Return the parts of a terrain whose shape allows the release of slabs.

    These are candidates, not a hazard assessment. A cell belongs to a candidate if its slope, plan
    curvature and ruggedness obey the rules and it has no forest. Cells beside a missing elevation,
    and those at the border, do not.

    Parameters
    ----------
    terrain
        Elevations, m.
    rules
        The limits. [default: `ReleaseRules()`]
    forest
        Forest: a raster with values above 0 in forest, or areas. Where such a raster has no value
        there is no forest.
    thickness
        Thickness of the snow, m, normal to the ground: one number, or a raster.

    Raises
    ------
    InputError
        If the terrain is implausible, coordinate systems differ, a thickness is not above 0 in a
        candidate, there are too many candidates, or rasterio or shapely is missing.

    Examples
    --------
    >>> x, y = np.meshgrid(np.arange(41) * 5.0, np.arange(31) * 5.0)
    >>> bend = Raster(2000.0 - 0.8 * np.minimum(x, 100.0), 0.0, 0.0, 5.0)
    >>> (slab,) = find_release_areas(bend, thickness=0.5).areas
    >>> round(slab.area), round(slab.slope, 1), slab.aspect, round(slab.volume)
    (13775, 38.7, 90.0, 8820)
    """
    rules = rules or ReleaseRules()
    check_terrain(terrain)
    others = [other for other in (forest, thickness) if isinstance(other, Raster)]
    files = [(other.name, other.crs) for other in (terrain, *others)]
    if forest is not None and not isinstance(forest, Raster):
        files += [(area.file, area.crs) for area in forest]
    crs = common_system(files)
    if not RULE_CELL / 2.0 <= terrain.cell <= RULE_CELL * 2.0:
        averaging = argument("cell", f"{RULE_CELL:g}")
        issue_note(
            f"{terrain.name}: cells of {terrain.cell:g} m; the rules for release areas were made "
            f"for cells of {RULE_CELL:g} m; "
            + (
                f"smaller ones show rougher ground ({averaging} averages them)"
                if terrain.cell < RULE_CELL
                else "larger ones hide ridges and rough ground"
            ),
            InputNote,
        )
    shape = terrain_shape(terrain)
    labels, remaining = _labelled(terrain, shape, rules, forest)
    areas = _candidates(terrain, shape, labels, _thickness(terrain, labels > 0, thickness))
    return ReleaseCandidates(areas, rules, crs, remaining)


def _labelled(
    terrain: Raster,
    shape: TerrainShape,
    rules: ReleaseRules,
    forest: Union[Raster, Sequence[MapArea], None],
) -> tuple[Integers, dict[str, float]]:
    """Return the cells of the candidates with labels from 1, and the area after each rule."""
    remaining: dict[str, float] = {}
    cells = np.isfinite(shape.plan_curvature)

    def record(rule: str) -> None:
        remaining[rule] = float(np.count_nonzero(cells)) * terrain.cell**2

    record("all cells with a slope")
    slope = shape.slope
    cells = cells & (slope >= rules.min_slope) & (slope <= rules.max_slope)
    record(f"slope {rules.min_slope:g} to {rules.max_slope:g} degrees")
    cells = cells & (shape.plan_curvature <= rules.max_plan_curvature)
    record(f"plan curvature up to {rules.max_plan_curvature:g} 1/m")
    window = rules.window_cells(terrain.cell)
    cells = cells & (shape.ruggedness(window) <= rules.max_ruggedness)
    record(f"ruggedness up to {rules.max_ruggedness:g}")
    if forest is not None:
        cells = cells & ~_forest_cells(forest, terrain)
        record("no forest")
    if rules.max_gap > 0.0:
        cells = without_gaps(cells, rules.max_gap / terrain.cell**2)
        cells = cells & np.isfinite(shape.plan_curvature)
        record(f"gaps up to {rules.max_gap:g} m2 filled")
    smallest = rules.min_area / terrain.cell**2
    labels = connected_cells(cells)
    if rules.sectors > 1:
        labels = split_by_sectors(cells, shape.aspect(window), rules.sectors, smallest)
    labels = without_small(labels, smallest)
    cells = labels > 0
    record(f"areas from {rules.min_area:g} m2")
    _check_count(terrain, labels, cells)
    return labels, remaining


def _forest_cells(forest: Union[Raster, Sequence[MapArea]], terrain: Raster) -> Booleans:
    if not isinstance(forest, Raster):
        return covered_cells(forest, terrain)
    values = nearest_values(forest, terrain)
    if np.isnan(values).any():
        issue_note(
            f"{forest.name}: has no value in {np.isnan(values).mean():.0%} of the terrain, where "
            "no forest is assumed",
            InputNote,
        )
    return values > 0.0


def _check_count(terrain: Raster, labels: Integers, cells: Booleans) -> None:
    count, corners = int(labels.max(initial=0)), corner_count(cells)
    facts = f"{terrain.name}: {count} candidates with {corners} corners"
    if count > MAX_CANDIDATES or corners > MAX_CANDIDATE_CORNERS:
        raise InputError(
            f"{facts}; at most {MAX_CANDIDATES} and {MAX_CANDIDATE_CORNERS} are allowed; raise "
            "min_area, fill gaps, make the cells larger, or crop the terrain"
        )
    if count > MAX_POLYGONS or corners > MAX_CORNERS:
        issue_note(
            f"{facts}; a slide takes {MAX_POLYGONS} areas with {MAX_CORNERS} corners, so select "
            "some of them",
            InputNote,
        )


def _thickness(
    terrain: Raster, cells: Booleans, thickness: Union[float, Raster, None]
) -> Optional[Floats]:
    """Return the thickness of the snow in each cell, m."""
    if thickness is None:
        return None
    if isinstance(thickness, Raster):
        depth, name = nearest_values(thickness, terrain), thickness.name
    else:
        depth, name = np.full(cells.shape, float(thickness)), "thickness"
    wrong = cells & ~((depth > 0.0) & (depth < math.inf))
    if wrong.any():
        row, column = np.argwhere(wrong)[0]
        x, y = terrain.east + column * terrain.cell, terrain.north + row * terrain.cell
        raise InputError(
            f"{name}: {depth[row, column]:g} m in a candidate at ({x:.10g}, {y:.10g}); needed: a "
            "number above 0"
        )
    return depth


def _candidates(
    terrain: Raster, shape: TerrainShape, labels: Integers, depth: Optional[Floats]
) -> list[ReleaseCandidate]:
    """Return the candidates with their figures, the largest first."""
    outlines = dict(cell_outlines(terrain, labels))
    rows, columns = np.nonzero(labels)
    by_label = np.argsort(labels[rows, columns], kind="stable")
    rows, columns = rows[by_label], columns[by_label]
    ends = np.searchsorted(labels[rows, columns], np.arange(1, len(outlines) + 2))
    groups = [(rows[a:b], columns[a:b]) for a, b in zip(ends[:-1], ends[1:])]
    order = sorted(range(len(groups)), key=lambda place: (-len(groups[place][0]), place))
    return [
        _candidate(f"candidate {n}", terrain, shape, outlines[k + 1], groups[k], depth)
        for n, k in enumerate(order, 1)
    ]


def _candidate(
    name: str,
    terrain: Raster,
    shape: TerrainShape,
    rings: Sequence[Ring],
    cells: tuple[Integers, Integers],
    depth: Optional[Floats],
) -> ReleaseCandidate:
    ground = shape.at(cells)
    surface = terrain.cell**2 * ground.surface
    slopes, heights = ground.slope, terrain.heights[cells]
    snow = None if depth is None else depth[cells]
    mean = None if snow is None else float((snow * surface).sum() / surface.sum())
    return ReleaseCandidate(
        name=name,
        outline=MapArea(name, rings[0], tuple(rings[1:]), mean, terrain.crs, terrain.name),
        area=terrain.cell**2 * len(slopes),
        surface=float(surface.sum()),
        slope=float(slopes.mean()),
        lowest_slope=float(slopes.min()),
        highest_slope=float(slopes.max()),
        aspect=_mean_aspect(ground.east, ground.north),
        lowest=float(heights.min()),
        highest=float(heights.max()),
        thickness=mean,
        largest_thickness=None if snow is None else float(snow.max()),
        volume=None if snow is None else float((snow * surface).sum()),
    )


def _mean_aspect(east: Floats, north: Floats) -> Optional[float]:
    """Return the mean direction that the ground faces, degrees clockwise from north.

    Examples
    --------
    >>> _mean_aspect(np.array([-1.0, -2.0]), np.zeros(2))
    90.0
    """
    steepness = np.hypot(east, north)
    x, y = float((-east / steepness).mean()), float((-north / steepness).mean())
    if math.hypot(x, y) < MIN_DIRECTION:
        return None
    return math.degrees(math.atan2(x, y)) % 360.0
