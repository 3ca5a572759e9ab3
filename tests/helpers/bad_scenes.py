"""Invalid scenes: changes to a valid scene, each with a part of its error message."""

import json
from pathlib import Path
from typing import Any

import pytest
from conftest import tiny_scene

# A tetrahedron without its last face, and the complete tetrahedron.
OPEN_MESH = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"
CLOSED_MESH = OPEN_MESH + "f 2 3 4\n"


def mesh(file: str, **fields: Any) -> dict:
    return {"shape": {"type": "mesh", "file": file, **fields}}


BAD_SCENES = {
    "unknown key": ({"wind": 3}, "/wind: unknown key"),
    "unknown inner key": ({"snow": {"densty": 1}}, "/snow/densty: unknown key"),
    "another version": ({"snowshed": 3}, "/snowshed: 3"),
    "wrong type": ({"snow": {"density": "heavy"}}, '/snow/density: "heavy" is not a number'),
    "not whole": ({"events": {"count": 1.5}}, "/events/count: 1.5"),
    "not a number": ({"snow": {"density": float("nan")}}, "bad.json:1:"),
    "infinite": ({"snow": {"density": float("inf")}}, "bad.json:1:"),
    "negative density": ({"snow": {"density": -1}}, "/snow/density: -1"),
    "incompressible": ({"snow": {"poissons_ratio": 0.5}}, "/snow/poissons_ratio: 0.5"),
    "overhanging panel": ({"panel": {"tilt": 120}}, "/panel/tilt: 120"),
    "outside the domain": ({"domain": {"min": [5, 5], "max": [6, 6]}}, "/slab: "),
    "slab longer than panel": ({"slab": {"length": 3}}, "/slab/length: 3"),
    "too few particles": ({"seeding": {"particles_per_voxel": 2}}, "/seeding/particles_per_voxel"),
    "too much memory": ({"numerics": {"dx": 1e-6}}, "GB of memory"),
    "mesh that needs too much memory": (
        {"bodies": [mesh("closed.obj", scale=1e4)], "numerics": {"dx": 0.01}},
        "GB of memory",
    ),
    "open mesh": ({"obstacles": [mesh("open.obj")]}, "open.obj: the edge"),
    "open mesh in a later event": ({"bodies": [{**mesh("open.obj"), "event": 2}]}, "open.obj"),
    "missing mesh": ({"bodies": [{**mesh("none.obj"), "event": 2}]}, "none.obj: no such file"),
    "body smaller than a particle": (
        {"bodies": [{"shape": {"type": "sphere", "center": [1, 1], "radius": 1e-6}, "event": 2}]},
        "/bodies/0/shape: too small",
    ),
}


def merged(data: Any, changes: Any) -> Any:
    if not isinstance(data, dict) or not isinstance(changes, dict):
        return changes
    return {**data, **{key: merged(data.get(key), value) for key, value in changes.items()}}


@pytest.fixture(params=BAD_SCENES.values(), ids=BAD_SCENES.keys())
def bad_scene(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[Path, str]:
    """A scene file in a folder with its meshes, and a part of the error message."""
    changes, message = request.param
    data = merged(tiny_scene().resolve().data, changes)
    (tmp_path / "open.obj").write_text(OPEN_MESH)
    (tmp_path / "closed.obj").write_text(CLOSED_MESH)
    (tmp_path / "bad.json").write_text(json.dumps(data))
    return tmp_path / "bad.json", message
