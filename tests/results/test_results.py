import json
import re
import shutil

import pandas as pd
import pytest
from conftest import tiny_scene

from snowshed import InputError, run_events
from snowshed.cli.main import main
from snowshed.io.atomic import replacing, write_text
from snowshed.io.csv_table import Table
from snowshed.io.folders import check_empty
from snowshed.results.folder import EVENT_COLUMNS, read_events


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "a.txt"
    write_text(path, "old")
    with pytest.raises(RuntimeError), replacing(path) as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_the_old_file_remains_until_the_new_one_is_complete(tmp_path):
    path = tmp_path / "a.txt"
    write_text(path, "old")
    with replacing(path) as temporary:
        temporary.write_text("new")
        assert path.read_text() == "old"
        assert temporary.suffix == path.suffix
    assert path.read_text() == "new"


def test_a_table_is_continued_after_its_last_event(tmp_path):
    path = tmp_path / "t.csv"
    Table(path, ("event", "x")).add([{"event": i, "x": i / 3} for i in (1, 2, 3)])
    reopened = Table(path, ("event", "x"))
    reopened.keep_through(2)
    reopened.add([{"event": 3, "x": 1.0}])
    expected = Table(tmp_path / "u.csv", ("event", "x"))
    expected.add([{"event": i, "x": x} for i, x in ((1, 1 / 3), (2, 2 / 3), (3, 1.0))])
    assert path.read_bytes() == expected.path.read_bytes()
    assert reopened.total("x") == pytest.approx(2.0)


def test_nan_is_an_empty_cell(tmp_path):
    table = Table(tmp_path / "t.csv", ("event", "x"))
    table.add([{"event": 1, "x": float("nan")}])
    assert table.path.read_text() == "event,x\n1,\n"


def test_a_results_folder_must_be_empty(tmp_path):
    check_empty(tmp_path)
    check_empty(tmp_path / "new")
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="not empty"):
        check_empty(tmp_path)
    with pytest.raises(InputError, match="not a folder"):
        check_empty(tmp_path / "file")


def resume(scene, folder):
    return run_events(scene, folder, resume=True, pictures=False)


def test_resuming_refuses_another_scene(finished, tmp_path, tiny):
    tiny.set("output.energy", True)
    with pytest.raises(InputError, match="differs in /panel/tilt;"):
        resume(tiny.set("panel.tilt", 55), finished)
    with pytest.raises(InputError, match="nothing to resume"):
        resume(tiny, tmp_path / "new")


def test_the_events_table_has_its_columns(finished):
    table = read_events(finished)
    assert list(table.columns) == list(EVENT_COLUMNS)
    assert list(EVENT_COLUMNS[:16]) == [
        "event",
        "height_m",
        "length_m",
        "head_m",
        "tail_m",
        "width_m",
        "volume_m3",
        "density_kg_m3",
        "on_panel_kg",
        "detached_kg",
        "body_height_m",
        "body_length_m",
        "mass_kg",
        "sim_time_s",
        "steps",
        "wall_s",
    ]


def test_a_folder_of_an_earlier_version_is_resumed(tmp_path):
    scene = tiny_scene(**{"numerics.courant_factor": 0.5, "events.count": 1}).resolve()
    run_events(scene, tmp_path / "out", pictures=False)
    file = tmp_path / "out" / "scene.json"
    file.write_text(file.read_text().replace("courant_factor", "step_factor"))
    assert len(run_events(scene, tmp_path / "out", resume=True, pictures=False)) == 1
    file.write_text(file.read_text().replace('"step_factor": 0.5', '"step_factor": 0.4'))
    with pytest.raises(InputError, match="differs in /numerics/courant_factor"):
        run_events(scene, tmp_path / "out", resume=True)


def test_a_folder_without_results_is_refused(tmp_path):
    with pytest.raises(InputError, match="no results"):
        read_events(tmp_path)


DAMAGED = {
    "empty": b"",
    "no text": b"\xff\xfe\x00\x01",
    "another table": b"hello world\nthis, is not, it\n",
    "no numbers": b"event,height_m\none,high\n",
    "one column": b"12345",
    "endless stack": b"event,height_m\n1,inf\n",
    "too high": b"event,height_m\n1,1e999\n",
    "text for a length": b"event,height_m,length_m\n1,0.1,long\n",
    "cut off": b"event,height_m,length_m\n1,0.1,0.2\n2,0.1",
    "numbers for names": b"1," * 900,
    "a line without end": b"1," * 100_000,
}


@pytest.mark.parametrize("content", DAMAGED.values(), ids=DAMAGED.keys())
def test_a_damaged_table_of_events_is_named(tmp_path, content):
    (tmp_path / "events.csv").write_bytes(content)
    with pytest.raises(InputError, match=r"events\.csv(, line \d+)?: not a table") as caught:
        read_events(tmp_path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"\xff\x00\x01", ", line 1: not a table: not UTF-8 text"),
        (b"\xff\xfe\x00\x01", ": not a table: text in UTF-16; save it in UTF-8"),
        (b"event,mass\n1,2,3\n", ", line 2: not a table: 3 cells in 2 columns"),
        (b"event,mass\n1\n", ", line 2: not a table: 1 cells in 2 columns"),
        (b"mass\n1\n", ": damaged: a row without the number of its event"),
        (b"event,mass\nfirst,1\n", ": damaged: a row without the number of its event"),
        (b"event,load\n1,1\n", ": damaged: its columns are not event, mass"),
        (b"event,mass\n1,heavy\n", ": damaged: no numbers in the column mass"),
        (b"event,mass\n1,nan\n", ": damaged: no numbers in the column mass"),
        (b"event,mass\n1,1e308\n2,1e308\n", ": damaged: no numbers in the column mass"),
    ],
)
def test_a_damaged_table_is_not_continued(tmp_path, content, message):
    (tmp_path / "t.csv").write_bytes(content)
    with pytest.raises(InputError, match=rf"t\.csv{message}"):
        Table(tmp_path / "t.csv", ["event", "mass"]).total("mass")


@pytest.mark.parametrize("name", ["run.json", "scene.json"])
@pytest.mark.parametrize("content", [b"", b"\xff\x00", b"[" * 100_000, b"[]", b'{"wall_s": '])
def test_a_damaged_file_of_a_folder_to_resume_is_named(tmp_path, tiny, name, content):
    tiny.resolve().save(tmp_path / "scene.json")
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=re.escape(name)) as caught:
        resume(tiny, tmp_path)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 500
    assert (tmp_path / name).read_bytes() == content


FACTS = {"event": 1, "sim_time_s": 1.0, "steps": 9, "wall_s": 1.0, "ended": "rest"}


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ({"wall_s": "long"}, '/wall_s: "long" is not a number'),
        ({"wall_s": True}, "/wall_s: true is not a number"),
        ({}, "has no wall_s"),
        ({"wall_s": 1, "finished_events": {}}, "/finished_events: an object is not an array"),
        ({"wall_s": 1, "finished_events": [7]}, "/finished_events/0: 7 is not an object"),
        ({"wall_s": 1, "finished_events": [FACTS]}, "/finished_events/0: has no laid_height_m"),
        ({"wall_s": 1, "finished_events": [{**FACTS, "steps": "many"}]}, '/steps: "many" is not'),
    ],
)
def test_an_unusable_record_is_refused(tmp_path, tiny, content, message):
    tiny.resolve().save(tmp_path / "scene.json")
    (tmp_path / "run.json").write_text(json.dumps(content))
    with pytest.raises(InputError, match=rf"run\.json: .*{re.escape(message)}"):
        resume(tiny, tmp_path)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (
            lambda text: re.sub(r"(?m)^1,[^,]*", "1,inf", text),
            "no finite numbers in a column height_m",
        ),
        (lambda text: text.replace(",rest", ""), "line 2: not a table: 33 cells in 34 columns"),
        (lambda text: re.sub(r"(?m)^1,.*\n", "", text), "its events are not 1, 2"),
    ],
)
def test_a_damaged_table_of_events_is_not_resumed(finished, tmp_path, capsys, damage, message):
    folder = tmp_path / "results"
    shutil.copytree(finished, folder)
    events = folder / "events.csv"
    events.write_text(damage(events.read_text()))
    before = sorted(folder.rglob("*"))
    assert main(["run", str(folder / "scene.json"), "-o", str(folder), "--resume", "-q"]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"error: {events}") and error.count("\n") == 1
    assert re.search(message, error)
    assert sorted(folder.rglob("*")) == before


@pytest.mark.parametrize("row_count", [0, 1])
def test_events_missing_in_the_table_are_measured_from_particles(finished, tmp_path, row_count):
    """Particles are stored in single precision, so only the last digits of measures differ."""
    folder = tmp_path / "results"
    shutil.copytree(finished, folder)
    lines = (folder / "events.csv").read_text().splitlines(keepends=True)
    (folder / "events.csv").write_text("".join(lines[: 1 + row_count]))
    resume(tiny_scene(**{"output.energy": True}), folder)
    for name in ("events.csv", "outline.csv", "energy.csv"):
        expected, resumed = (pd.read_csv(f / name) for f in (finished, folder))
        pd.testing.assert_frame_equal(expected, resumed, rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize("name", ["outline.csv", "energy.csv", "events.csv"])
@pytest.mark.parametrize("damage", ["empty", "header", "row", "digit", "column"])
def test_a_table_with_missing_or_changed_rows_is_not_continued(finished, tmp_path, name, damage):
    folder = tmp_path / "results"
    shutil.copytree(finished, folder)
    lines = (folder / name).read_text().splitlines(keepends=True)
    changed = {
        "empty": "",
        "header": lines[0],
        "row": "".join(lines[:1] + lines[2:]),
        "digit": "".join(lines[:1] + [lines[1].replace(".", ".1", 1)] + lines[2:]),
        "column": "".join([lines[0].replace("event", "evnt", 1)] + lines[1:]),
    }[damage]
    (folder / name).write_text(changed)
    if name == "events.csv" and damage in ("empty", "header"):  # measured again from particles
        resume(tiny_scene(**{"output.energy": True}), folder)
        assert len((folder / name).read_text().splitlines()) == len(lines)
        return
    with pytest.raises(InputError, match=rf"{name}: "):
        resume(tiny_scene(**{"output.energy": True}), folder)
    assert (folder / name).read_text() == changed
