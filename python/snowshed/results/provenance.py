"""The origin of results: the version and build of snowshed, and the scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

import snowshed._core as _core
from snowshed.base.build import build_id
from snowshed.io.run_files import origin_of_record
from snowshed.scene.resolved import ResolvedScene

Result = TypeVar("Result")


def with_origin(result: Result, origin: Mapping[str, str]) -> Result:
    """Add the origin of a table or Dataset to its `attrs`, and return it; others stay."""
    attributes = getattr(result, "attrs", None)
    if isinstance(attributes, dict):
        attributes.update(origin)
    return result


def present_origin(scene: ResolvedScene) -> dict[str, str]:
    """Return the origin of what this process computes from a scene."""
    return {"snowshed_version": _core.version, "snowshed_build": build_id(), "scene": scene.json}


def recorded_origin(scene: ResolvedScene, record: Mapping[str, Any]) -> dict[str, str]:
    """Return the origin of the results of a run.

    Parameters
    ----------
    scene
        The scene of the run.
    record
        The content of run.json. Builds of earlier versions are unknown.

    Examples
    --------
    >>> from snowshed.scene.scene import Scene
    >>> record = {"version": "0.1.0", "build": "e09705a3e90a", "package": "9586848eeb18"}
    >>> recorded_origin(Scene.preset("lab-50").resolve(), record)["snowshed_build"]
    'e09705a3e90a-9586848eeb18'
    """
    return {**origin_of_record(record), "scene": scene.json}
