"""Arguments of wrong types: every public function refuses them, and names the argument."""

import importlib
import inspect
import json
import pkgutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Optional, Union

import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner

import snowshed
from snowshed import InputError, Scene, Study
from snowshed.analysis.clearance import SnowRanges
from snowshed.base.arguments import check_type, checked
from snowshed.base.paths import PathLike
from snowshed.cli import main
from snowshed.running import Ageing
from snowshed.season import Climate, SeasonSettings, run_season
from snowshed.study import SeasonPart, latin_hypercube

PACKAGES = [m.name for m in pkgutil.walk_packages(snowshed.__path__, "snowshed.") if m.ispkg]
WRONG = {"bool": ("no", 1, 0.0), "int": (True, "3", 2.5), "float": (True, "3", [1.0])}
#: Classes that check their values by themselves, or that only the package makes.
RESULTS = {"Observation", "Progress", "EpsilonSVR"}


def public_functions():
    """Yield a label, a function that users call, and its signature."""
    seen = set()
    for package in ["snowshed", *PACKAGES]:
        module = importlib.import_module(package)
        for name in getattr(module, "__all__", ()):
            thing = getattr(module, name)
            if not getattr(thing, "__module__", "").startswith("snowshed.") or id(thing) in seen:
                continue
            seen.add(id(thing))
            if inspect.isfunction(thing):
                yield name, thing
            elif inspect.isclass(thing) and name not in RESULTS:
                for key, member in vars(thing).items():
                    bound = isinstance(member, (classmethod, staticmethod))
                    if not key.startswith("_") and (bound or inspect.isfunction(member)):
                        yield f"{name}.{key}", getattr(thing, key)


def parameters(kind):
    """Yield the parameters of public functions that are annotated with a type, or None."""
    for label, function in public_functions():
        for name, parameter in inspect.signature(function).parameters.items():
            if parameter.annotation in (kind, f"Optional[{kind}]") and parameter.kind not in (
                parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD,
            ):  # fmt: skip
                yield label, function, name


@pytest.mark.parametrize("kind", WRONG)
def test_no_public_function_takes_a_value_of_another_type(kind):
    cases = list(parameters(kind))
    assert len(cases) > 20
    silent = []
    for label, function, name in cases:
        for value in WRONG[kind]:
            try:
                function(**{name: value})
            except InputError as error:
                assert str(error).startswith(f"{name}: "), label
            except Exception as error:
                silent.append(f"{label}({name}={value!r}): {error!r}")
            else:
                silent.append(f"{label}({name}={value!r})")
    assert silent == []


class Color:
    """A class of the caller."""


@checked
def sample(
    size: float = 1.0,
    *names: str,
    count: Optional[int] = None,
    loud: bool = False,
    file: Optional[PathLike] = None,
    color: Optional[Color] = None,
    either: Union[str, float] = "a",
    values: Sequence[float] = (),
    table: Optional[Mapping[str, float]] = None,
    call: Optional[Callable[[], None]] = None,
    frame: "Optional[pd.DataFrame]" = None,
    unknown: "Nowhere" = None,  # noqa: F821
    **more: int,
) -> dict[str, object]:
    """Return the arguments."""
    return {**locals()}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"size": None}, "size: None; needed: a number"),
        ({"count": 1.0}, "count: 1.0; needed: a whole number or None"),
        ({"loud": "no"}, "loud: 'no'; needed: True or False"),
        ({"file": 3}, "file: 3; needed: a text or a path or None"),
        ({"color": {"red": 1}}, "color: a value of type dict; needed: Color or None"),
        ({"either": True}, "either: True; needed: a text or a number"),
        ({"values": "12"}, "values: '12'; needed: a sequence"),
        ({"values": 12}, "values: 12; needed: a sequence"),
        ({"table": [1]}, "table: [1]; needed: a dict or None"),
        ({"call": 1}, "call: 1; needed: a function or None"),
        ({"values": [1.0, "2"]}, "values[1]: '2'; needed: a number"),
        ({"table": {"a": None}}, "table['a']: None; needed: a number"),
        ({"table": {1: 1.0}}, "a key of table: 1; needed: a text"),
        ({"frame": [1]}, "frame: [1]; needed: DataFrame or None"),
    ],
)
def test_the_message_names_the_argument_the_value_and_what_is_allowed(arguments, message):
    with pytest.raises(InputError) as caught:
        sample(**arguments)
    assert str(caught.value) == message


def test_values_of_the_right_types_pass():
    given = sample(
        np.float32(2), "a", "b", count=np.int64(3), loud=np.bool_(True), color=Color(),
        frame=pd.DataFrame(),
        values=np.ones(2), either=3, table={}, call=print, unknown="x", other=True,
    )  # fmt: skip
    assert given["names"] == ("a", "b")
    assert given["more"] == {"other": True}
    assert sample(np.array(2.0))["size"] == 2.0


def test_settings_as_a_dict_are_refused_with_the_class_that_takes_them():
    with pytest.raises(InputError) as caught:
        snowshed.run_season([], Scene(), "x", settings={"friction": 0.5})
    assert str(caught.value) == (
        "settings: a value of type dict; needed: SeasonSettings or None, such as "
        "SeasonSettings(friction=0.5)"
    )


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Study("scene.json"), "scene: 'scene.json'; needed: Scene"),
        (lambda: Study(Scene(), seeds=3), "seeds: 3; needed: a sequence or None"),
        (lambda: Study(Scene(), seeds=["a"]), "seeds[0]: 'a'; needed: a whole number"),
        (lambda: Study(Scene(), [["panel.tilt"]]), "parts[0][0]: 'panel.tilt'; needed: Factor"),
        (lambda: latin_hypercube({"panel.tilt": (1, 2)}, 5), "spans['panel.tilt']: (1, 2); needed"),
        (lambda: SnowRanges({"friction": 3}), "spans['friction']: 3; needed: a sequence"),
        (lambda: run_season(3, Scene(), "x"), "season: 3; needed: a text or a path"),
        (
            lambda: run_season({"date": [1]}, Scene(), "x"),
            "season: a value of type dict; needed: a text or a path",
        ),
        (lambda: SeasonPart(3), "weather: 3; needed: a text or a path or DataFrame"),
        (lambda: Ageing({2: [3]}), "pauses[2][0]: 3; needed: Interval"),
        (lambda: Climate({1: 3}), "months[1]: 3; needed: MonthClimate"),
        (
            lambda: Study(Scene(), season={"weather": "w"}),
            "season: a value of type dict; needed: SeasonPart",
        ),
        (
            lambda: Study.product(Scene(), {"panel.tilt": 40}),
            "axes['panel.tilt']: 40; needed",
        ),
        (lambda: Study.product(Scene(), ["panel.tilt"]), "axes: ['panel.tilt']; needed: a dict"),
        (lambda: SeasonSettings(rows=2), "rows: 2; needed: PanelRows"),
        (lambda: SeasonSettings(cover=True), "cover: True; needed: a text or a number"),
    ],
)
def test_studies_and_seasons_name_the_argument_of_a_wrong_type(call, message):
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value).startswith(message)


def test_a_tilde_is_the_home_of_the_user(monkeypatch):
    monkeypatch.setenv("HOME", "/home/anna")
    assert sample(file="~/runs")["file"] == "/home/anna/runs"
    assert sample(file=Path("~/runs"))["file"] == Path("/home/anna/runs")
    assert sample(file="runs~")["file"] == "runs~"


def test_a_tilde_in_a_list_of_files_is_the_home_of_the_user(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path))
    with pytest.raises(OSError, match=str(tmp_path / "winter.csv")):
        snowshed.season.read_season("~/winter.csv")
    with pytest.raises(OSError, match=str(tmp_path)):
        snowshed.season.read_season(["~/one.csv", "~/two.csv"])


def test_the_files_that_a_scene_names_may_be_in_the_home_of_the_user(monkeypatch):
    monkeypatch.setenv("HOME", "/home/anna")
    post = snowshed.Obstacle(name="post", shape=snowshed.Shape.mesh("~/post.stl"))
    scene = Scene.preset("lab-50").set("obstacles", [post])
    assert scene.resolve().data["obstacles"][0]["shape"]["file"] == "/home/anna/post.stl"
    text = json.dumps(scene.to_data())
    read = snowshed.ResolvedScene.parse(text)
    assert read.data["obstacles"][0]["shape"]["file"] == "/home/anna/post.stl"


def test_a_scene_file_may_name_files_in_the_home_of_the_user(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path))
    post = snowshed.Obstacle(name="post", shape=snowshed.Shape.mesh("~/post.stl"))
    scene = Scene.preset("lab-50").set("obstacles", [post])
    file = tmp_path / "elsewhere" / "scene.json"
    file.parent.mkdir()
    file.write_text(json.dumps(scene.to_data()))
    read = snowshed.ResolvedScene.load(file)
    assert read.data["obstacles"][0]["shape"]["file"] == str(tmp_path / "post.stl")


def test_the_command_line_finds_the_home_of_the_user(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path))
    Scene.preset("lab-50").resolve().save(tmp_path / "lab.json")
    outcome = CliRunner().invoke(main.cli, ["run", "~/lab.json", "--dry-run"])
    assert outcome.exit_code == 0, outcome.output


def test_a_name_of_a_type_stands_for_the_type():
    """NumPy 2.5 names its types; the stand-in is such a name for older Pythons."""

    class NumberOrNumbers:
        __value__ = Union[float, Sequence[float]]

    check_type("height", 2.0, NumberOrNumbers())
    with pytest.raises(InputError, match="height: 'tall'; needed: a number"):
        check_type("height", "tall", NumberOrNumbers())
