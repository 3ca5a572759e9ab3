"""The settings of an ini file of AvaFrame's com5SnowSlide: applied or refused, never ignored.

com5SnowSlide runs com1DFA with other defaults; its ini may set any parameter of com1DFA.
"""

from __future__ import annotations

import configparser
import math
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.base.limits import MAX_INI_BYTES, MAX_SAVED_TIMES
from snowshed.base.messages import printable, quoted, shortened, suggestion
from snowshed.io.input_file import read_input
from snowshed.scene.builders.avaframe.keys import (
    FIXED_VALUES,
    FRICTION,
    GROUND_SWITCHES,
    OTHER_FRICTION,
    OWN_KEYS,
    SETTINGS,
    SWITCHES,
    VARIATIONS,
    WITHOUT_EFFECT,
)
from snowshed.scene.schema import schema_of_method

MAX_TIME = 400.0  # s
MIN_STEP = 1e-6  # s; in shorter steps, rounding exceeds the motion
MAX_THICKNESS = 100.0  # m, of snow
SIM_TYPES = ("entres", "ent", "res", "null")
RESULT_TYPES = ("ppr", "pft", "pfv", "P", "FT", "FV", "sfcChange", "demAdapted")
#: Result types that need ground which adapts to the snow, and are made at the end only.
OF_CHANGED_GROUND = ("sfcChange", "demAdapted")


@dataclass
class ProjectSettings:
    """The settings of an ini.

    Attributes
    ----------
    values
        Settings of the method, by their names in `SlideSettings`.
    max_time
        Longest duration, s.
    sim_types
        "entres", "ent", "res" and "null", or "available".
    release_thickness, entrained_thickness
        Thickness of all areas [m]; None: from the files.
    default_entrained_thickness
        Entrainment thickness if the file of the areas has none, m.
    release_scenario
        Name of the only release file to take; empty: all of them.
    result_types, saved_times
        Maps to write, and their times before the end, s.
    with_dam, with_secondary_release
        Whether to take dams and secondary release areas, if there are any.
    restitution
        Restitution of dams.
    secondary_thickness
        Thickness of all secondary release areas [m]; None: from the file.
    hydrographs
        Names of the tables of a time-dependent release; empty: all in the folder REL. None: the
        release does not depend on time.
    positions
        Positions of the values in the ini, by their names.
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
    restitution: float = 1.0
    secondary_thickness: Optional[float] = None
    hydrographs: Optional[tuple[str, ...]] = None
    positions: dict[str, str] = field(default_factory=dict)

    def located(self, error: InputError) -> InputError:
        """Return an error of a scene with the position of its setting in the ini."""
        about = re.match(r"/numerics/(\w+)", str(error))
        place = self.positions.get(about[1]) if about else None
        return InputError(f"{place}: {error}") if place else error


def read_ini(file: Optional[Path]) -> ProjectSettings:
    """Return the settings of an ini of com5SnowSlide; without an ini, its defaults.

    Raises
    ------
    InputError
        If the file is not an ini, or a key or its value is not supported.

    Examples
    --------
    >>> read_ini(None).max_time
    400.0
    """
    given = _Keys(file)
    project = ProjectSettings()
    for key, name in SETTINGS.items():
        if key in given:
            project.values[name] = given.setting(key, name)
            project.positions[name] = given.where(key)
    if given.is_blank("meshcellsize"):
        project.values["cell"] = 0.0
    project.values.update(_friction(given))
    for key, name in SWITCHES.items():
        if key in given:
            project.values[name] = given.switch(key)
            project.positions[name] = given.where(key)
    project.max_time = given.number("tend", MAX_TIME, above=0, most=1e9)
    project.sim_types = given.words("simtypelist", ("available", *SIM_TYPES), ("available",))
    project.release_thickness = _forced_thickness(given, "relth")
    project.entrained_thickness = _forced_thickness(given, "entth")
    project.default_entrained_thickness = given.thickness("entthifmissinginshp", 0.3)
    project.release_scenario = given.text("releasescenario").removesuffix(".shp")
    project.result_types = _result_types(given)
    project.saved_times = _saved_times(given, project.max_time)
    project.positions["saved_times"] = given.where("tsteps")
    _check_ground_maps(given, project)
    project.with_dam = given.switch("dam", True)
    project.with_secondary_release = given.switch("secrelarea", True)
    project.secondary_thickness = _forced_thickness(given, "secondaryrelth")
    project.values["detrainment"] = _detrainment(given)
    project.restitution = _restitution(given, project.with_dam)
    project.hydrographs = _hydrographs(given)
    _check_kernel_radius(given, project.values["cell"])
    given.refuse_the_rest()
    return project


class _Keys:
    """The keys of an ini, lower-case, that have a value."""

    def __init__(self, file: Optional[Path]) -> None:
        self.file = file
        keys, self._lines = _read_keys(file)
        self._blank = {key for key, text in keys.items() if not text.strip()}
        self._found = {key: text for key, text in keys.items() if text.strip()}

    def __contains__(self, key: str) -> bool:
        return key in self._found

    def is_blank(self, key: str) -> bool:
        return key in self._blank

    def text(self, key: str) -> str:
        return self._found.get(key, "").strip()

    def where(self, key: str) -> str:
        line = f", line {self._lines[key]}" if key in self._lines else ""
        return f"{self.file}{line}: {shortened(printable(key))}"

    def number(
        self,
        key: str,
        default: float = math.nan,
        *,
        least: float = -math.inf,
        above: float = -math.inf,
        most: float = math.inf,
    ) -> float:
        """Return a number in a range; the default if it is not given."""
        if key not in self:
            return default
        text = self.text(key)
        try:
            value = float(text)
        except ValueError:
            raise InputError(f"{self.where(key)}: {quoted(text)} is not one number") from None
        if not (math.isfinite(value) and value >= least and value > above and value <= most):
            bounds = [
                *([f"above {above:g}"] if math.isfinite(above) else []),
                *([f"at least {least:g}"] if math.isfinite(least) else []),
                *([f"at most {most:g}"] if math.isfinite(most) else []),
            ]
            allowed = " and ".join(bounds) or "a finite number"
            raise InputError(f"{self.where(key)}: {quoted(text)}; allowed: {allowed}")
        return value

    def setting(self, key: str, name: str, default: float = math.nan) -> float:
        """Return a number in the range of a setting of the method."""
        schema: Any = schema_of_method("slide")
        (settings,) = schema["properties"]["numerics"]["anyOf"]
        range_ = settings["properties"][name]
        least = range_.get("minimum", -math.inf)
        return self.number(
            key,
            default,
            least=max(least, MIN_STEP) if name == "time_step" else least,
            above=range_.get("exclusiveMinimum", -math.inf) if name != "time_step" else -math.inf,
            most=range_.get("maximum", math.inf),
        )

    def thickness(self, key: str, default: float = math.nan) -> float:
        """Return a thickness of snow, m."""
        return self.number(key, default, above=0, most=MAX_THICKNESS)

    def switch(self, key: str, default: bool = False) -> bool:
        if key not in self:
            return default
        states = configparser.ConfigParser.BOOLEAN_STATES
        word = self.text(key).lower()
        if word not in states:
            raise InputError(
                f"{self.where(key)}: {quoted(self.text(key))} is neither True nor False"
            )
        return states[word]

    def words(
        self, key: str, allowed: tuple[str, ...], default: tuple[str, ...]
    ) -> tuple[str, ...]:
        if key not in self:
            return default
        names = tuple(word.strip() for word in self.text(key).split("|"))
        for word in names:
            if word not in allowed:
                raise InputError(
                    f"{self.where(key)}: {quoted(word)} is not available; allowed: "
                    f"{', '.join(allowed)}"
                )
        return names

    def refuse_the_rest(self) -> None:
        for key, text in self._found.items():
            if key in FIXED_VALUES:
                if not _is_same(text, FIXED_VALUES[key]):
                    raise InputError(
                        f"{self.where(key)}: {quoted(text)} is not available; allowed: "
                        f"{FIXED_VALUES[key]}"
                    )
            elif key in VARIATIONS:
                raise InputError(
                    f"{self.where(key)}: variations of a thickness are not available here; "
                    "vary it with `snowshed study`"
                )
            elif not (
                key in SETTINGS
                or key in SWITCHES
                or key in OWN_KEYS
                or key in WITHOUT_EFFECT
                or key.endswith(OTHER_FRICTION)
            ):
                near = suggestion(key, [*SETTINGS, *SWITCHES, *OWN_KEYS, *FIXED_VALUES])
                raise InputError(f"{self.where(key)}: unknown key{near}")


def _read_keys(file: Optional[Path]) -> tuple[dict[str, str], dict[str, int]]:
    """Return the values of the keys, and the lines of the keys."""
    if file is None:
        return {}, {}
    if not file.is_file():
        raise InputError(f"{file}: not a regular file")
    parser = configparser.ConfigParser(interpolation=None)
    try:
        text = read_input(file, MAX_INI_BYTES).decode("utf-8-sig")
        parser.read_string(text, str(file))
    except (configparser.Error, UnicodeDecodeError) as error:
        why = shortened(" ".join(printable(error).split()), 300)
        raise InputError(f"{file}: not an ini file: {why}") from None
    values: dict[str, str] = {}
    for section in parser.sections():
        if section != "GENERAL" and not section.endswith("_override"):
            raise InputError(
                f"{file}: the section [{shortened(printable(section))}] is none of com5SnowSlide; "
                "allowed: [GENERAL], [com1DFA_com1DFA_override]"
            )
        values.update(parser.items(section))
    return values, _key_lines(text)


def _key_lines(text: str) -> dict[str, int]:
    """Return the line of each key, from 1; of a repeated key the last line, as for its value."""
    lines: dict[str, int] = {}
    for number, line in enumerate(text.splitlines(), 1):
        if key := re.match(r"([^\s#;\[=:][^=:]*?)\s*[=:]", line):
            lines[key[1].lower()] = number
    return lines


def _friction(given: _Keys) -> dict[str, object]:
    """Return the law of friction and its Coulomb coefficient."""
    law = (given.text("frictmodel") or "voellmy").lower()
    if law not in FRICTION:
        raise InputError(
            f"{given.where('frictmodel')}: {quoted(given.text('frictmodel'))} is not available; "
            "allowed: Voellmy, Coulomb"
        )
    key, default = FRICTION[law]
    return {"friction_law": law, "friction": given.setting(key, "friction", default)}


def _forced_thickness(given: _Keys, key: str) -> Optional[float]:
    """Return the thickness that replaces that of the files; None if the files give it."""
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
            return given.thickness("entthifmissinginshp", 0.3)
        raise InputError(f"{given.where(key)}: missing, though {key}fromfile is False")
    return given.thickness(key)


def _detrainment(given: _Keys) -> float:
    """Return Feistl's coefficient, Pa; 0 without detrainment."""
    coefficient = given.setting("detk", "detrainment", 5.0)
    return coefficient if given.switch("detrainment") else 0.0


def _restitution(given: _Keys, with_dam: bool) -> float:
    """Return the restitution of dams; AvaFrame cuts it to a whole number."""
    value = given.number("restitutioncoefficient", 1.0, least=0.0, most=1.0)
    if not with_dam:
        return value
    for key in ("niterdam", "dissdam"):
        if given.number(key, 1.0) != 1.0:
            raise InputError(
                f"{given.where(key)}: {quoted(given.text(key))} is not available; allowed: 1"
            )
    return value


def _hydrographs(given: _Keys) -> Optional[tuple[str, ...]]:
    if not given.switch("timedependentrelease"):
        return None
    if given.number("thresholdpointinrel", 0.01) != 0.01:
        raise InputError(
            f"{given.where('thresholdpointinrel')}: {quoted(given.text('thresholdpointinrel'))} is "
            "not available; allowed: 0.01"
        )
    names = given.text("timedependentreleasescenarios").split("|")
    return tuple(name.strip().removesuffix(".csv") for name in names if name.strip())


def _result_types(given: _Keys) -> tuple[str, ...]:
    # com1DFA also writes a map of the first arrival of snow by default; it is not made here.
    types = given.words("restype", (*RESULT_TYPES, "timeInfo"), ("ppr", "pft", "pfv"))
    return tuple(kind for kind in types if kind != "timeInfo") or ("pfv",)


def _check_ground_maps(given: _Keys, project: ProjectSettings) -> None:
    """Refuse maps of the changed ground without changes, and before the end."""
    wanted = [kind for kind in project.result_types if kind in OF_CHANGED_GROUND]
    if not wanted:
        return
    if not any(project.values.get(name) for name in GROUND_SWITCHES.values()):
        raise InputError(
            f"{given.where('restype')}: {wanted[0]} needs adaptSfcStopped, adaptSfcDetrainment or "
            "adaptSfcEntrainment"
        )
    if project.saved_times:
        raise InputError(
            f"{given.where('restype')}: {wanted[0]} is made at the end only; leave tSteps empty"
        )


def _saved_times(given: _Keys, end: float) -> tuple[float, ...]:
    """Return the times of "start:interval" or "a|b|c", s."""
    text = given.text("tsteps")
    if not text:
        return ()
    try:
        if ":" in text:
            start, interval = (_finite(part) for part in text.split(":"))
            if not interval > 0:
                raise ValueError
            count = max(0.0, (end - start) / interval + 1e-9 + 1)
            if count <= MAX_SAVED_TIMES:
                times = [start + k * interval for k in range(math.floor(count))]
        else:
            count = text.count("|") + 1
            times = (
                sorted(_finite(part) for part in text.split("|"))
                if count <= MAX_SAVED_TIMES
                else []
            )
    except ValueError:
        raise InputError(
            f"{given.where('tsteps')}: {quoted(text)} is neither start:interval nor times such as "
            "1|5"
        ) from None
    if count > MAX_SAVED_TIMES:
        raise InputError(
            f"{given.where('tsteps')}: {quoted(text)} are {count:.3g} times until {end:g} s; "
            f"allowed: {MAX_SAVED_TIMES}"
        )
    if times and times[0] < 0:
        raise InputError(f"{given.where('tsteps')}: {times[0]:g} s is before the start")
    return tuple(times)


def _finite(text: str) -> float:
    """Return a finite number; anything else is a ValueError."""
    value = float(text)
    if not math.isfinite(value):
        raise ValueError
    return value


def _check_kernel_radius(given: _Keys, cell: object) -> None:
    text = given.text("sphkernelradius")
    if text and text.lower() != "meshcellsize" and not _is_same(text, str(cell)):
        raise InputError(
            f"{given.where('sphkernelradius')}: {quoted(text)} is not available; allowed: "
            "meshCellSize"
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
