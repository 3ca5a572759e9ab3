"""Studies are read back from their files without changes."""

import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from snowshed import Ground, InputError, Obstacle, Scene, Shape
from snowshed.io.toml import toml_lines
from snowshed.study import Factor, Study, axis, linear

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

KEYS = st.text(min_size=1).filter(lambda key: "." not in key)
VALUES = st.recursive(
    st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(KEYS, inner),
    max_leaves=20,
)


@given(st.dictionaries(KEYS, VALUES))
def test_toml_is_read_back_as_written(data):
    assert tomllib.loads("\n".join(toml_lines(data))) == data


def test_values_without_a_toml_form_are_refused():
    for value in (None, 1j, object()):
        with pytest.raises(InputError, match="cannot be written as TOML"):
            list(toml_lines({"a": [value]}))


def scene():
    result = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    result.append("obstacles", Obstacle(shape=Shape.box((3, 0), (1, 1)), friction=0.2))
    return result


PARTS = [
    [],
    [axis("panel.friction", linear(0.1, 0.3, step=0.1)), axis("events.count", [1, 2])],
    # Interleaved axes of the same part of a scene keep their order.
    [axis("panel.tilt", [40]), axis("snow.cohesion", [0.1]), axis("panel.friction", [0.2, 0.3])],
    [Factor({"panel.height": [0.3, 0.4], "panel.length": [0.2, 0.3]}), axis("panel.tilt", [40])],
    [axis("panel.tilt", np.array([40.5, 50])), axis("obstacles.0.friction", [0.1, 0.4])],
    [axis("panel.condition", ["slip", "sticky"])],
]


@pytest.mark.parametrize("parts", [*([part] for part in PARTS), PARTS[1:3], PARTS[1:]])
@pytest.mark.parametrize("seeds", [None, [1, 7]])
def test_a_study_is_read_back_from_its_file(tmp_path, parts, seeds):
    study = Study(scene(), parts, "a name", seeds, 'What "it" is for.')
    study.save(tmp_path / "study.toml")
    read = Study.load(tmp_path / "study.toml")
    assert read.runs() == study.runs()
    assert (read.axes, read.name, read.description) == (study.axes, study.name, study.description)
    assert read.to_toml() == study.to_toml()


def test_paths_in_a_scene_do_not_depend_on_the_working_folder(tmp_path, monkeypatch):
    np.save(tmp_path / "a.npy", np.hypot(*np.mgrid[-1:2, -1:2]) * 0.1 - 0.05)
    monkeypatch.chdir(tmp_path)
    shape = Shape.grid("a.npy", origin=(3, 0), spacing=0.1)
    study = Study.product(scene().append("obstacles", Obstacle(shape=shape)), {})
    (tmp_path / "folder").mkdir()
    study.save("folder/study.toml")
    monkeypatch.chdir("/")
    assert str(tmp_path / "a.npy") in Study.load(tmp_path / "folder" / "study.toml").runs()[0].scene


def test_parts_of_a_scene_with_only_defaults_are_written(tmp_path):
    bare = Scene().update({"dimension": 2, "numerics.dx": 0.05, "slab.thickness": 0.1})
    study = Study.product(
        bare.set("ground", {}), {"panel.tilt": [40], "panel.height": [1], "panel.length": [1]}
    )
    study.save(tmp_path / "study.toml")
    read = Study.load(tmp_path / "study.toml")
    assert read.scene.ground == Ground()
    assert read.runs() == study.runs()


#: From the last version that wrote studies as text; its stores must still count as complete.
LAST_HASHES = [
    "3bb67c4a1b9ab92f375b048545c29f80",
    "1552a0d2557b2d6fa57f5bcfe470ad05",
    "e48575a8000a059c5a9af2676d65e231",
    "d0d54ccc016619ef66201b2bd27221e3",
]


def test_runs_have_the_hashes_of_the_last_version(monkeypatch):
    from snowshed import _core

    monkeypatch.setattr(_core, "version", "0.1.0")
    tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    tiny.update({"events": {"count": 1, "max_time": 0.05}})
    study = Study.product(tiny, {"panel.friction": [0.2, 0.3]}, seeds=[1, 2])
    assert [run.hash for run in study.runs()] == LAST_HASHES
