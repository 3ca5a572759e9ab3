"""The field of a file of polygons that holds the thickness of snow, and its unit."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.base.formatting import number_in
from snowshed.base.messages import quoted
from snowshed.base.notes import InputNote, issue_note

#: Names of the field; the first is AvaFrame's.
NAMES = ("thickness", "d0")
#: The same with a unit: thickness_cm, d0 (mm), "Thickness [m]".
WITH_UNIT = re.compile(r"(thickness|d0)[\s_.\-]*[(\[]?\s*([a-z]+\d?)\s*[)\]]?", re.IGNORECASE)
METRES = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001}
#: Words in names of fields that may mean a thickness.
ALIKE = ("thick", "depth", "height", "d0", "hoehe", "höhe", "dicke", "mächtig", "epaisseur")
CUT_NAME = "thickness_"  # of a name with a unit in a shapefile
BLANK = ("", "none", "nan", "null")


@dataclass(frozen=True)
class ThicknessField:
    """A field that holds the thickness of snow.

    Attributes
    ----------
    name
        Name of the field in the file.
    metres
        Length of its unit, m.
    """

    name: str
    metres: float

    def value(self, record: Mapping[str, Any], where: str) -> Optional[float]:
        """Return the thickness of a feature, m; None if the feature has none.

        Raises
        ------
        InputError
            If the value is not a number above 0.
        """
        value = record.get(self.name)
        if value is None or str(value).strip().lower() in BLANK:
            return None
        number = float(value) if isinstance(value, float) else number_in(str(value))
        if math.isnan(number):
            raise InputError(f"{where}: {self.name} {quoted(str(value))} is not a number")
        if not number > 0:
            unit = (
                "m"
                if self.metres == 1.0
                else next(u for u, m in METRES.items() if m == self.metres)
            )
            raise InputError(f"{where}: {self.name} is {number:g} {unit}; give one above 0")
        return number * self.metres


def thickness_fields(fields: Sequence[str], file: str) -> list[ThicknessField]:
    """Return the fields of a file that hold a thickness, in order of preference.

    Notes report what the names do not show: another unit, and ignored fields.

    Raises
    ------
    InputError
        If a field's name has a unit that is not known.

    Examples
    --------
    >>> thickness_fields(["fid", "Thickness"], "a.shp")
    [ThicknessField(name='Thickness', metres=1.0)]
    """
    candidates = [
        ThicknessField(field, 1.0) for name in NAMES for field in fields if _is(field, name)
    ]
    for field in fields:
        unit = WITH_UNIT.fullmatch(field.strip())
        if unit is None or any(_is(field, name) for name in NAMES):
            continue
        if unit[2].lower() not in METRES:
            if unit[2].lower() in (
                "ft",
                "feet",
                "in",
                "inch",
                "inches",
                "kpa",
                "kgm2",
                "we",
                "swe",
            ):
                raise InputError(
                    f"{file}: its field {quoted(field)} has the unit {quoted(unit[2])}; allowed: "
                    f"{', '.join(METRES)}"
                )
            continue
        candidates.append(ThicknessField(field, METRES[unit[2].lower()]))
    if candidates and candidates[0].name != NAMES[0]:
        in_unit = next(unit for unit, metres in METRES.items() if metres == candidates[0].metres)
        name = quoted(candidates[0].name)
        issue_note(f"{file}: the thickness is that of its field {name}, in {in_unit}", InputNote)
    if not candidates:
        alike = [field for field in fields if any(word in field.lower() for word in ALIKE)]
        if alike:
            issue_note(
                f"{file}: no field is called thickness or d0; ignored as a thickness: "
                f"{', '.join(quoted(field) for field in alike[:5])}{_cut_hint(alike)}",
                InputNote,
            )
    return candidates


def note_replaced_fields(fields: Sequence[str], file: str, replacement: str) -> None:
    """Issue a note if a file has fields that hold a thickness, which something else replaces.

    Parameters
    ----------
    fields
        Names of the fields of the file.
    file
        Name of the file, which the note states.
    replacement
        Source of the thickness in their place, such as an argument or a raster.

    Examples
    --------
    >>> note_replaced_fields(["fid"], "a.shp", "--thickness")
    """
    unused = [
        quoted(field)
        for field in fields
        if WITH_UNIT.fullmatch(field.strip()) or any(_is(field, name) for name in NAMES)
    ]
    if unused:
        issue_note(
            f"{file}: the thickness is that of {replacement}, not of its field "
            f"{' and '.join(unused)}",
            InputNote,
        )


def thickness_of(
    fields: Sequence[ThicknessField], record: Mapping[str, Any], where: str
) -> Optional[float]:
    """Return the thickness of a feature, m; None if no field holds it.

    Raises
    ------
    InputError
        If two fields contradict each other.
    """
    given = [(field.name, field.value(record, where)) for field in fields]
    stated = [(name, value) for name, value in given if value is not None]
    for name, value in stated[1:]:
        if not math.isclose(value, stated[0][1], rel_tol=1e-6):
            raise InputError(
                f"{where}: {stated[0][0]} says {stated[0][1]:g} m and {name} {value:g} m; keep one "
                "of the fields"
            )
    return stated[0][1] if stated else None


def _cut_hint(fields: Sequence[str]) -> str:
    """Return a hint if a shapefile has cut the unit off a name."""
    if CUT_NAME not in fields:
        return ""
    return "; a shapefile cuts names after ten characters: call a field in cm d0_cm"


def _is(field: str, name: str) -> bool:
    return field.strip().lower() == name
