"""Scenes from AvaFrame's project folders: com5SnowSlide as AvaFrame 2.1 runs it."""

from __future__ import annotations

import configparser
from collections.abc import Mapping
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.io.messages import suggestion
from snowshed.io.paths import PathLike
from snowshed.methods.slide import SlideSettings
from snowshed.scene.builders.slides import MAX_TIME, slide_scene
from snowshed.scene.scene import Scene

#: Keys of the ini that are settings here, in the sections GENERAL and com1DFA's overrides.
SETTINGS: Mapping[str, str] = {
    "dt": "time_step",
    "rho": "density",
    "meshcellsize": "cell",
    "deltath": "layer_thickness",
    "muvoellmy": "friction",
    "xsivoellmy": "turbulence",
    "cohesionmaxstrain": "max_strain",
    "cohesivesurfacetension": "bond_modulus",
    "mindistcohesion": "min_bond_length",
    "cresh": "resistance",
    "subgridmixingfactor": "artificial_viscosity",
    "rhoent": "entrained_density",
    "enteroenergy": "erosion_energy",
    "entshearresistance": "entrainment_shear",
    "entdefresistance": "entrainment_work",
    "thresholdmasssplit": "split_ratio",
    "stopcrit": "stop_ratio",
}
#: Keys that may only have the value with which com5SnowSlide works here.
FIXED: Mapping[str, str] = {
    "modeltype": "ssl",
    "initpartdisttype": "triangular",
    "massperparticledeterminationmethod": "mppdh",
    "resistancemodel": "default",
    "detrainment": "false",
    "sphoption": "1",
    "viscoption": "1",
    "splitoption": "0",
    "interpoption": "2",
    "stopcrittype": "kinenergy",
    "centeredposition": "1",
    "methodmeshnormal": "1",
    "reprojmethodforce": "2",
    "reprojmethodposition": "2",
    "curvaccinfriction": "1",
    "curvaccintangent": "0",
    "curvaccingradient": "0",
    "inistep": "false",
    "gravacc": "9.81",
}
#: Keys that change nothing that is computed.
IGNORED = ("defaultconfig", "restype", "tsteps", "seed", "simtypelist", "tend")
#: The computing cell and step of com5SnowSlide.
DEFAULTS: Mapping[str, float] = {"cell": 2.0, "time_step": 0.01}


def avaframe_scene(
    folder: PathLike,
    *,
    settings: Optional[Mapping[str, object]] = None,
    thickness: Optional[float] = None,
    ascii_copy: Optional[PathLike] = None,
) -> Scene:
    """Return the scene of an AvaFrame project folder, in the compatible mode.

    Parameters
    ----------
    folder
        The project: ``Inputs`` with the terrain (.asc or .tif), ``REL`` and, where there are any,
        ``ENT`` and ``RES``; the ini of com5SnowSlide, if any, in it or in ``Inputs``.
    settings
        Settings that go before those of the ini, by their names in `SlideSettings`.
    thickness
        Thickness of the released snow [m], in place of the files'.
    ascii_copy
        Where the copy of a GeoTIFF goes.

    Raises
    ------
    InputError
        If the folder is no such project, or the ini asks for what com5SnowSlide does not do here.
    OSError
        If a file cannot be read.
    """
    project = Path(folder)
    inputs = project / "Inputs"
    if not inputs.is_dir():
        raise InputError(f"{project}: no AvaFrame project: it has no folder Inputs")
    options, max_time = read_ini(_only(project, inputs))
    values = {**DEFAULTS, **options, **(settings or {}), "mode": "compatible"}
    scene = slide_scene(
        _one(inputs, ("*.asc", "*.tif", "*.tiff"), "terrain"),
        _one(inputs / "REL", ("*.shp", "*.gpkg", "*.geojson"), "release area"),
        thickness=thickness,
        entrainment=_one_if_any(inputs / "ENT"),
        resistance=_one_if_any(inputs / "RES"),
        settings=SlideSettings.from_data(values),
        ascii_copy=ascii_copy,
        title=f"{project.resolve().name} (AvaFrame)",
    )
    return scene.set("events.max_time", max_time)


def read_ini(file: Optional[Path]) -> tuple[dict[str, object], float]:
    """Return the settings of an ini of com5SnowSlide, and the longest duration, s.

    Raises
    ------
    InputError
        If the file is no ini, or a key or its value is none that works here.

    Examples
    --------
    >>> read_ini(None)
    ({}, 400.0)
    """
    values: dict[str, object] = {}
    max_time = MAX_TIME
    for key, text in _keys_of(file).items():
        where = f"{file}: {key}"
        if key in SETTINGS:
            values[SETTINGS[key]] = _number(text, where)
        elif key == "tend":
            max_time = _number(text, where)
        elif key == "snowslide":
            values["bonds"] = _number(text, where) != 0.0
        elif key == "explicitfriction":
            values["explicit_friction"] = _number(text, where) != 0.0
        elif key == "frictmodel":
            values["friction_law"] = _friction_law(text, where)
        elif key == "mucoulomb":
            values.setdefault("friction", _number(text, where))
        elif key in FIXED:
            if not _is_same(text, FIXED[key]):
                raise InputError(f"{where}: {text!r} is not available; allowed: {FIXED[key]}")
        elif key not in IGNORED:
            near = suggestion(key, [*SETTINGS, *FIXED])
            raise InputError(f"{where}: none of the keys that are known here{near}")
    return values, max_time


def _keys_of(file: Optional[Path]) -> dict[str, str]:
    if file is None:
        return {}
    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read_string(file.read_text(encoding="utf-8"), str(file))
    except (configparser.Error, UnicodeDecodeError) as error:
        raise InputError(f"{file}: not an ini file: {error}") from None
    found: dict[str, str] = {}
    for section in parser.sections():
        if section == "GENERAL" or section.endswith("_override"):
            found.update(parser.items(section))
    return {key: text for key, text in found.items() if text.strip()}


def _number(text: str, where: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{where}: {text!r} is not one number") from None


def _friction_law(text: str, where: str) -> str:
    name = text.strip().lower()
    if name not in ("voellmy", "coulomb"):
        raise InputError(f"{where}: {text!r} is none of Voellmy, Coulomb")
    return name


def _is_same(text: str, allowed: str) -> bool:
    try:
        return float(text) == float(allowed)
    except ValueError:
        return text.strip().lower() == allowed


def _only(*folders: Path) -> Optional[Path]:
    """Return the ini of com5SnowSlide in the folders; None without one."""
    found = [file for folder in folders for file in sorted(folder.glob("*com5SnowSlideCfg.ini"))]
    if len(found) > 1:
        raise InputError(f"{folders[0]}: {len(found)} ini files of com5SnowSlide; keep one")
    return found[0] if found else None


def _one(folder: Path, patterns: tuple[str, ...], what: str) -> Path:
    found = sorted(file for pattern in patterns for file in folder.glob(pattern))
    if len(found) != 1:
        raise InputError(f"{folder}: {len(found)} files of the {what}; allowed: 1")
    return found[0]


def _one_if_any(folder: Path) -> Optional[Path]:
    patterns = ("*.shp", "*.gpkg", "*.geojson")
    if not any(True for pattern in patterns for _ in folder.glob(pattern)):
        return None
    return _one(folder, patterns, folder.name)
