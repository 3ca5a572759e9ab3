"""Which settings of a scene decide how accurate a run is, and not what is simulated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from snowshed.methods.registry import SETTINGS_KEY
from snowshed.scene.schema import Parameter, scene_parameters


def _of_other_section(parameter: Parameter) -> bool:
    return not parameter.path.startswith(f"{SETTINGS_KEY}.")


#: Where in a scene each setting stands: those that the schema marks, the method's own first.
ACCURACY: Mapping[str, str] = {
    p.path.rpartition(".")[2]: p.path
    for p in sorted(scene_parameters(), key=_of_other_section)
    if p.accuracy
}

#: Those that are numbers; one that stands in another's place may be missing in a scene.
NUMBERS: Sequence[str] = [
    p.path.rpartition(".")[2] for p in scene_parameters() if p.accuracy and p.kind == "number"
]

#: Names that settings had in earlier versions, and thus in tables and records, to those of today.
FORMER_NAMES: Mapping[str, str] = {
    alias.rpartition(".")[2]: p.path.rpartition(".")[2]
    for p in scene_parameters()
    for alias in p.aliases
    if p.accuracy
}
