"""Measuring a stack: levelling, trimming, surface, extents (thesis A.4, Figure 2.2.1).

The steps, in this order:

1. The ground is turned level (A.4.4). Heights are measured from the ground below.
2. Snow that has not come down is excluded and reported: snow that lies on the panel, hangs over its
   edge, lies on a structure, or still falls (module ``support``).
3. The outermost 3 % are dropped (A.4.1, A.4.2; module ``trimming``). In 2D the thesis can be read
   in two ways. A stack is measured by one rule, named `trimming`; its extent is given by both.
4. The surface is extracted (A.4.3; module ``surface``); height, length, head, tail and width are
   measured on the surface, as in the thesis.

Steps 3 and 4 are repeated on the largest connected body alone (module ``connected_components``),
because the lab measured a continuous body and left out what had rolled away. Mass and volume
include all snow off the panel, also outliers; the volume of a particle counts as at most a voxel,
for any deformation. In 2D the snow is a strip one metre wide.

The height of the centre of mass and the spread along the slope include all snow of the stack, also
outliers. They are sums over all particles instead of positions of a few. Therefore they scatter
less between seeds, and converge more regularly with the grid, than height and length.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.arrays import Booleans, Floats, column, finite, flags, points, positive
from snowshed.base.notes import UnusualValueNote, issue_note
from snowshed.snow.stack.connected_components import largest_body
from snowshed.snow.stack.support import supports
from snowshed.snow.stack.surface import outline_particles, surface_particles
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, TRIMMINGS, check_trimming, inliers

#: Edge of the voxels that connect snow, m. It is the same on all finer grids, because the division
#: of snow into bodies must not depend on the grid; coarser grids connect snow over a cell.
CONNECTION_VOXEL = 0.01
#: Range of the median density of snow, kg/m3; beyond it, a note asks for the unit.
MIN_DENSITY, MAX_DENSITY = 5.0, 1500.0
#: Largest size of a stack over the side of a cube of its snow; beyond it, a note asks for the unit.
MAX_SPREAD = 100.0
MIN_TILT = 2.0  # degrees, of the ground; smaller ones but 0 may be radians
#: Largest distance of half of the particles to their nearest neighbours, in voxels that connect
#: snow, while most of the mass is detached; beyond it, a note asks for the unit.
MAX_GAP = 4.0
MIN_PARTICLES = 10  # fewer may lie anywhere
#: Largest side of a cube of the snow over the size of its particles' box; as `MAX_SPREAD`.
MAX_PACKING = 3.0


@dataclass(frozen=True, repr=False)
class Extent:
    """The extent of snow, m; x from the panel's centre, z from the ground. NaN without snow.

    `ground` (k,) holds the ground's z below the points of `outline`, m, on levelled ground; it is
    zero except on terrain.
    """

    height: float = 0.0
    length: float = 0.0
    head: float = np.nan  # min x
    tail: float = np.nan  # max x
    width: float = 0.0  # 1 in 2D
    crest: float = np.nan  # x of the highest point
    # (k, 2): x and z of the highest particle in each of at most 30 columns
    outline: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    ground: Floats = field(default_factory=lambda: np.zeros(0))

    def __repr__(self) -> str:
        return f"Extent(height {self.height:.4g} m, length {self.length:.4g} m)"


@dataclass(frozen=True, repr=False)
class StackMeasure(Extent):
    """A measured stack; its own extent covers all snow off the panel, without outliers.

    Attributes
    ----------
    trimming
        Trimming rule (thesis A.4.2) for the extent of the stack and of its body.
    trimmed
        Extent of all snow off the panel by each trimming rule; in 3D both are the same.
    body
        Extent of the largest connected body.
    mass, volume
        Mass and volume of all snow off the panel, kg and m3 (per metre of width in 2D).
    centre_height
        Height of the stack's centre of mass above the ground, m; NaN without snow.
    spread
        Standard deviation of the stack's mass along the slide direction, m; NaN without snow.
    detached_mass
        Mass outside the largest connected body, kg.
    on_panel_mass
        Snow that is excluded because it lies on the panel or hangs over its edge, kg.
    on_structures_mass
        Snow that is excluded because it lies on structures other than the panel, kg.
    joined
        Whether the stack and the snow on the panel touch.
    members : (n,)
        Mask of the particles that belong to the stack.
    """

    trimming: str = DEFAULT_TRIMMING
    trimmed: Mapping[str, Extent] = field(default_factory=dict)
    body: Extent = field(default_factory=Extent)
    mass: float = 0.0
    volume: float = 0.0
    centre_height: float = np.nan
    spread: float = np.nan
    detached_mass: float = 0.0
    on_panel_mass: float = 0.0
    on_structures_mass: float = 0.0
    joined: bool = False
    members: Booleans = field(default_factory=lambda: np.zeros(0, dtype=bool))

    def __repr__(self) -> str:
        return (
            f"StackMeasure(height {self.height:.4g} m, length {self.length:.4g} m, centre of mass "
            f"{self.centre_height:.4g} m high, {self.mass:.4g} kg, {self.detached_mass:.4g} kg of "
            f"it detached, trimmed {self.trimming})"
        )

    @property
    def density(self) -> float:
        """Mean density, kg/m3: mass over volume; NaN without snow."""
        return self.mass / self.volume if self.volume else np.nan


@checked
def levelled_positions(positions: Floats, ground_tilt_deg: float) -> Floats:
    """Turn positions about y so that tilted ground becomes z = 0 (A.4.4).

    The ground passes through the origin and falls in the direction of +x for positive tilt Psi; its
    normal is (sin Psi, 0, cos Psi). The rotation that levels it is R_y(-Psi) of (A.4.1): the
    thesis's figure counts the angle in the opposite direction.

    Parameters
    ----------
    positions : (n, 3)
        Positions, m.
    ground_tilt_deg
        Psi, degrees.

    Examples
    --------
    >>> down_the_slope = np.array([[np.cos(0.5), 0.0, -np.sin(0.5)]])
    >>> np.allclose(levelled_positions(down_the_slope, np.degrees(0.5)), [[1, 0, 0]])
    True
    """
    psi = -np.radians(ground_tilt_deg)
    cos, sin = np.cos(psi), np.sin(psi)
    rotation = np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
    levelled: Floats = positions @ rotation.T
    return levelled


@checked
def measure_stack(
    positions: ArrayLike,
    masses: ArrayLike,
    densities: ArrayLike,
    *,
    dimension: int,
    dx: float,
    ground_tilt_deg: float = 0.0,
    exclude: Optional[ArrayLike] = None,
    structures: Optional[ArrayLike] = None,
    ground: Optional[ArrayLike] = None,
    trimming: str = DEFAULT_TRIMMING,
) -> StackMeasure:
    """Measure the stack of the given particles.

    Arrays may be anything that NumPy converts: lists, single precision, columns of a DataFrame.
    They are not changed.

    Parameters
    ----------
    positions : (n, 3), or (n, 2) in 2D
        Positions, m; y is ignored in 2D, and two columns are x and z.
    masses : (n,)
        Masses, kg (per metre of width in 2D); none is negative.
    densities : (n,)
        Current densities, kg/m3; none is negative.
    dimension
        2 or 3.
    dx
        Size of the grid cells, m; decides which snow the panel holds, and, above
        `CONNECTION_VOXEL`, which snow is connected.
    ground_tilt_deg
        Psi, degrees; positive falls in the slide direction.
    exclude : (n,), optional
        Booleans: True for particles that are not part of the stack, because they lie on the panel.
        Snow that is held by them, because it hangs over the panel's edge, is excluded too.
    structures : (n,), optional
        Booleans: True for particles that touch a structure. Snow that is held by it, and does not
        reach the ground, is excluded.
    ground : (n,), optional
        z of the ground below each particle, m, on levelled ground; without it, 0.
    trimming
        Trimming rule (thesis A.4.2) of the outermost 3 % in 2D: "outermost_first" or "equal_pace",
        see `snowshed.snow.stack.trimming`.

    Returns
    -------
    StackMeasure
        The stack; without snow off the panel, its sizes are 0 and its positions NaN.

    Warns
    -----
    SnowshedNote
        If the positions cannot be in metres, or the densities in kg/m3.

    Raises
    ------
    InputError
        If an array has a wrong shape or length, or holds values that are not finite, or a mass or
        density is negative, or `dimension`, `dx` or `trimming` is wrong; the message names the
        argument.

    Examples
    --------
    >>> x, z = np.meshgrid(np.linspace(0, 1, 101), np.linspace(0, 0.2, 21))
    >>> heap = np.column_stack([x.ravel(), 0 * x.ravel(), z.ravel()])
    >>> mass, density = np.full(len(heap), 0.02), np.full(len(heap), 200.0)
    >>> stack = measure_stack(heap, mass, density, dimension=2, dx=0.02)
    >>> round(stack.height, 3), round(stack.density), round(stack.centre_height, 3)
    (0.2, 200, 0.1)
    """
    if dimension not in (2, 3):
        raise InputError(f"dimension: {dimension!r}; allowed: 2, 3")
    check_trimming(trimming)
    voxel = positive("dx", dx) ** dimension
    coordinates = points("positions", positions, dimension)
    every_mass = column("masses", masses, len(coordinates), non_negative=True)
    every_density = column("densities", densities, len(coordinates), non_negative=True)
    spread_noted = _note_on_units(coordinates, every_mass, every_density, dimension, dx)
    on_panel = (
        np.zeros(len(coordinates), dtype=bool)
        if exclude is None
        else flags("exclude", exclude, len(coordinates))
    )
    levelled = levelled_positions(coordinates, finite("ground_tilt_deg", ground_tilt_deg))
    under = (
        np.zeros(len(coordinates)) if ground is None else column("ground", ground, len(coordinates))
    )
    levelled[:, 2] -= under
    if structures is None:  # which might hold the snow above the ground
        _note_on_places(levelled[~on_panel], dx, ground_tilt_deg)
    if dimension == 2:
        levelled[:, 1] = 0.0
    touching = np.zeros(len(coordinates), dtype=bool)
    if structures is not None:
        touching = flags("structures", structures, len(coordinates))
    held, on_structure, falling, joined = _held(levelled, on_panel, touching, dx)
    below = ~(held | on_structure)
    members = below & ~falling
    snow, mass, under = levelled[members], every_mass[members], under[members]
    body = largest_body(snow, mass, max(dx, CONNECTION_VOXEL))
    detached = float(mass[~body].sum() + every_mass[falling].sum())
    if not spread_noted and 2.0 * detached > every_mass[below].sum():
        _note_on_gaps(levelled[below], max(dx, CONNECTION_VOXEL))
    centre_height, spread = _moments(snow, mass)
    trimmed = {name: _trimmed_extent(snow, mass, under, dimension, name) for name in TRIMMINGS}
    return StackMeasure(
        **vars(trimmed[trimming]),
        trimming=trimming,
        trimmed=trimmed,
        body=_trimmed_extent(snow[body], mass[body], under[body], dimension, trimming),
        mass=float(every_mass[below].sum()),
        volume=_volume(every_mass[below], every_density[below], voxel),
        centre_height=centre_height,
        spread=spread,
        detached_mass=detached,
        on_panel_mass=float(every_mass[held].sum()),
        on_structures_mass=float(every_mass[on_structure].sum()),
        joined=joined,
        members=members,
    )


def _note_on_units(
    positions: Floats, masses: Floats, densities: Floats, dimension: int, dx: float
) -> bool:
    """Issue notes if the arrays cannot be in metres, kg and kg/m3; return whether positions did."""
    if not len(positions):
        issue_note("positions: no particles, so the stack is empty", UnusualValueNote)
    dense = densities[masses > 0.0]
    if not len(dense):
        return False
    middle = float(np.median(dense))
    if not MIN_DENSITY <= middle <= MAX_DENSITY:
        issue_note(
            f"densities: half of them are {middle:.3g} kg/m3 or more, which snow cannot be; are "
            "they in g/cm3, or masses?",
            UnusualValueNote,
        )
        return False
    sides = np.ptp(positions, axis=0)[[0, 2] if dimension == 2 else [0, 1, 2]]
    size = float(np.prod(sides)) ** (1 / dimension)
    snow = float((masses / np.maximum(densities, MIN_DENSITY)).sum()) ** (1 / dimension)
    if snow > MAX_PACKING * float(np.prod(sides + dx)) ** (1 / dimension):
        issue_note(
            f"masses: by its mass and density the snow has the volume of "
            f"{'a square' if dimension == 2 else 'a cube'} with sides of {snow:.2g} m, but its "
            f"particles span only {size:.2g} m; are the masses in g, or is `dimension` "
            "another one?",
            UnusualValueNote,
        )
    too_wide = bool(size > MAX_SPREAD * snow)
    if too_wide:
        issue_note(
            f"positions: the particles span {' x '.join(f'{side:.3g}' for side in sides)} m, "
            f"but their snow has the volume of {'a square' if dimension == 2 else 'a cube'} with "
            f"sides of {snow:.2g} m; are the positions in mm or cm?",
            UnusualValueNote,
        )
    return too_wide


def _note_on_gaps(snow: Floats, voxel: float) -> None:
    """Issue a note if most particles of detached snow are far from all others.

    Parameters
    ----------
    snow : (n, 3)
        Positions, m.
    voxel
        Edge of the voxels that connect snow, m.
    """
    from scipy.spatial import cKDTree  # loads more slowly than snowshed

    if len(snow) < MIN_PARTICLES:
        return
    gap = float(np.median(cKDTree(snow).query(snow, k=2)[0][:, 1]))
    if gap > MAX_GAP * voxel:
        issue_note(
            f"positions: most of the mass is detached, because half of the particles are "
            f"{gap:.3g} m or more from all others, {gap / voxel:.3g} cells; check the unit of the "
            "positions",
            UnusualValueNote,
        )


def _note_on_places(snow: Floats, dx: float, ground_tilt_deg: float) -> None:
    """Issue notes on snow below the ground or above it, and on a grid of another unit.

    Parameters
    ----------
    snow : (n, 3)
        Positions above level ground, m.
    dx
        Size of the grid cells, m.
    ground_tilt_deg
        Tilt of the ground, degrees.
    """
    if 0.0 < abs(ground_tilt_deg) < MIN_TILT:
        issue_note(
            f"ground_tilt_deg: {ground_tilt_deg:g} degrees is unusual; is it in radians?",
            UnusualValueNote,
        )
    if not len(snow):
        return
    size = float(np.ptp(snow, axis=0).max())
    if dx > size > 0.0:
        issue_note(
            f"dx: {dx:g} m is more than the whole snow of {size:.3g} m; is it in mm?",
            UnusualValueNote,
        )
    heights = snow[:, 2]
    if np.median(heights) < -dx:
        issue_note(
            f"positions: half of the snow lies {-np.median(heights):.3g} m below the ground",
            UnusualValueNote,
        )
    elif heights.min() > max(size, dx):
        issue_note(
            f"positions: the lowest snow is {heights.min():.3g} m above the ground",
            UnusualValueNote,
        )


def _held(
    snow: Floats, on_panel: Booleans, touching: Booleans, dx: float
) -> tuple[Booleans, Booleans, Booleans, bool]:
    """Return masks of snow held by panel and structures, of falling snow, and the flag `joined`."""
    off = ~on_panel
    support = supports(snow[off], snow[on_panel], touching[off], snow[off, 2], dx)
    at_panel = on_panel.copy()
    on_structure, falling = np.zeros((2, len(snow)), dtype=bool)
    at_panel[off] = support.at_panel
    on_structure[off], falling[off] = support.on_structure, support.falling
    return at_panel, on_structure, falling, support.joined


def _volume(masses: Floats, densities: Floats, voxel: float) -> float:
    with np.errstate(divide="ignore"):
        return float(np.minimum(masses / densities, voxel).sum())


def _moments(snow: Floats, masses: Floats) -> tuple[float, float]:
    """Return the height of the centre of mass and the standard deviation of the mass along x, m."""
    if not masses.sum() > 0:
        return np.nan, np.nan
    x, height = snow[:, 0], snow[:, 2]
    middle = np.average(x, weights=masses)
    spread = np.sqrt(np.average((x - middle) ** 2, weights=masses))
    return float(np.average(height, weights=masses)), float(spread)


def _trimmed_extent(
    snow: Floats, masses: Floats, under: Floats, dimension: int, trimming: str
) -> Extent:
    inside = inliers(snow, masses, dimension, trimming)
    return _extent(snow[inside], under[inside], dimension)


def _extent(snow: Floats, under: Floats, dimension: int) -> Extent:
    """Measure the surface of levelled, trimmed snow (Table 2.3.2), over ground at z = `under`."""
    if len(snow) == 0:
        return Extent()
    x, y, z = snow[surface_particles(snow)].T
    profile = outline_particles(snow)
    return Extent(
        height=float(z.max()),
        length=float(np.ptp(x)),
        head=float(x.min()),
        tail=float(x.max()),
        width=float(np.ptp(y)) if dimension == 3 else 1.0,
        crest=float(x[np.argmax(z)]),
        outline=snow[profile][:, [0, 2]],
        ground=under[profile],
    )
