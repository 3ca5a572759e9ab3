"""The settings of a scene that decide the accuracy of a run, but not its subject."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from snowshed.base.json_values import JsonValue
from snowshed.methods.registry import DEFAULT, METHODS, NAME_KEY, SETTINGS_KEY
from snowshed.scene.schema import Parameter, scene_parameters

#: Cells across the slab; with fewer its stack is coarse.
MIN_CELLS_ACROSS = 2.0


def _is_in_other_section(parameter: Parameter) -> bool:
    return not parameter.path.startswith(f"{SETTINGS_KEY}.")


_METHOD_SETTINGS: Mapping[str, Mapping[str, str]] = {
    method: {
        p.path.rpartition(".")[2]: p.path
        for p in sorted(scene_parameters(method), key=_is_in_other_section)
        if p.accuracy
    }
    for method in METHODS
}

#: Path in a scene of the default method of each setting that the schema marks; the method's own
#: settings come first.
ACCURACY: Mapping[str, str] = _METHOD_SETTINGS[DEFAULT]

#: Numeric settings of all methods. A scene may lack a setting whose place another one takes.
NUMBERS: Sequence[str] = [
    p.path.rpartition(".")[2]
    for method in METHODS
    for p in scene_parameters(method)
    if p.accuracy and p.kind == "number"
]

#: Former names of settings, which occur in tables and records, and their current names.
FORMER_NAMES: Mapping[str, str] = {
    alias.rpartition(".")[2]: p.path.rpartition(".")[2]
    for p in scene_parameters()
    for alias in p.aliases
    if p.accuracy
}


def accuracy_of(scene: Mapping[str, JsonValue]) -> Mapping[str, str]:
    """Return the accuracy settings of a scene's method, each with its path in the scene.

    Examples
    --------
    >>> list(accuracy_of({"method": "slide"}))
    ['cell', 'time_step', 'layer_thickness']
    """
    return _METHOD_SETTINGS[str(scene.get(NAME_KEY) or DEFAULT)]
