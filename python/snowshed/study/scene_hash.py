"""The identity of a run: the content hash of its scene.

The hash covers everything that decides a result: the complete scene as the core normalises it, and
the version of snowshed. Files such as meshes and grids count by their contents, not by their paths.
The title, the output and the number of threads do not change a result and are left out. The
instruction set and the device are left out, too, so that a study may be resumed on another machine.
``SNOWSHED_KERNELS`` makes all processors round alike.
"""

from __future__ import annotations

import functools
import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import snowshed._core as _core
from snowshed.io.input_file import read_regular
from snowshed.running.ageing.ageing import Ageing
from snowshed.running.laws import precision_of
from snowshed.scene.named_files import with_named_files
from snowshed.scene.scene import ResolvedScene
from snowshed.study.aged_scene import LAWS, with_ageing
from snowshed.study.named_laws import NamedLaws

HASH_DIGITS = 32  # hexadecimal: 128 bits
HASH = re.compile(f"[0-9a-f]{{{HASH_DIGITS}}}")
WITHOUT_EFFECT = ("title", "output")
#: Descriptions of terrain files and assumptions about them: a result does not depend on these.
TERRAIN_WITHOUT_EFFECT = ("notes", "max_slope", "max_thickness")
#: Settings are hashed under the name of the first version, so that runs of that version are
#: recognised; for the same reason a scene of the default method does not name it.
HASHED_AS = {"courant_factor": "step_factor"}
#: Settings that do not decide a result by themselves: a scheme is a name for others.
SETTINGS_WITHOUT_EFFECT = ("threads", "device", "scheme")
#: Settings of later versions, with the value that stands for the former behaviour. A setting
#: with this value is left out of the hash.
FORMER_BEHAVIOUR: Mapping[str, object] = {
    "damping_length": 0.0,
    "crack_band_length": 0.0,
    "relaxation_time": 0.0,
    "contact": "kernel",
    "contact_radius": 0.6,
    "fields": "one",
    "event_friction": 1.0,
}
#: The same for contact conditions: "separate" was called "slip" in version 1 of scenes.
CONDITION_HASHED_AS = {"separate": "slip", "slip": "slip of version 2"}


@dataclass(frozen=True)
class RunKey:
    """One run of a study.

    Attributes
    ----------
    hash
        Content hash, 32 hexadecimal digits.
    scene
        The complete scene as JSON, with absolute paths of the files that it names, and the ageing
        of its stack and its laws (`snowshed.study.aged_scene`).
    """

    hash: str
    scene: str

    @classmethod
    def of(
        cls,
        scene: ResolvedScene,
        ageing: Optional[Ageing] = None,
        laws: Optional[NamedLaws] = None,
    ) -> RunKey:
        """Return the run of a scene, without the outputs that a study does not store.

        Parameters
        ----------
        scene
            The scene.
        ageing
            Ageing of its stack between events; None: it does not age.
        laws
            Laws of one's own; None: those of the scene.

        Examples
        --------
        >>> from snowshed import Scene
        >>> lab = Scene.preset("lab-50")
        >>> one = RunKey.of(lab.resolve())
        >>> one == RunKey.of(lab.set("numerics.threads", 3).resolve())
        True
        >>> one.hash == RunKey.of(lab.set("panel.tilt", 51).resolve()).hash
        False
        """
        data = with_ageing(scene.copied_data(), ageing)
        if laws is not None:
            data[LAWS] = laws.data(precision_of(data))
        data["numerics"]["threads"] = 0
        data["output"].update(snapshot_interval=0.0, film=False, energy=False)
        return cls(content_hash(data), json.dumps(data))


def is_hash(name: str) -> bool:
    """Return whether a text is a content hash, so that it can only name the folder of a run.

    Examples
    --------
    >>> is_hash("0123456789abcdef0123456789abcdef"), is_hash("../../victim")
    (True, False)
    """
    return HASH.fullmatch(name) is not None


def content_hash(scene: Mapping[str, Any]) -> str:
    """Return the hash of a complete scene.

    Parameters
    ----------
    scene
        JSON data as the core normalises it.

    Raises
    ------
    OSError
        If a file that the scene names cannot be read.
    """
    content = {key: value for key, value in scene.items() if key not in WITHOUT_EFFECT}
    if content.get("misplaced_snow") == "refuse":  # the default; earlier versions had no such key
        del content["misplaced_snow"]
    if not content.get("sample", {}).get("split_labels", True):  # as before this choice existed
        content["sample"] = {k: v for k, v in content["sample"].items() if k != "split_labels"}
    if content.get("bodies"):
        content["bodies"] = [_without_default_volume(body) for body in content["bodies"]]
    if scene.get("snowshed") != 1:
        content = _as_version_1(content)
    content["numerics"] = {
        HASHED_AS.get(key, key): value
        for key, value in scene["numerics"].items()
        if key not in SETTINGS_WITHOUT_EFFECT
        and not (key in FORMER_BEHAVIOUR and value == FORMER_BEHAVIOUR[key])
    }
    if content.get("terrain"):
        terrain = content["terrain"].items()
        content["terrain"] = {k: v for k, v in terrain if k not in TERRAIN_WITHOUT_EFFECT}
    hashed = {"snowshed": _core.version, "scene": with_named_files(content, _cached_digest)}
    text = json.dumps(hashed, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:HASH_DIGITS]


def _without_default_volume(body: Mapping[str, Any]) -> dict[str, Any]:
    """Return a body without the volume of its solid; earlier versions had no such key."""
    return {key: value for key, value in body.items() if key != "volume" or value}


def _as_version_1(scene: dict[str, Any]) -> dict[str, Any]:
    """Return a scene with version 1 and the names of conditions in that version."""
    older = {**scene, "snowshed": 1}
    for key in {"panel", "ground"} & scene.keys():
        older[key] = _condition_of_version_1(scene[key])
    older["obstacles"] = [
        _condition_of_version_1(obstacle) for obstacle in scene.get("obstacles", ())
    ]
    return older


def _condition_of_version_1(part: dict[str, Any]) -> dict[str, Any]:
    condition = part["condition"]
    return {**part, "condition": CONDITION_HASHED_AS.get(condition, condition)}


def _cached_digest(path: str) -> str:
    facts = Path(path).stat()
    return _digest(path, facts.st_mtime_ns, facts.st_size)


@functools.lru_cache(maxsize=64)
def _digest(path: str, modified: int, size: int) -> str:
    """Return the digest of a file's content; cached, because runs share their files."""
    return hashlib.sha256(read_regular(Path(path))).hexdigest()
