"""Hashes of runs: equal for scenes with equal results, otherwise different."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from study_helpers import tiny_scene

from snowshed import InputError, Obstacle, Scene, Shape, _core
from snowshed.scene.schema import scene_parameters
from snowshed.study import RunKey
from snowshed.study.scene_hash import SETTINGS_WITHOUT_EFFECT, content_hash


def run_of(scene: Scene) -> RunKey:
    return RunKey.of(scene.resolve())


def test_settings_without_effect_do_not_change_the_hash():
    same = tiny_scene().update(
        {
            "title": "another",
            "numerics.threads": 2,
            "output": {"energy": True, "snapshot_interval": 0.1, "checkpoint_interval": 7},
        }
    )
    assert run_of(same).hash == run_of(tiny_scene()).hash


def test_explicit_defaults_integers_and_order_do_not_change_the_hash():
    scene = tiny_scene().set("panel.tilt", 50).set("gravity", 9.81)
    assert run_of(scene).hash == run_of(tiny_scene()).hash
    data = json.loads(run_of(scene).scene)
    assert content_hash(dict(reversed(data.items()))) == run_of(scene).hash


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("dimension", 3),
        ("snow.cohesion", 0.2000001),
        ("panel.friction", 0.31),
        ("seeding.seed", 2),
        ("numerics.precision", "double"),
        ("events.count", 3),
        ("events.between", "reseed"),
        ("events.max_time", 0.06),
    ],
)
def test_settings_with_an_effect_change_the_hash(path, value):
    assert run_of(tiny_scene().set(path, value)).hash != run_of(tiny_scene()).hash


def test_every_other_parameter_is_in_the_hash():
    data = json.loads(run_of(tiny_scene()).scene)
    hashes = {content_hash(data)}
    varied = 0
    for parameter in scene_parameters():
        section, _, key = parameter.path.rpartition(".")
        holder = data.get(section, data)
        if section in ("output", "domain") or key in ("title", "obstacles", "bodies"):
            continue
        if key in SETTINGS_WITHOUT_EFFECT:
            continue
        changed = {**holder, key: "something else"}
        hashes.add(content_hash({**data, section: changed} if section else changed))
        varied += 1
    assert varied > 30 and len(hashes) == varied + 1


def test_a_scheme_and_its_settings_have_the_same_hash():
    named = tiny_scene().set("numerics.scheme", "objective")
    settings = json.loads(run_of(named).scene)["numerics"]
    listed = tiny_scene().update({f"numerics.{k}": v for k, v in settings.items() if k != "scheme"})
    assert run_of(named).hash == run_of(listed).hash != run_of(tiny_scene()).hash


def test_former_names_of_settings_give_the_same_hash():
    data = json.loads(run_of(tiny_scene().set("numerics.courant_factor", 0.5)).scene)
    assert "method" not in data
    present = content_hash(data)
    data["numerics"]["step_factor"] = data["numerics"].pop("courant_factor")
    assert content_hash(data) == present


def test_the_hash_is_the_same_in_every_process():
    code = (
        "import json, sys; from snowshed.study.scene_hash import content_hash; "
        "print(content_hash(json.load(sys.stdin)))"
    )
    run = run_of(tiny_scene())
    for seed in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-c", code],
            input=run.scene,
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        )
        assert done.stdout.strip() == run.hash


def test_another_version_has_another_hash(monkeypatch):
    before = run_of(tiny_scene()).hash
    monkeypatch.setattr(_core, "version", "99.0")
    assert run_of(tiny_scene()).hash != before


def test_the_hash_depends_on_the_content_of_files_not_on_their_path(tmp_path):
    def hash_with(file):
        scene = tiny_scene()
        shape = Shape.grid(str(file), origin=(2, 0), spacing=0.1)
        return run_of(scene.append("obstacles", Obstacle(shape=shape))).hash

    original, copy = tmp_path / "one.npy", tmp_path / "copy.npy"
    np.save(original, np.ones((3, 3)))
    copy.write_bytes(original.read_bytes())
    before = hash_with(original)
    assert hash_with(copy) == before
    np.save(original, np.full((3, 3), 2.0))
    assert hash_with(original) != before
    with pytest.raises(InputError, match="/dev/zero: not a regular file"):
        hash_with("/dev/zero")


def test_the_scene_of_a_run_can_be_run():
    run = run_of(tiny_scene())
    assert json.loads(_core.ParsedScene.parse(run.scene).json) == json.loads(run.scene)
