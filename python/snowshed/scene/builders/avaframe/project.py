"""Scenes from AvaFrame's project folders: com5SnowSlide as AvaFrame 2.1 runs it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.callers import argument
from snowshed.base.limits import MAX_RASTER_CELLS, MAX_RESAMPLED_CELLS, MAX_SAVED_CELLS
from snowshed.base.messages import quoted
from snowshed.base.notes import record_notes
from snowshed.base.paths import PathLike
from snowshed.io.raster.areas import read_areas
from snowshed.io.raster.raster import GEOTIFF, Raster, read_raster, write_ascii_grid
from snowshed.io.raster.release import snow_part
from snowshed.io.raster.resampling import resampled_raster
from snowshed.io.raster.terrain_nodes import thickness_on_terrain
from snowshed.methods.slide.settings import SlideSettings
from snowshed.scene.builders.avaframe.events import (
    set_dam,
    set_inflows,
    time_dependent_release,
)
from snowshed.scene.builders.avaframe.files import InputFile, check_own_file, project_inputs
from snowshed.scene.builders.avaframe.ini import SIM_TYPES, ProjectSettings, read_ini
from snowshed.scene.builders.slides import slide_scene
from snowshed.scene.builders.terrain_copy import thickness_copy
from snowshed.scene.scene import Scene

POLYGONS = ("*.shp", "*.gpkg", "*.geojson")
RASTERS = ("*.asc", "*.tif", "*.tiff")
RASTER_SUFFIXES = (".asc", *GEOTIFF)
#: Largest difference of equal cell sizes, m.
SAME_CELL = 1e-3


@dataclass(frozen=True)
class AvaFrameSimulation:
    """One of the simulations that AvaFrame makes of a project.

    Attributes
    ----------
    scene
        The scene to simulate.
    release
        Name of the release file, without ending.
    sim_type
        "entres", "ent", "res" or "null": with areas of entrainment, of resistance, or neither.
    hydrograph
        Name of the table of a time-dependent release, without ending; empty: none.
    project
        The settings of the ini file.
    folder
        The project folder.
    files
        Files of the areas, by the part of a scene's terrain; None for parts without a file.
    inputs
        Files in the project's folder Inputs, which belong to the results.
    terrain
        The file of the terrain.
    """

    scene: Scene
    release: str
    sim_type: str
    project: ProjectSettings
    folder: Path
    files: Mapping[str, Optional[Path]]
    inputs: Sequence[InputFile]
    terrain: Path
    hydrograph: str = ""


def avaframe_simulations(
    folder: PathLike,
    *,
    settings: Optional[Mapping[str, object]] = None,
    thickness: Optional[float] = None,
    ascii_copy: Optional[PathLike] = None,
) -> list[AvaFrameSimulation]:
    """Return the simulations of an AvaFrame project folder, in the compatible mode.

    Every combination of a release file, a type of simulation and, if the release depends on time, a
    hydrograph gives a simulation; the first one has all requested areas.

    Parameters
    ----------
    folder
        The project: ``Inputs`` with the terrain (.asc or .tif), ``REL`` (polygons, or rasters of
        the thickness) and, where there are any, ``ENT``, ``RES``, ``SECREL`` and ``DAM``; the ini
        of com5SnowSlide, if any, in ``Inputs/CFGs``, ``Inputs`` or the folder.
    settings
        Settings that override those of the ini, by their names in `SlideSettings`.
    thickness
        Thickness of the released snow [m], instead of that of the files.
    ascii_copy
        File for a copy of the terrain, needed for a GeoTIFF, for other cell sizes than those of the
        ini, and for a release from rasters, whose copies go beside it.

    Raises
    ------
    InputError
        If the folder is not such a project, requests unsupported features of com5SnowSlide, or has
        links to files outside.
    OSError
        If a file cannot be read.
    """
    root = Path(folder)
    inputs = root / "Inputs"
    if not inputs.is_dir():
        raise InputError(f"{root}: not an AvaFrame project: it has no folder Inputs")
    own = project_inputs(root)
    project = read_ini(_find_ini(root, inputs / "CFGs", inputs))
    project.values.update(settings or {})
    project.values["mode"] = "compatible"
    if thickness is not None:
        project.release_thickness = thickness
    areas = {
        "ent": _one_if_any(inputs / "ENT", "entrainment"),
        "res": _one_if_any(inputs / "RES", "resistance"),
        "secrel": None,
        "dam": None,
    }
    if project.with_secondary_release:
        areas["secrel"] = _one_if_any(inputs / "SECREL", "secondary release")
    if project.with_dam:
        areas["dam"] = _one_if_any(inputs / "DAM", "dams")
    raster = _only_file(inputs, RASTERS, "terrain")
    terrain = _terrain(raster, project, ascii_copy)
    _check_saved_maps(terrain, project)
    return [
        AvaFrameSimulation(
            _scene(root, raster, terrain, release, areas, sim_type, project, ascii_copy, table),
            release.stem,
            sim_type,
            project,
            root,
            {
                "release": release,
                "entrainment": areas["ent"],
                "resistance": areas["res"],
                "secondary_release": areas["secrel"],
                "dams": areas["dam"],
                "inflows": table,
            },
            own,
            raster,
            "" if table is None else table.stem,
        )
        for release in _releases(inputs / "REL", project)
        for table in _hydrographs(inputs / "REL", project)
        for sim_type in _sim_types(project, areas, inputs)
    ]


@checked
def avaframe_scene(
    folder: PathLike,
    *,
    settings: Optional[Mapping[str, object]] = None,
    thickness: Optional[float] = None,
    ascii_copy: Optional[PathLike] = None,
) -> Scene:
    """Return the scene of the first simulation of an AvaFrame project, with all its areas.

    Parameters and errors are those of `avaframe_simulations`.
    """
    simulations = avaframe_simulations(
        folder, settings=settings, thickness=thickness, ascii_copy=ascii_copy
    )
    return simulations[0].scene


def _scene(
    root: Path,
    raster: Path,
    terrain: Path,
    release: Path,
    areas: Mapping[str, Optional[Path]],
    sim_type: str,
    project: ProjectSettings,
    ascii_copy: Optional[PathLike],
    hydrograph: Optional[Path],
) -> Scene:
    pulses = None if hydrograph is None else time_dependent_release(hydrograph, project)
    entrainment = areas["ent"] if sim_type.startswith("ent") else None
    resistance = areas["res"] if sim_type.endswith("res") else None
    with record_notes() as notes:
        depth = _release_raster(root, raster, terrain, release, project, ascii_copy)
    scene = slide_scene(
        terrain,
        release if depth is None else None,
        thickness_raster=depth,
        thickness=project.release_thickness if pulses is None else pulses[0].thickness,
        entrainment=entrainment,
        entrained_thickness=_entrained_thickness(entrainment, project),
        resistance=resistance,
        secondary_release=areas["secrel"],
        secondary_thickness=project.secondary_thickness,
        dams=areas["dam"],
        settings=SlideSettings.from_data(project.values),
        ascii_copy=ascii_copy,
        title=f"{root.resolve().name} (AvaFrame)",
        max_cells=MAX_RASTER_CELLS,
    )
    if scene.terrain is not None:
        for area in (
            *(scene.terrain.release or ()),
            *(scene.terrain.entrainment or ()),
            *(scene.terrain.secondary_release or ()),
        ):
            if area.holes:
                raise InputError(f"{area.name}: has a hole, which AvaFrame does not allow")
        # AvaFrame reads GeoTIFF in double precision, also its own resampled files.
        if raster.suffix.lower() in GEOTIFF:
            scene.terrain.single_precision = False
        scene.terrain.notes = "\n".join(filter(None, (*notes, scene.terrain.notes))) or None
        set_dam(scene.terrain, project, areas["dam"])
        if pulses is not None:
            set_inflows(scene.terrain, pulses)
    return scene.set("events.max_time", project.max_time)


def _release_raster(
    root: Path,
    raster: Path,
    terrain: Path,
    release: Path,
    project: ProjectSettings,
    ascii_copy: Optional[PathLike],
) -> Optional[Raster]:
    """Return the thickness at the nodes of the terrain if the release is a raster."""
    if release.suffix.lower() not in RASTER_SUFFIXES:
        return None
    if project.release_thickness is not None:
        raise InputError(
            f"{release}: a raster holds the thickness; leave out relTh and relThFromFile in the "
            f"ini, and {argument('thickness')}"
        )
    if ascii_copy is None:
        raise InputError(f"{release}: give a file beside which its copy is written (ascii_copy)")
    depth = thickness_on_terrain(
        read_raster(release),
        read_raster(terrain),
        terrain_is_text=raster.suffix.lower() not in GEOTIFF,
    )
    snow_part(depth)  # checks the values
    copy = thickness_copy(Path(ascii_copy), release.stem)
    write_ascii_grid(copy, depth, exact=True)
    return replace(depth, name=str(copy), plain=True, numbers="float64")


def _entrained_thickness(file: Optional[Path], project: ProjectSettings) -> Optional[float]:
    if file is None or project.entrained_thickness is not None:
        return project.entrained_thickness
    if all(area.thickness is None for area in read_areas(file)):
        return project.default_entrained_thickness
    return None


def _terrain(file: Path, project: ProjectSettings, ascii_copy: Optional[PathLike]) -> Path:
    """Return the terrain on the requested cells, resampled as in AvaFrame."""
    cell = float(str(project.values["cell"]))
    if cell == 0:
        return file
    original = read_raster(file)
    if abs(original.cell - cell) <= SAME_CELL:
        project.values["cell"] = original.cell
        return file
    cells = original.heights.size * (original.cell / cell) * (original.cell / cell)
    if cells > MAX_RESAMPLED_CELLS:
        raise project.located(
            InputError(
                f"/numerics/cell: {cell:g} m makes {cells:.3g} cells of {file}; at most "
                f"{MAX_RESAMPLED_CELLS} are allowed"
            )
        )
    if ascii_copy is None:
        raise InputError(f"{file}: give the file for its copy on cells of {cell:g} m (ascii_copy)")
    write_ascii_grid(ascii_copy, resampled_raster(file, cell), exact=True)
    return Path(ascii_copy)


def _check_saved_maps(terrain: Path, project: ProjectSettings) -> None:
    """Refuse maps over time that would fill the disk."""
    if not project.saved_times:
        return
    maps = len(project.saved_times) * len(project.result_types)
    cells = maps * read_raster(terrain).heights.size
    if cells > MAX_SAVED_CELLS:
        raise InputError(
            f"{project.positions['saved_times']}: {maps} maps have {cells:.3g} cells; at most "
            f"{MAX_SAVED_CELLS:.0e} are allowed"
        )


def _releases(folder: Path, project: ProjectSettings) -> list[Path]:
    rasters = _files(folder, RASTERS)
    files = _files(folder, POLYGONS)
    if rasters and files:
        raise InputError(f"{folder}: has polygons and rasters; AvaFrame takes one kind")
    if rasters and project.hydrographs is not None:
        raise InputError(f"{rasters[0]}: timeDependentRelease needs polygons")
    files = files or rasters
    for before, after in zip(rasters, rasters[1:]):
        if before.stem == after.stem:
            raise InputError(f"{folder}: has two rasters {quoted(after.stem)}; keep one")
    if project.release_scenario:
        files = [file for file in files if file.stem == project.release_scenario]
        if not files:
            raise InputError(f"{folder}: no release area {quoted(project.release_scenario)}")
    if not files:
        raise InputError(
            f"{folder}: no file of a release area ({', '.join((*POLYGONS, *RASTERS))})"
        )
    return files


def _sim_types(
    project: ProjectSettings, areas: Mapping[str, Optional[Path]], inputs: Path
) -> list[str]:
    """Return the types to simulate; the type with the most areas comes first."""
    wanted = set(project.sim_types)
    if "available" in wanted:
        available = "".join(kind for kind, file in areas.items() if file is not None)
        wanted = (wanted - {"available"}) | {"null", available or "null"}
    for kind, folder in (("ent", "ENT"), ("res", "RES")):
        if areas[kind] is None and any(kind in name for name in wanted):
            raise InputError(
                f"{inputs / folder}: holds no polygons, which simTypeList "
                f"{'|'.join(project.sim_types)} needs"
            )
    return [name for name in SIM_TYPES if name in wanted]


def _hydrographs(folder: Path, project: ProjectSettings) -> list[Optional[Path]]:
    """Return the tables of a time-dependent release; [None] without one."""
    if project.hydrographs is None:
        return [None]
    files = {file.stem: file for file in _files(folder, ("*.csv",))}
    for name in project.hydrographs:
        if name not in files:
            raise InputError(f"{folder}: no hydrograph {quoted(name)}.csv")
    chosen = [files[name] for name in project.hydrographs] or list(files.values())
    if not chosen:
        raise InputError(f"{folder}: timeDependentRelease needs a table (*.csv) here")
    return list(chosen)


def _find_ini(*folders: Path) -> Optional[Path]:
    """Return the ini of com5SnowSlide in the folders; None without one."""
    files = [file for folder in folders for file in sorted(folder.glob("*com5SnowSlideCfg.ini"))]
    if len(files) > 1:
        raise InputError(f"{folders[0]}: {len(files)} ini files of com5SnowSlide; keep one")
    if not files:
        return None
    check_own_file(files[0], folders[0])
    return files[0]


def _files(folder: Path, patterns: tuple[str, ...]) -> list[Path]:
    return sorted(file for pattern in patterns for file in folder.glob(pattern))


def _only_file(folder: Path, patterns: tuple[str, ...], what: str) -> Path:
    files = _files(folder, patterns)
    if len(files) != 1:
        raise InputError(f"{folder}: {len(files)} files of the {what}; allowed: 1")
    return files[0]


def _one_if_any(folder: Path, what: str) -> Optional[Path]:
    rasters = _files(folder, RASTERS)
    if rasters:
        raise InputError(f"{rasters[0]}: areas of {what} are taken from polygons only")
    return _only_file(folder, POLYGONS, what) if _files(folder, POLYGONS) else None
