"""Units of heights, and the vertical part of coordinate systems, in metres."""

from __future__ import annotations

import importlib
import json
import math
import re
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.base.messages import quoted

FOOT, SURVEY_FOOT = 0.3048, 1200.0 / 3937.0  # m
#: Lengths, m, of units of rasters; their names without capitals, blanks, brackets and plural s.
METRES = {
    **dict.fromkeys(("m", "metre", "meter", "mtr"), 1.0),
    **dict.fromkeys(("ft", "foot", "feet", "internationalfoot", "internationalfeet"), FOOT),
    **dict.fromkeys(("ftint", "footinternational", "ift"), FOOT),
    **dict.fromkeys(("ussurveyfoot", "ussurveyfeet", "surveyfoot", "surveyfeet"), SURVEY_FOOT),
    **dict.fromkeys(("usfoot", "usfeet", "footu", "feetu", "usft", "ftu", "sft"), SURVEY_FOOT),
    **dict.fromkeys(("ussft", "ftussurvey", "footussurvey", "ussurveyft"), SURVEY_FOOT),
    **dict.fromkeys(("dm", "decimetre", "decimeter"), 0.1),
    **dict.fromkeys(("cm", "centimetre", "centimeter"), 0.01),
    **dict.fromkeys(("mm", "millimetre", "millimeter"), 0.001),
    **dict.fromkeys(("km", "kilometre", "kilometer"), 1000.0),
    **dict.fromkeys(("yd", "yard"), 3.0 * FOOT),
    **dict.fromkeys(("in", "inch", "inche"), FOOT / 12.0),
}


def metres_of(unit: str, name: str) -> float:
    """Return the length of a unit of heights, m.

    Parameters
    ----------
    unit
        Name of the unit in a file, such as "ft" or "US survey foot".
    name
        Name of the file, for the message.

    Raises
    ------
    InputError
        If the unit is not a length.

    Examples
    --------
    >>> metres_of("US survey feet", "dem.tif") == 1200 / 3937, metres_of("[Metres]", "dem.tif")
    (True, 1.0)
    """
    spelt = re.sub(r"[\W_]", "", unit.casefold())
    for text in (spelt, spelt[:-1] if spelt.endswith("s") else spelt):
        if text in METRES:
            return METRES[text]
    raise InputError(
        f"{name}: its values are in {quoted(unit)}, which is not a unit of length; give metres"
    )


def split_system(system: Any, name: str) -> tuple[str, Optional[float]]:
    """Return the horizontal part of a coordinate system, and the length of its vertical unit, m.

    Parameters
    ----------
    system
        The coordinate system from rasterio.
    name
        Name of the file, for the message.

    Returns
    -------
    str, float or None
        The horizontal system as text, such as "EPSG:25833", and the vertical unit, if given.

    Raises
    ------
    InputError
        If its vertical axis points downward (depths).
    """
    data: dict[str, Any] = system.to_dict(projjson=True)
    parts = data.get("components") or [data]
    axis = _vertical_axis(parts[-1])
    if axis is None:
        return system.to_string(), None
    if axis.get("direction") == "down":
        raise InputError(f"{name}: its coordinate system counts depths, downward; give elevations")
    horizontal = system if len(parts) == 1 else type(system).from_user_input(json.dumps(parts[0]))
    return horizontal.to_string(), _metres_of_axis(axis, name)


def split_vertical(description: str, name: str) -> tuple[str, Optional[float]]:
    """Split a coordinate system given as text, as `split_system`; unchanged without rasterio."""
    try:
        rasterio = importlib.import_module("rasterio")
    except ImportError:
        return description, None
    code = re.fullmatch(r"EPSG:(\d+)", description)
    systems = rasterio.crs.CRS
    try:
        system = systems.from_epsg(int(code[1])) if code else systems.from_wkt(description)
    except rasterio.errors.CRSError:
        return description, None
    horizontal, metres = split_system(system, name)
    return (description if metres is None else horizontal), metres


def _vertical_axis(part: dict[str, Any]) -> Optional[dict[str, Any]]:
    """Return the axis of heights of a part of a coordinate system, if it has one."""
    axes = part.get("coordinate_system", {}).get("axis", [])
    vertical = [axis for axis in axes if axis.get("direction") in ("up", "down")]
    return vertical[0] if vertical else None


def _metres_of_axis(axis: dict[str, Any], name: str) -> float:
    unit = axis.get("unit", "metre")
    if not isinstance(unit, dict):
        return metres_of(str(unit), name)
    factor = float(unit.get("conversion_factor", math.nan))
    return factor if factor > 0 else metres_of(str(unit.get("name")), name)
