"""Studies of laws of one's own, which every worker makes again from their name."""

import sys

import pytest
from conftest import tiny_scene

import snowshed
from snowshed import InputError, Scene, Study
from snowshed.running import LAW_PROTOTYPES, Laws
from snowshed.study import NamedLaws, StudyError, resume
from snowshed.study.named_laws import _digest

MODULE = """
from snowshed.running import LAW_PROTOTYPES, Laws

constant = LAW_PROTOTYPES["friction"](lambda speed, stress: {friction})


def make():
    return Laws("constant", friction={{"panel": constant}})


no_laws = 3
ready = make()
"""


NUMBA = """
import numba
from {values} import FRICTION
from snowshed.running import Laws

@numba.cfunc("float64(float64, float64)")
def constant(speed, stress):
    return FRICTION

def make():
    return Laws("constant", friction={{"panel": constant}})
"""


@pytest.fixture
def module(tmp_path, monkeypatch):
    """A module of laws on Python's path, of a new name in every test."""
    file = tmp_path / f"laws_{tmp_path.name}.py".replace("-", "_")
    file.write_text(MODULE.format(friction=0.3))
    monkeypatch.syspath_prepend(tmp_path)
    yield file
    sys.modules.pop(file.stem, None)


def study(laws=None, friction=0.2) -> Study:
    scene = tiny_scene(**{"events.count": 1, "panel.friction": friction})
    return Study.product(scene, {"panel.tilt": [50, 60]}, laws=laws)


@pytest.mark.parametrize("name", ["make", "ready"])
def test_every_worker_makes_the_laws_from_their_name(module, tmp_path, name):
    laws = NamedLaws(f"{module.stem}:{name}")
    mine = study(laws).run(tmp_path / "mine", jobs=2)
    built_in = study(friction=0.3).run(tmp_path / "built-in", jobs=2)
    other = study(friction=0.2).run(tmp_path / "other", jobs=2)
    assert mine["height_m"].tolist() == built_in["height_m"].tolist()
    assert mine["length_m"].tolist() == built_in["length_m"].tolist()
    assert mine["length_m"].tolist() != other["length_m"].tolist()


def hashes(laws):
    return [run.hash for run in study(laws).runs()]


def test_the_source_belongs_to_the_identity_of_the_runs(module, tmp_path):
    code = tmp_path / "law.c"
    code.write_text("double f(double v, double s) { return 0.3; }")
    name = f"{module.stem}:make"
    plain, with_file = hashes(NamedLaws(name)), hashes(NamedLaws(name, [code]))
    assert len({*hashes(None), *plain, *with_file, *hashes(NamedLaws(f"{module.stem}:ready"))}) == 8
    code.write_text("double f(double v, double s) { return 0.31; }")
    assert not set(hashes(NamedLaws(name, [code]))) & set(with_file)
    module.write_text(MODULE.format(friction=0.35))
    assert not set(hashes(NamedLaws(name))) & set(plain)


def test_code_that_no_source_shows_belongs_to_the_identity(module, tmp_path):
    """A module may take values from another module, which is not listed as a file."""
    pytest.importorskip("numba")
    values = module.with_name(f"values_{module.stem}.py")
    module.write_text(NUMBA.format(values=values.stem))
    identities = []
    for friction in (0.3, 0.4, 0.3):
        values.write_text(f"FRICTION = {friction}  {'#' * len(identities)}")
        for name in (module.stem, values.stem):
            sys.modules.pop(name, None)
        _digest.cache_clear()  # as in another process
        identities.append(hashes(NamedLaws(f"{module.stem}:make")))
    sys.modules.pop(values.stem)
    assert identities[0] == identities[2] and not set(identities[0]) & set(identities[1])


def test_a_folder_elsewhere_does_not_change_the_identity(module, tmp_path, monkeypatch):
    before = hashes(NamedLaws(f"{module.stem}:make"))
    sys.modules.pop(module.stem)
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    module.rename(elsewhere / module.name)
    monkeypatch.syspath_prepend(elsewhere)
    assert hashes(NamedLaws(f"{module.stem}:make")) == before


def test_a_study_resumes_with_its_laws(module, tmp_path):
    named = study(NamedLaws(f"{module.stem}:make"))
    interrupted = []

    def stop(progress):
        interrupted.append(progress)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        named.compute(tmp_path / "store", jobs=1, progress=stop)
    resume(tmp_path / "store", jobs=1)
    table = snowshed.study.read_table(tmp_path / "store")
    assert len(table) == 2 and set(table["ended"]) <= {"rest", "time_limit"}


def test_workers_refuse_a_source_that_has_changed(module, tmp_path):
    named = study(NamedLaws(f"{module.stem}:make"))
    runs = named.runs()
    module.write_text(MODULE.format(friction=0.9))
    with pytest.raises(StudyError, match="a file of its scene has changed"):
        snowshed.study.session.compute_runs(
            tmp_path / "store", named.name, named.axes, runs, jobs=1
        )


def test_workers_refuse_a_module_of_another_source(module, tmp_path, monkeypatch):
    named = study(NamedLaws(f"{module.stem}:make"))
    runs = named.runs()
    other = tmp_path / "other"
    other.mkdir()
    (other / module.name).write_text(MODULE.format(friction=0.9))
    monkeypatch.syspath_prepend(other)
    with pytest.raises(StudyError, match=r"differs from .*, with which the study was made"):
        snowshed.study.session.compute_runs(
            tmp_path / "store", named.name, named.axes, runs, jobs=1
        )


def test_a_study_file_names_laws(module, tmp_path):
    code = tmp_path / "law.c"
    code.write_text("")
    named = study(NamedLaws(f"{module.stem}:make", [code]))
    named.save(tmp_path / "study.toml")
    assert "[laws]" in (tmp_path / "study.toml").read_text()
    again = Study.load(tmp_path / "study.toml")
    assert again.laws == named.laws
    assert [run.hash for run in again.runs()] == [run.hash for run in named.runs()]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("laws", 'not of the form "module:name"'),
        ("../laws:make", 'not of the form "module:name"'),
        ("__main__:make", "a script or a notebook"),
        ("no_such_module_of_laws:make", "no module no_such_module_of_laws on Python's path"),
        ("{module}:nothing", "has no nothing"),
        ("{module}:no_laws", "gives a int; needed: Laws"),
    ],
)
def test_laws_that_workers_could_not_make_are_refused(module, name, message):
    with pytest.raises(InputError, match=message):
        study(NamedLaws(name.format(module=module.stem)))


def test_functions_without_a_name_are_refused():
    laws = Laws("f", friction={"panel": LAW_PROTOTYPES["friction"](lambda v, s: 0.3)})
    with pytest.raises(InputError, match="laws: a value of type Laws; needed: NamedLaws"):
        Study.product(Scene.preset("lab-50"), {}, laws=laws)


@pytest.mark.parametrize("damaged", ['"make"', '"sources"'])
def test_damaged_laws_in_a_store_are_named(module, damaged):
    from snowshed.study.named_laws import laws_of_run

    data = NamedLaws(f"{module.stem}:make").data()
    data.pop(damaged.strip('"'))
    with pytest.raises(InputError, match="laws: damaged"):
        laws_of_run({"laws": data})
