"""Changed files of a run are neither shown nor resumed."""

import json
import re
import shutil
import zlib
from pathlib import Path

import pytest
from conftest import tiny_mps, tiny_scene
from helpers import film_files
from helpers.grain_files import write_labels
from helpers.processes import snowshed_run
from mutations.mutate import mutated

from snowshed import InputError, ResolvedScene, Results, run_events
from snowshed.base.interrupt import Interrupted
from snowshed.base.notes import record_notes
from snowshed.io.film import Film
from snowshed.io.vtk.vtp import read_particles
from snowshed.methods.grains.curve import LoadingCurve
from snowshed.methods.grains.run import GrainsRun
from snowshed.results.film import film_dataset
from snowshed.results.video import write_video
from snowshed.results.view import write_view
from snowshed.running.run import run
from snowshed.scene import example_slide
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.loading import LoadingStage

CHANGES_PER_FILE, CHANGED_CURVES = 33, 25


@pytest.fixture
def folder(finished, tmp_path) -> Path:
    return Path(shutil.copytree(finished, tmp_path / "results"))


@pytest.fixture(scope="module")
def loaded(tmp_path_factory) -> Path:
    """A finished loading test."""
    folder = tmp_path_factory.mktemp("loaded")
    loading = [LoadingStage(kind="compress", speed=0.1, strain=0.002)]
    scene = grains_scene(write_labels(folder), 1e-4, loading).set("numerics.threads", 1)
    run(scene.set("output.energy", True), folder / "out", pictures=False)
    return folder / "out"


READ = {
    "events.csv": lambda folder: Results(folder).events.to_csv(),
    "outline.csv": lambda folder: Results(folder).outline.to_csv(),
    "energy.csv": lambda folder: Results(folder).energy.to_dataframe().to_csv(),
    "energy_history.csv": lambda folder: Results(folder).energy_history.to_csv(),
    "film.bin": lambda folder: [frame.positions.tolist() for frame in Results(folder).film],
    "scene.json": lambda folder: re.sub(r'"threads": \d+', "", Results(folder).scene.json),
    "run.json": lambda folder: Results(folder).run,
    "particles/event_001.vtp": lambda folder: read_particles(
        folder / "particles" / "event_001.vtp"
    )["position"].tolist(),
}


@pytest.mark.parametrize("name", READ)
def test_a_changed_file_is_refused_by_name_or_read_the_same(folder, name):
    expected = READ[name](folder)
    sound = (folder / name).read_bytes()
    refused = 0
    for seed in range(CHANGES_PER_FILE):
        (folder / name).write_bytes(mutated(sound, seed))
        try:
            content = READ[name](folder)
        except InputError as error:
            assert Path(name).name in str(error)
            refused += 1
        else:
            assert content == expected, seed
    assert refused > 0.8 * CHANGES_PER_FILE


@pytest.mark.parametrize("show", [write_view, lambda folder: write_video(folder, folder / "a.gif")])
def test_pages_and_videos_refuse_changed_files(folder, show):
    for name in ("events.csv", "film.bin", "scene.json", "run.json"):
        sound = (folder / name).read_bytes()
        at = sound.index(b"0.", len(sound) // 3) + 2 if name != "film.bin" else len(sound) // 2
        (folder / name).write_bytes(sound[:at] + bytes([sound[at] ^ 1]) + sound[at + 1 :])
        with pytest.raises(InputError, match=rf"{name}.*damaged"):
            show(folder)
        (folder / name).write_bytes(sound)
    assert not (folder / "view.html").exists() and not (folder / "a.gif").exists()


def test_the_film_of_another_run_is_not_shown(folder, tmp_path):
    other_run = tmp_path / "other"
    run_events(tiny_scene(**{"panel.friction": 0.3}), other_run, pictures=False)
    shutil.copy(other_run / "film.bin", folder / "film.bin")
    with pytest.raises(InputError, match="not the film that the run recorded"):
        write_view(folder)


def test_a_truncated_film_of_a_finished_run_is_refused(folder):
    sound = (folder / "film.bin").read_bytes()
    for length in (len(sound) - 40, len(sound) - 45, len(sound) // 2):
        (folder / "film.bin").write_bytes(sound[:length])
        with pytest.raises(InputError, match="damaged"):
            _ = Results(folder).film


def test_a_film_of_version_1_is_checked_by_the_ends_of_events(folder):
    """Its run.json does not record the film, only the ends of events."""
    sound = film_files.as_version_1((folder / "film.bin").read_bytes())
    record = json.loads((folder / "run.json").read_text())
    for key in ("film", "files", "scene_checksum", "checksum"):
        del record[key]
    (folder / "run.json").write_text(json.dumps(record, indent=2))
    (folder / "film.bin").write_bytes(sound)
    film = Results(folder).film
    assert film.version == 1 and "version 1" in film.notes[0]
    with pytest.warns(UserWarning, match="version 1"), record_notes() as notes:
        film_dataset(film)
    assert len(notes) == 1
    write_view(folder)
    assert "of version 1, which does not detect" in (folder / "view.html").read_text()
    ends = [sound.index(b"FRAM", at + 1) for at in (0, len(sound) - 900)]
    for cut in (len(sound) - 1, len(sound) // 2, sound.rindex(b"FRAM"), ends[0]):
        (folder / "film.bin").write_bytes(sound[:cut])
        with pytest.raises(InputError, match="damaged"):
            _ = Results(folder).film


def test_results_of_a_running_run_are_marked_as_unfinished(tmp_path):
    """The film of a running run may be longer than run.json records."""
    observations = []

    def observe(progress):
        if progress.event == 2 and not observations:
            film = Results(tmp_path).film
            observations.append((len(film.frames), film.notes))
            write_view(tmp_path, tmp_path / "page.html")

    run_events(tiny_scene(), tmp_path, progress=observe, pictures=False)
    ((frames, notes),) = observations
    assert frames > 5 and "has not come to its end" in notes[0]
    assert "not finished (running)" in (tmp_path / "page.html").read_text()
    assert Film(tmp_path / "film.bin").notes == []


def test_a_changed_curve_is_neither_read_nor_resumed(loaded, tmp_path):
    folder = Path(shutil.copytree(loaded, tmp_path / "out"))
    curve = folder / "curve.csv"
    sound = curve.read_bytes()
    refused = 0
    for seed in range(CHANGED_CURVES):
        changed = mutated(sound, seed)
        if changed == sound:
            continue
        refused += 1
        curve.write_bytes(changed)
        with pytest.raises(InputError, match=r"curve\.csv: damaged"):
            LoadingCurve.read(curve)
        done = snowshed_run(folder / "scene.json", "-o", folder, "--resume", "-q")
        assert done.returncode == 2 and "curve.csv: damaged" in done.stderr
        assert curve.read_bytes() == changed
    assert refused >= 21
    curve.unlink()
    assert snowshed_run(folder / "scene.json", "-o", folder, "--resume", "-q").returncode == 0


def test_python_rewrites_a_changed_curve(loaded, tmp_path):
    folder = Path(shutil.copytree(loaded, tmp_path / "out"))
    (folder / "curve.csv").write_text("time_s,stage\n1,1\n")
    run(ResolvedScene.load(folder / "scene.json"), folder, resume=True, pictures=False)
    assert (folder / "curve.csv").read_bytes() == (loaded / "curve.csv").read_bytes()
    LoadingCurve.read(folder / "curve.csv")


def test_a_changed_summary_is_refused(loaded, tmp_path):
    folder = Path(shutil.copytree(loaded, tmp_path / "out"))
    assert GrainsRun.rows(folder)
    text = (folder / "grains.json").read_text()
    (folder / "grains.json").write_text(text.replace("0", "1", 1))
    with pytest.raises(InputError, match=r"grains\.json: damaged"):
        GrainsRun.rows(folder)


def test_run_json_contains_its_own_checksum(folder):
    text = (folder / "run.json").read_bytes()
    at = text.rindex(b',\n  "checksum": "')
    assert json.loads(text)["checksum"] == f"{zlib.crc32(text[:at]):08x}"
    (folder / "run.json").write_bytes(text[:at] + b"\n}\n")
    done = snowshed_run(folder / "scene.json", "-o", folder, "--resume", "-q")
    assert done.returncode == 2 and "its checksum is missing" in done.stderr


def interrupted_run(run, scene, folder, monkeypatch) -> None:
    """Run until the first report of progress, and write a checkpoint there."""
    import snowshed.base.interrupt as interrupt

    requests = []

    def progress(_):
        for request in requests:
            request.requested = True

    original = interrupt.InterruptRequest.__init__

    def init(self, *args, **keywords):
        original(self, *args, **keywords)
        requests.append(self)

    monkeypatch.setattr(interrupt.InterruptRequest, "__init__", init)
    with pytest.raises(Interrupted):
        run(scene, folder, progress=progress, pictures=False)
    monkeypatch.undo()


def scenes(folder: Path) -> dict[str, object]:
    loading = [LoadingStage(kind="compress", speed=0.1, strain=0.002)]
    return {
        "mpm": tiny_scene(),
        "mps": tiny_mps(**{"events": {"count": 1, "max_time": 0.1}}),
        "grains": grains_scene(write_labels(folder), 1e-4, loading),
        "slide": example_slide(folder).set("events.max_time", 3.0),
    }


@pytest.mark.parametrize("python", [True, False])
@pytest.mark.parametrize("method", ["mpm", "mps", "grains", "slide"])
def test_a_run_resumes_with_other_threads_to_the_same_bits(method, python, tmp_path, monkeypatch):
    scene = scenes(tmp_path)[method]
    uninterrupted, resumed = tmp_path / "one", tmp_path / "two"
    scene.set("numerics.threads", 1)
    run(scene, uninterrupted, pictures=False)
    interrupted_run(run, scene, resumed, monkeypatch)
    scene.set("numerics.threads", 2).resolve().save(tmp_path / "threads.json")
    if python:
        run(tmp_path / "threads.json", resumed, resume=True, pictures=False)
    else:
        done = snowshed_run(tmp_path / "threads.json", "-o", resumed, "--resume", "-q")
        assert (done.returncode, done.stderr) == (0, "")
    assert json.loads((resumed / "run.json").read_text())["threads"] == 2
    names = [
        "film.bin",
        *(f"particles/{file.name}" for file in (uninterrupted / "particles").iterdir()),
    ]
    for name in names:
        assert (uninterrupted / name).read_bytes() == (resumed / name).read_bytes(), name


def test_the_number_of_threads_may_be_changed_in_the_folder_itself(folder):
    scene = json.loads((folder / "scene.json").read_text())
    scene["numerics"]["threads"] = 2
    (folder / "scene.json").write_text(json.dumps(scene))
    assert Results(folder).scene.data["numerics"]["threads"] == 2
    run_events(folder / "scene.json", folder, resume=True, pictures=False)
    scene["panel"]["tilt"] += 1
    (folder / "scene.json").write_text(json.dumps(scene))
    with pytest.raises(InputError, match="not the scene of the run"):
        _ = Results(folder).scene


def test_a_table_without_rows_is_valid(tmp_path):
    """No snow has slid off yet, so the stack is empty."""
    scene = tiny_scene(**{"events.count": 1, "events.max_time": 0.1})
    run_events(scene, tmp_path, pictures=False)
    assert (tmp_path / "outline.csv").read_text() == "event,x,z\n"
    assert len(Results(tmp_path).outline) == 0
    write_view(tmp_path)
    (tmp_path / "outline.csv").write_text("event,x,y\n")
    with pytest.raises(InputError, match=r"outline\.csv"):
        _ = Results(tmp_path).outline


def test_a_finished_run_of_an_earlier_version_can_be_resumed_and_read(folder):
    """Its table has fewer columns, and its run.json no checksums."""
    record = json.loads((folder / "run.json").read_text())
    for key in ("film", "files", "tables", "scene_checksum", "checksum"):
        del record[key]
    (folder / "run.json").write_text(json.dumps(record, indent=2))
    lines = (folder / "events.csv").read_text().splitlines()
    rows = [line.rsplit(",", 3)[0] for line in lines]
    (folder / "events.csv").write_text("\n".join(rows) + "\n")
    assert "joined" not in Results(folder).events
    table = run_events(folder / "scene.json", folder, resume=True, pictures=False)
    assert "joined" in table and len(Results(folder).events) == 2
