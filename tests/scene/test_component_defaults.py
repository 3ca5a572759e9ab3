"""A field that was not given reads as the core's default, and is not written anywhere."""

import copy
import pickle
from dataclasses import asdict, replace

import pytest
from tools.components import components

from snowshed import Body, Layer, MpmSettings, Obstacle, Panel, Scene, Shape, Slab, Snow
from snowshed.scene.schema import properties, resolve, scene_schema

DEFAULTS = [
    pytest.param(record, record.keys()[key], full["default"], id=f"{record.__name__}.{key}")
    for record, node in components().items()
    if "oneOf" not in node  # a shape: its type decides
    for key, child in properties(scene_schema(), node).items()
    if "default" in (full := resolve(scene_schema(), child))
]


@pytest.mark.parametrize(("record", "field", "value"), DEFAULTS)
def test_a_field_reads_as_the_default_of_the_schema(record, field, value):
    default = getattr(record(), field)
    assert (list(default) if isinstance(default, tuple) else default) == value
    assert field not in record().given()


def test_more_than_a_hundred_fields_have_a_default():
    assert len(DEFAULTS) > 100
    assert (Snow().density, Panel().surface_tilt, Scene().gravity) == (210.0, 40.0, 9.81)


def test_a_field_without_a_default_reads_as_none():
    assert (Panel().height, Scene().panel, Shape().radius) == (None, None, None)


def test_only_given_fields_are_written():
    snow = Snow(cohesion=0.1)
    assert snow.density == 210.0
    assert repr(snow) == "Snow(cohesion=0.1)"
    assert snow.to_data() == snow.given() == {"cohesion": 0.1}
    assert Scene(snow=snow).to_data() == {"snowshed": 2, "snow": {"cohesion": 0.1}}


def test_records_are_equal_if_the_same_fields_were_given():
    assert Snow() == Snow()
    assert Snow() != Snow(density=210.0)
    assert Snow(density=210) == Snow(density=210.0)
    assert Panel() != Obstacle()


def test_setting_none_restores_the_default():
    snow = Snow(density=300)
    snow.density = None
    assert (snow.density, snow.given(), snow) == (210.0, {}, Snow())


@pytest.mark.parametrize(
    "copied",
    [
        copy.copy,
        copy.deepcopy,
        lambda record: pickle.loads(pickle.dumps(record)),
        replace,
        lambda record: type(record)(**asdict(record)),
    ],
    ids=["copy", "deepcopy", "pickle", "replace", "asdict"],
)
def test_copies_have_the_fields_that_were_given(copied):
    panel = Panel(tilt=30)
    assert copied(panel) == panel
    assert copied(panel).given() == {"tilt": 30}


def test_a_replaced_field_has_no_default():
    settings = MpmSettings(damping_rate=50)
    assert settings.flip_ratio is None
    settings.damping_rate = None
    assert settings.flip_ratio == 0.99


def test_settings_that_a_scheme_decides_have_no_default():
    assert MpmSettings().transfer == MpmSettings(scheme="thesis").transfer == "flip"
    settings = replace(MpmSettings(dx=0.02), scheme="objective")
    assert (settings.transfer, settings.basis) == (None, "quadratic")
    assert settings.given() == {"dx": 0.02, "scheme": "objective"}


def test_snow_of_a_body_or_a_layer_has_the_values_of_the_scene():
    wet = Snow(density=400)
    body, layer = Body(snow=wet), Layer(thickness=0.1, snow=wet)
    assert (wet.cohesion, body.snow.cohesion, layer.snow.cohesion) == (0.2, None, None)
    assert copy.deepcopy(Slab(layers=[layer])).layers[0].snow.cohesion is None
    assert Scene(snow=layer.snow).snow.cohesion == 0.2
    assert body.snow == wet
