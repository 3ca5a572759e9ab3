"""An untrusted AvaFrame project: only its own files are read and copied."""

import os

import pytest
from helpers.slide_files import write_polygons, write_project

from snowshed import InputError
from snowshed.base import limits
from snowshed.base.notes import record_notes
from snowshed.scene.builders.avaframe.files import copy_inputs, project_inputs
from snowshed.scene.builders.avaframe.project import avaframe_simulations

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")


@pytest.fixture
def project(tmp_path):
    return write_project(tmp_path / "project")


@pytest.mark.parametrize(
    ("link", "target"),
    [
        ("Inputs/LINES", "/"),
        ("Inputs/LINES", "../secret"),
        ("Inputs/readme.txt", "/dev/zero"),
        ("Inputs/REL/b.geojson", "/etc/passwd"),
        ("Inputs/REL/rel.prj", "../../../secret/file"),
        ("Inputs/nothing.asc", "nowhere"),
        ("Inputs/circle", "circle"),
        ("Inputs/com5SnowSlideCfg.ini", "/dev/zero"),
        ("local_com5SnowSlideCfg.ini", "../secret/file"),
    ],
)
def test_links_out_of_the_project_are_refused_before_the_run(project, link, target):
    secret = project.parent / "secret"
    secret.mkdir()
    (secret / "file").write_text("[GENERAL]\n")
    (project / link).symlink_to(target)
    with pytest.raises(InputError, match=r"a link that leads (out of the project|to no file)"):
        avaframe_simulations(project)


def test_a_project_with_linked_inputs_is_refused(project):
    project.rename(project.with_name("other"))
    project.mkdir()
    (project / "Inputs").symlink_to("../other/Inputs")
    with pytest.raises(InputError, match="a link that leads out of the project"):
        avaframe_simulations(project)


@pytest.mark.parametrize(
    "pipe", ["Inputs/REL/rel.dbf", "Inputs/readme.txt", "a_com5SnowSlideCfg.ini"]
)
def test_pipes_are_refused_at_once(project, pipe):
    os.mkfifo(project / pipe)
    with pytest.raises(InputError, match=r"not a regular file"):
        avaframe_simulations(project)


def test_links_within_the_project_are_followed(project):
    (project / "south.geojson").write_bytes((project / "Inputs/REL/rel.geojson").read_bytes())
    (project / "Inputs/REL/south.geojson").symlink_to("../../south.geojson")
    assert [simulation.release for simulation in avaframe_simulations(project)] == ["rel", "south"]


def test_known_files_are_copied_and_others_noted(project, tmp_path):
    (project / "Inputs/LINES").mkdir()
    write_polygons(project / "Inputs/LINES/path.geojson")
    (project / "Inputs/remeshedRasters").mkdir()
    (project / "Inputs/remeshedRasters/dem.asc").write_text("1")
    (project / "Inputs/photo.bin").write_bytes(bytes(10))
    with record_notes() as notes:
        inputs = project_inputs(project)
    assert notes == [f"{project}/Inputs: not copied to the results: photo.bin"]
    (tmp_path / "out/Inputs").mkdir(parents=True)
    (tmp_path / "out/Inputs/dem.asc").symlink_to(tmp_path / "kept")  # of an earlier run
    (tmp_path / "kept").write_text("kept")
    copy_inputs(inputs, tmp_path / "out")
    copied = {str(file.relative_to(tmp_path / "out/Inputs")): file.read_bytes()
              for file in (tmp_path / "out/Inputs").rglob("*") if file.is_file()}  # fmt: skip
    assert copied.keys() == {"dem.asc", "REL/rel.geojson", "LINES/path.geojson"}
    assert copied["dem.asc"] == (project / "Inputs/dem.asc").read_bytes()
    assert (tmp_path / "kept").read_text() == "kept"
    copy_inputs(inputs, project)  # results in the project itself
    assert (project / "Inputs/dem.asc").read_bytes() == copied["dem.asc"]


@pytest.mark.parametrize(
    ("limit", "value", "message"),
    [
        ("MAX_PROJECT_FILES", 1, "more than 1 files"),
        ("MAX_PROJECT_BYTES", 100, "GB of files; at most"),
        ("MAX_PROJECT_DEPTH", 0, "nested more than 0 deep"),
    ],
)
def test_copies_have_limits(project, monkeypatch, limit, value, message):
    assert getattr(limits, limit) > value
    monkeypatch.setattr(f"snowshed.scene.builders.avaframe.files.{limit}", value)
    with pytest.raises(InputError, match=message):
        project_inputs(project)


@pytest.mark.parametrize(
    "name", ["\x1b[31mred.geojson", "a\n[x]\nk = 3.geojson", "\u202ea.geojson"]
)
def test_names_with_control_characters_are_refused(project, name):
    write_polygons(project / "Inputs/REL" / name, thickness=0.5)
    with pytest.raises(InputError, match="holds control characters") as refused:
        avaframe_simulations(project)
    assert str(refused.value).isprintable()
