"""What an ini of AvaFrame's com5SnowSlide asks for: honoured or refused, never passed over.

com5SnowSlide runs com1DFA with other defaults; its ini may set any parameter of com1DFA.
"""

from __future__ import annotations

import configparser
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.io.input_file import read_input
from snowshed.io.messages import suggestion

MAX_TIME = 400.0  # s
SIM_TYPES = ("entres", "ent", "res", "null")
RESULT_TYPES = ("ppr", "pft", "pfv", "P", "FT", "FV")

#: Keys that are settings here.
SETTINGS: Mapping[str, str] = {
    "dt": "time_step",
    "rho": "density",
    "meshcellsize": "cell",
    "deltath": "layer_thickness",
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
#: The key of the Coulomb coefficient of each law of friction, and com5SnowSlide's default of it.
FRICTION: Mapping[str, tuple[str, float]] = {
    "voellmy": ("muvoellmy", 0.325),
    "coulomb": ("mucoulomb", 0.155),
}
#: Keys that may only have the value with which com5SnowSlide works here.
FIXED: Mapping[str, str] = {
    "adaptsfcdetrainment": "0",
    "adaptsfcentrainment": "0",
    "adaptsfcstopped": "0",
    "centeredposition": "1",
    "createrangetimediagram": "false",
    "curvaccinfriction": "1",
    "curvaccingradient": "0",
    "curvaccintangent": "0",
    "defaultconfig": "true",
    "depmin": "1e-6",
    "detrainment": "false",
    "distsplitpart": "0.41",
    "exportdata": "true",
    "exportrasters": "false",
    "gravacc": "9.81",
    "inistep": "false",
    "initialiseparticlesfromfile": "false",
    "initpartdisttype": "triangular",
    "interpoption": "2",
    "massperparticledeterminationmethod": "mppdh",
    "meshcellsizethreshold": "0.001",
    "methodmeshnormal": "1",
    "minrkern": "0.001",
    "modeltype": "ssl",
    "reprojectioniterations": "5",
    "reprojmethodforce": "2",
    "reprojmethodposition": "2",
    "resistancemodel": "default",
    "sphkernelradiustimestepping": "false",
    "sphoption": "1",
    "splitoption": "0",
    "stopcrittype": "kinenergy",
    "thresholdpointinpoly": "0.001",
    "timedependentrelease": "false",
    "trackparticles": "false",
    "velmagmin": "1e-6",
    "viscoption": "1",
    "writeparttocsv": "false",
}
#: Variations of a thickness, one simulation for each value.
VARIATIONS = tuple(
    f"{area}th{kind}variation"
    for area in ("rel", "ent", "secondaryrel")
    for kind in ("percent", "range", "rangefromci", "dist")
)
#: Keys that change nothing with the values above: of pictures, of random numbers, of what is
#: switched off.
WITHOUT_EFFECT = (
    "adaptdemplot", "additionallyfixedfactor", "appk", "bufferzonefactor", "centertrackpartpoint",
    "cleanremeshedrasters", "cmax", "cmaxnmass", "cmaxnppk", "cminmass", "cminnppk",
    "contourrestype", "cpice", "cvmaxsediment", "cvsediment", "detk", "dissdam", "dtini",
    "enthref", "enttempref", "exportparticleproperties", "forestthmax", "forestthmin",
    "forestvmax", "forestvmin", "ftoptionini", "hmin", "massperpart", "maxiterations",
    "niterdam", "nppk0", "nsplit", "particlefile", "particleproperties", "radius",
    "resizethreshold", "restitutioncoefficient", "rhosediment", "saveparticlesini", "scenario",
    "secondaryrelth", "secondaryrelthfromfile", "seed", "sizesediment", "sphkr0", "sphoptionini",
    "stopcritini", "stopcritinismall", "subgridmixingfactorini", "thfromini",
    "thresholdadaptsfc", "thresholdpointinrel", "thresholdprojection", "thresholdvalue",
    "timedependentreleasescenarios", "timestepdistance", "tini", "ttdiagram",
    "uflowingthreshold", "usecompression", "visuparticleproperties", "volclassmedium",
    "volclasssmall",
)  # fmt: skip
#: Ends of keys that belong to laws of friction which no simulation here has chosen.
OTHER_FRICTION = (
    "samosat", "samosatsmall", "samosatmedium", "voellmyminshear", "coulombminshear", "wetsnow",
    "obrienandjulien", "herschelandbulkley", "bingham",
)  # fmt: skip
OWN_KEYS = (
    "dam", "entth", "entthfromfile", "entthifmissinginshp", "explicitfriction", "frictmodel",
    "releasescenario", "relth", "relthfromfile", "restype", "secrelarea", "simtypelist",
    "snowslide", "sphkernelradius", "tend", "tsteps", *(key for key, _ in FRICTION.values()),
)  # fmt: skip


@dataclass
class ProjectSettings:
    """What an ini asks for.

    Attributes
    ----------
    values
        Settings of the method, by their names in `SlideSettings`.
    max_time
        Longest duration, s.
    sim_types
        "entres", "ent", "res" and "null", or "available".
    release_thickness, entrained_thickness
        Thickness of all areas in place of the files', m; None: the files'.
    default_entrained_thickness
        Where the file of the entrainment areas says none, m.
    release_scenario
        Name of the only release file to take; empty: all of them.
    result_types, saved_times
        Maps to write, and when beside the end, s.
    with_dam, with_secondary_release
        Whether to take dams and secondary release areas where there are any.
    """

    values: dict[str, object] = field(default_factory=lambda: {"cell": 2.0, "time_step": 0.01})
    max_time: float = MAX_TIME
    sim_types: tuple[str, ...] = ("available",)
    release_thickness: Optional[float] = None
    entrained_thickness: Optional[float] = None
    default_entrained_thickness: float = 0.3
    release_scenario: str = ""
    result_types: tuple[str, ...] = ("ppr", "pft", "pfv")
    saved_times: tuple[float, ...] = ()
    with_dam: bool = True
    with_secondary_release: bool = True


def read_ini(file: Optional[Path]) -> ProjectSettings:
    """Return what an ini of com5SnowSlide asks for; its defaults without one.

    Raises
    ------
    InputError
        If the file is no ini, or a key or its value is none that works here.

    Examples
    --------
    >>> read_ini(None).max_time
    400.0
    """
    given = _Keys(file)
    project = ProjectSettings()
    for key, name in SETTINGS.items():
        if key in given:
            project.values[name] = given.number(key)
    if given.is_blank("meshcellsize"):
        project.values["cell"] = 0.0
    project.values.update(_friction(given))
    if "snowslide" in given:
        project.values["bonds"] = given.switch("snowslide")
    if "explicitfriction" in given:
        project.values["explicit_friction"] = given.switch("explicitfriction")
    project.max_time = given.number("tend", MAX_TIME)
    project.sim_types = given.words("simtypelist", ("available", *SIM_TYPES), ("available",))
    project.release_thickness = _forced_thickness(given, "relth")
    project.entrained_thickness = _forced_thickness(given, "entth")
    project.default_entrained_thickness = given.number("entthifmissinginshp", 0.3)
    project.release_scenario = given.text("releasescenario").removesuffix(".shp")
    project.result_types = _result_types(given)
    project.saved_times = _saved_times(given, project.max_time)
    project.with_dam = given.switch("dam", True)
    project.with_secondary_release = given.switch("secrelarea", True)
    _check_kernel_radius(given, project.values["cell"])
    given.refuse_the_rest()
    return project


class _Keys:
    """The keys of an ini, lower-case, that have a value."""

    def __init__(self, file: Optional[Path]) -> None:
        self.file = file
        keys = _keys_of(file)
        self._blank = {key for key, text in keys.items() if not text.strip()}
        self._found = {key: text for key, text in keys.items() if text.strip()}

    def __contains__(self, key: str) -> bool:
        return key in self._found

    def is_blank(self, key: str) -> bool:
        return key in self._blank

    def text(self, key: str) -> str:
        return self._found.get(key, "").strip()

    def where(self, key: str) -> str:
        return f"{self.file}: {key}"

    def number(self, key: str, default: float = math.nan) -> float:
        if key not in self:
            return default
        try:
            return float(self.text(key))
        except ValueError:
            raise InputError(f"{self.where(key)}: {self.text(key)!r} is not one number") from None

    def switch(self, key: str, default: bool = False) -> bool:
        if key not in self:
            return default
        states = configparser.ConfigParser.BOOLEAN_STATES
        word = self.text(key).lower()
        if word not in states:
            raise InputError(f"{self.where(key)}: {self.text(key)!r} is neither True nor False")
        return states[word]

    def words(
        self, key: str, allowed: tuple[str, ...], default: tuple[str, ...]
    ) -> tuple[str, ...]:
        if key not in self:
            return default
        found = tuple(word.strip() for word in self.text(key).split("|"))
        for word in found:
            if word not in allowed:
                raise InputError(
                    f"{self.where(key)}: {word!r} is not available; allowed: {', '.join(allowed)}"
                )
        return found

    def refuse_the_rest(self) -> None:
        for key, text in self._found.items():
            if key in FIXED:
                if not _is_same(text, FIXED[key]):
                    raise InputError(
                        f"{self.where(key)}: {text!r} is not available; allowed: {FIXED[key]}"
                    )
            elif key in VARIATIONS:
                raise InputError(
                    f"{self.where(key)}: variations of a thickness are not available here; "
                    "vary it with `snowshed study`"
                )
            elif not (
                key in SETTINGS
                or key in OWN_KEYS
                or key in WITHOUT_EFFECT
                or key.endswith(OTHER_FRICTION)
            ):
                near = suggestion(key, [*SETTINGS, *OWN_KEYS, *FIXED])
                raise InputError(f"{self.where(key)}: none of the keys that are known here{near}")


def _keys_of(file: Optional[Path]) -> dict[str, str]:
    if file is None:
        return {}
    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read_string(read_input(file).decode("utf-8"), str(file))
    except (configparser.Error, UnicodeDecodeError) as error:
        raise InputError(f"{file}: not an ini file: {error}") from None
    found: dict[str, str] = {}
    for section in parser.sections():
        if section != "GENERAL" and not section.endswith("_override"):
            raise InputError(
                f"{file}: the section [{section}] is none of com5SnowSlide; allowed: [GENERAL], "
                "[com1DFA_com1DFA_override]"
            )
        found.update(parser.items(section))
    return found


def _friction(given: _Keys) -> dict[str, object]:
    """Return the law of friction and its Coulomb coefficient."""
    law = (given.text("frictmodel") or "voellmy").lower()
    if law not in FRICTION:
        raise InputError(
            f"{given.where('frictmodel')}: {given.text('frictmodel')!r} is not available; allowed: "
            "Voellmy, Coulomb"
        )
    key, default = FRICTION[law]
    return {"friction_law": law, "friction": given.number(key, default)}


def _forced_thickness(given: _Keys, key: str) -> Optional[float]:
    """Return the thickness that goes in place of the files'; None where they say it."""
    from_file = given.switch(f"{key}fromfile", True)
    if from_file:
        if key in given:
            raise InputError(
                f"{given.where(key)}: given, though {key}fromfile is True; set that to False, or "
                f"leave {key} empty"
            )
        return None
    if key not in given:
        if key == "entth":
            return given.number("entthifmissinginshp", 0.3)
        raise InputError(f"{given.where(key)}: missing, though {key}fromfile is False")
    return given.number(key)


def _result_types(given: _Keys) -> tuple[str, ...]:
    # The map of when snow first came is one of com1DFA's defaults; it is not made here.
    found = given.words("restype", (*RESULT_TYPES, "timeInfo"), ("ppr", "pft", "pfv"))
    return tuple(kind for kind in found if kind != "timeInfo") or ("pfv",)


def _saved_times(given: _Keys, end: float) -> tuple[float, ...]:
    """Return the times of "start:interval" or "a|b|c", s."""
    text = given.text("tsteps")
    if not text:
        return ()
    try:
        if ":" in text:
            start, interval = (float(part) for part in text.split(":"))
            if not interval > 0:
                raise ValueError
            count = max(0, math.floor((end - start) / interval + 1e-9) + 1)
            times = [start + k * interval for k in range(count)]
        else:
            times = sorted(float(part) for part in text.split("|"))
    except ValueError:
        raise InputError(
            f"{given.where('tsteps')}: {text!r} is neither start:interval nor times such as 1|5"
        ) from None
    if times and times[0] < 0:
        raise InputError(f"{given.where('tsteps')}: {times[0]:g} s is before the start")
    return tuple(times)


def _check_kernel_radius(given: _Keys, cell: object) -> None:
    text = given.text("sphkernelradius")
    if text and text.lower() != "meshcellsize" and not _is_same(text, str(cell)):
        raise InputError(
            f"{given.where('sphkernelradius')}: {text!r} is not available; allowed: meshCellSize"
        )


def _is_same(text: str, allowed: str) -> bool:
    try:
        return float(text) == float(allowed)
    except ValueError:
        pass
    states = configparser.ConfigParser.BOOLEAN_STATES
    word = text.strip().lower()
    if allowed in ("true", "false"):
        return states.get(word) == states[allowed]
    return word == allowed
