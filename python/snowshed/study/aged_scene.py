"""The scene of a run and the ageing of its stack between events, in a single JSON object.

A study stores a JSON object for each run: the complete scene with the additional key ``ageing``, if
the stack ages between events, and ``laws``, if it has laws of its own
(`snowshed.study.named_laws`). The identity of the run thus covers all three.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, Optional

from snowshed.io.json_file import parse_object
from snowshed.running.ageing.ageing import Ageing

KEY = "ageing"
LAWS = "laws"


def with_ageing(scene: Mapping[str, Any], ageing: Optional[Ageing]) -> dict[str, Any]:
    """Return a scene with the ageing of its stack.

    Parameters
    ----------
    scene
        JSON data.
    ageing
        Ageing of the stack; None: it does not age.

    Examples
    --------
    >>> sorted(with_ageing({"dimension": 2}, Ageing(settling="vionnet-2012")))
    ['ageing', 'dimension']
    """
    return dict(scene) if ageing is None else {**scene, KEY: ageing.data}


def split_ageing(text: str) -> tuple[dict[str, Any], Optional[Ageing]]:
    """Return the scene of a run, as JSON data without its laws, and the ageing of its stack.

    Parameters
    ----------
    text
        JSON text of a scene from `with_ageing`.

    Raises
    ------
    InputError
        If it is not a JSON object, or its ageing is invalid.

    Examples
    --------
    >>> split_ageing('{"dimension": 2}')
    ({'dimension': 2}, None)
    """
    data: dict[str, Any] = parse_object(text, "scene")
    ageing = data.pop(KEY, None)
    data.pop(LAWS, None)
    return data, None if ageing is None else Ageing.from_data(ageing, f"scene: {KEY}")


def without_ageing(text: str) -> str:
    """Return the scene of a run without its ageing and its laws, as JSON."""
    added = any(f'"{key}"' in text for key in (KEY, LAWS))
    return json.dumps(split_ageing(text)[0]) if added else text
