"""The standalone executable, which needs no Python, and its agreement with the package."""

import json
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pandas as pd
import pytest
from conftest import tiny_scene
from helpers.bad_scenes import CLOSED_MESH, bad_scene  # noqa: F401
from helpers.interrupted_runs import interrupt_at
from helpers.processes import EXECUTABLE, snowshed_run

from snowshed import Interrupted, ResolvedScene, ResultNote, _core, run_events
from snowshed.cli.main import main
from snowshed.running import sequence


def assert_refused(done, message):
    assert done.returncode == 2, done
    assert done.stdout == ""
    assert done.stderr.startswith("error: ") and done.stderr.count("\n") == 1, done.stderr
    assert message in done.stderr


@pytest.fixture(scope="module")
def scene(tmp_path_factory) -> Path:
    file = tmp_path_factory.mktemp("scene") / "scene.json"
    tiny_scene(**{"output.snapshot_interval": 0.2}).resolve().save(file)
    return file


@pytest.fixture(scope="module")
def results(scene, tmp_path_factory) -> Path:
    """The folder of an uninterrupted run."""
    folder = tmp_path_factory.mktemp("results") / "new" / "folder"
    done = snowshed_run(scene, "-o", folder, "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    return folder


def test_a_tilde_is_the_home_of_the_user(scene, tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    shutil.copy(scene, tmp_path / "scene.json")
    done = snowshed_run("~/scene.json", "-o", "~/out", "-q")
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "out" / "run.json").is_file()


def test_the_results_folder_is_complete(results, scene):
    names = {path.relative_to(results).as_posix() for path in results.rglob("*")}
    assert names >= {
        "scene.json", "run.json", "checkpoint.bin", "particles.pvd", "particles", "snapshots",
        "particles/event_001.vtp", "particles/event_002.vtp", "snapshots/snapshots.pvd",
    }  # fmt: skip
    assert len(list((results / "snapshots").glob("*.vtp"))) > 3
    assert not [name for name in names if "partial" in name]
    assert json.loads((results / "scene.json").read_text()) == ResolvedScene.load(scene).data
    facts = json.loads((results / "run.json").read_text())
    assert (facts["status"], facts["events"]) == ("finished", 2)
    assert facts["version"] == _core.version
    assert facts["steps"] > 1000 and facts["particles"] > 100 and facts["peak_memory_mb"] > 1


def particle_files(folder):
    return {path.name: path.read_bytes() for path in (folder / "particles").iterdir()}


def test_the_executable_gives_the_same_particles_as_python(results, scene, tmp_path):
    run_events(ResolvedScene.load(scene), tmp_path, pictures=False)
    assert particle_files(tmp_path) == particle_files(results)
    snapshots = sorted(path.name for path in (results / "snapshots").glob("*.vtp"))
    for name in snapshots:
        by_python, by_executable = (folder / "snapshots" / name for folder in (tmp_path, results))
        assert by_python.read_bytes() == by_executable.read_bytes()
    assert [path.name for path in sorted((tmp_path / "snapshots").glob("*.vtp"))] == snapshots


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_change_nothing(results, tmp_path, threads):
    tiny_scene(**{"numerics.threads": threads}).resolve().save(tmp_path / "scene.json")
    done = snowshed_run(tmp_path / "scene.json", "-o", tmp_path / "out", "-q")
    assert done.returncode == 0
    assert particle_files(tmp_path / "out") == particle_files(results)


def interrupt(scene, folder, condition):
    """Start a run and send Ctrl-C as soon as `condition(folder)` is true."""
    run = subprocess.Popen([EXECUTABLE, scene, "-o", folder, "-q"], stderr=subprocess.PIPE)
    while run.poll() is None and not condition(folder):
        time.sleep(0.002)
    run.send_signal(signal.SIGINT)
    _, message = run.communicate(timeout=120)
    return run.returncode, message.decode()


@pytest.fixture(scope="module")
def longer(tmp_path_factory) -> tuple[Path, Path]:
    """A scene that runs for about a second, and its results."""
    folder = tmp_path_factory.mktemp("longer")
    finer = tiny_scene(**{"numerics.dx": 0.008, "output.snapshot_interval": 0.1})
    finer.set("events.max_time", 0.4).resolve().save(folder / "scene.json")
    assert snowshed_run(folder / "scene.json", "-o", folder / "out", "-q").returncode == 0
    return folder / "scene.json", folder / "out"


@pytest.mark.parametrize("file", ["scene.json", "particles/event_001.vtp"])
def test_interrupted_and_resumed_equals_uninterrupted(longer, tmp_path, file):
    scene, results = longer
    out = tmp_path / "out"
    code, message = interrupt(scene, out, lambda folder: (folder / file).exists())
    assert code == 130
    assert message == f"error: interrupted; resume with: snowshed-run {scene} -o {out} --resume\n"
    assert json.loads((out / "run.json").read_text())["status"] == "interrupted"
    assert snowshed_run(scene, "-o", out, "--resume", "-q").returncode == 0
    assert particle_files(out) == particle_files(results)
    for name in ("particles.pvd", "snapshots/snapshots.pvd"):
        assert (out / name).read_bytes() == (results / name).read_bytes()
    assert json.loads((out / "run.json").read_text())["status"] == "finished"


def test_resuming_a_finished_run_changes_nothing(results, scene):
    before = particle_files(results)
    assert snowshed_run(scene, "-o", results, "--resume", "-q").returncode == 0
    assert particle_files(results) == before


def test_the_scene_of_a_results_folder_can_be_run(tmp_path):
    """Paths of meshes are relative to the scene file, also in a results folder."""
    from helpers.bad_scenes import CLOSED_MESH

    (tmp_path / "post.obj").write_text(CLOSED_MESH)
    post = {"shape": {"type": "mesh", "file": "post.obj", "scale": 0.05}}
    short = {"events.count": 1, "events.max_time": 0.1, "events.rest_time": 0.1}
    scene = tiny_scene(**short).append("obstacles", post)
    (tmp_path / "scene.json").write_text(json.dumps(scene.to_data()))
    first, second, third = (tmp_path / name for name in ("first", "second", "third"))
    assert snowshed_run("scene.json", "-o", first, "-q", cwd=tmp_path).returncode == 0
    assert snowshed_run(first / "scene.json", "-o", second, "-q").returncode == 0
    assert main(["run", str(second / "scene.json"), "-o", str(third), "-q"]) == 0
    assert particle_files(first) == particle_files(second) == particle_files(third)


def test_bad_scenes_are_refused(bad_scene, tmp_path):  # noqa: F811
    file, message = bad_scene
    before = sorted(tmp_path.rglob("*"))
    assert_refused(snowshed_run(file, "-o", tmp_path / "out"), message)
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "s.json:1:1: not valid JSON"),
        (b"{", "s.json:1:2: not valid JSON"),
        (b"\xff\xfe\x00{}", "s.json:1:1: not valid JSON"),
        (b"[]", "/: an array is not an object"),
        (b'{"snowshed": 2}', "there is no snow"),
    ],
)
def test_files_without_a_scene_are_refused(tmp_path, capsys, content, message):
    file, out = tmp_path / "s.json", tmp_path / "out"
    file.write_bytes(content)
    assert_refused(snowshed_run(file, "-o", out), message)
    for command in (["run", str(file), "-o", str(out)], ["plan", str(file)]):
        assert main(command) == 2
        output = capsys.readouterr()
        assert message in output.err and output.err.count("\n") == 1 and output.out == ""
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "no scene given"),
        (["scene.json"], "no output folder given (-o DIR)"),
        (["scene.json", "-o"], "-o needs a folder"),
        (["scene.json", "-o", "out", "--fly"], "unknown option --fly"),
        (["scene.json", "other.json", "-o", "out"], "more than one scene: other.json"),
        (["none.json", "-o", "out"], "none.json: no such file"),
        ([".", "-o", "out"], ".: is a folder"),
        (["scene.json", "-o", os.fsdecode(b"bad\xff")], "bad?: this name is not UTF-8"),
    ],
)
def test_bad_arguments_are_refused(tmp_path, arguments, message):
    assert_refused(snowshed_run(*arguments, cwd=tmp_path), message)
    assert list(tmp_path.iterdir()) == []


def test_unsuitable_folders_are_refused(results, scene, tmp_path):
    other_scene = tmp_path / "other.json"
    tiny_scene(**{"panel.tilt": 55}).resolve().save(other_scene)
    before = sorted(path.name for path in results.iterdir())
    assert_refused(snowshed_run(scene, "-o", results), "not empty")
    assert_refused(snowshed_run(scene, "-o", scene), "is not a folder")
    assert_refused(snowshed_run(other_scene, "-o", results, "--resume"), "another scene")
    assert_refused(snowshed_run(scene, "-o", tmp_path / "new", "--resume"), "nothing to resume")
    assert_refused(snowshed_run(scene, "-o", tmp_path, "--resume"), "nothing to resume")
    assert sorted(path.name for path in results.iterdir()) == before
    assert list(tmp_path.iterdir()) == [other_scene]


def test_a_folder_that_cannot_be_made_is_refused(scene, tmp_path):
    (tmp_path / "loop").symlink_to("loop")
    for folder in ("loop/out", "a" * 300):  # impossible even for root
        assert_refused(snowshed_run(scene, "-o", tmp_path / folder), folder)
    assert [path.name for path in tmp_path.iterdir()] == ["loop"]


@pytest.mark.parametrize(
    "damage", [lambda b: b[:-100], lambda b: b[:50], lambda b: b"", bytes.swapcase]
)
def test_a_damaged_checkpoint_is_refused(results, scene, tmp_path, capsys, damage):
    content = damage((results / "checkpoint.bin").read_bytes())
    (tmp_path / "checkpoint.bin").write_bytes(content)
    (tmp_path / "scene.json").write_bytes((results / "scene.json").read_bytes())
    assert_refused(snowshed_run(scene, "-o", tmp_path, "--resume"), "checkpoint.bin")
    assert main(["run", str(scene), "-o", str(tmp_path), "--resume"]) == 2
    errors = [
        line for line in capsys.readouterr().err.splitlines() if not line.startswith("note: ")
    ]
    assert len(errors) == 1 and "checkpoint.bin" in errors[0]
    assert (tmp_path / "checkpoint.bin").read_bytes() == content
    assert len(list(tmp_path.iterdir())) == 2


@pytest.fixture(scope="module")
def measured(longer, tmp_path_factory) -> Path:
    """The folder of the longer scene, run by Python without interruption."""
    folder = tmp_path_factory.mktemp("measured")
    run_events(ResolvedScene.load(longer[0]), folder, pictures=False)
    return folder


def begin_with_executable(scene, out, moment):
    """Stop a run within its first event, or kill it after the checkpoint at the event's end."""
    if moment == "within":
        interrupt(scene, out, lambda folder: (folder / "scene.json").exists())
        return
    run = subprocess.Popen([EXECUTABLE, scene, "-o", out, "-q"])
    while run.poll() is None and not (out / "checkpoint.bin").exists():
        time.sleep(0.002)
    run.kill()
    run.wait()


def begin_with_python(scene, out, moment):
    """Stop a run within its second event, or copy its folder when that event begins."""
    resolved = ResolvedScene.load(scene)
    if moment == "within":
        with pytest.raises(Interrupted):
            run_events(resolved, out, progress=interrupt_at(2, 0.1), pictures=False)
        return

    def copy_folder(progress):
        if progress.event == 2 and not out.exists():
            shutil.copytree(uninterrupted, out)

    uninterrupted = out.with_name("beside")
    run_events(resolved, uninterrupted, progress=copy_folder, pictures=False)


@pytest.mark.parametrize("moment", ["within", "between"])
def test_python_resumes_a_run_of_the_executable(longer, measured, tmp_path, moment):
    scene, _ = longer
    begin_with_executable(scene, tmp_path / "out", moment)
    assert not (tmp_path / "out" / "events.csv").exists()
    run_events(ResolvedScene.load(scene), tmp_path / "out", resume=True, pictures=False)
    assert_same_results(tmp_path / "out", measured)


def test_the_error_of_a_stack_of_the_executable_is_noted_when_it_is_measured(longer, tmp_path):
    scene, results = longer
    shutil.copytree(results, tmp_path / "out")
    with pytest.warns(ResultNote, match="error of the stack in recorded runs"):
        run_events(ResolvedScene.load(scene), tmp_path / "out", resume=True, pictures=False)
    notes = json.loads((tmp_path / "out" / "run.json").read_text())["notes"]
    assert sum(note.startswith("error of the stack") for note in notes) == 1


@pytest.mark.parametrize("moment", ["within", "between"])
def test_the_executable_resumes_a_run_of_python(longer, measured, tmp_path, monkeypatch, moment):
    monkeypatch.setattr(sequence, "REPORT_INTERVAL", 0.0)
    scene, results = longer
    begin_with_python(scene, tmp_path / "out", moment)
    done = snowshed_run(scene, "-o", tmp_path / "out", "--resume")
    assert done.returncode == 0
    assert done.stderr.endswith(
        f"for tables, pictures and all notes: snowshed run {scene} -o {tmp_path / 'out'} --resume\n"
    )
    assert particle_files(tmp_path / "out") == particle_files(results)
    run_events(ResolvedScene.load(scene), tmp_path / "out", resume=True, pictures=False)
    assert_same_results(tmp_path / "out", measured)


def assert_same_results(out, measured):
    """The same bits of particles; tables agree to single precision."""
    assert particle_files(out) == particle_files(measured)
    for name in ("particles.pvd", "snapshots/snapshots.pvd"):
        assert (out / name).read_bytes() == (measured / name).read_bytes()
    for name in ("events.csv", "outline.csv"):
        tables = (pd.read_csv(folder / name) for folder in (out, measured))
        table, expected = (table.drop(columns="wall_s", errors="ignore") for table in tables)
        pd.testing.assert_frame_equal(table, expected, rtol=1e-4, atol=1e-6)
    facts, expected_facts = (json.loads((f / "run.json").read_text()) for f in (out, measured))
    assert facts["status"] == "finished" and facts.keys() == expected_facts.keys()
    assert facts["steps"] == expected_facts["steps"]


def test_the_executable_refuses_stacks_that_age(results, scene, tmp_path):
    shutil.copytree(results, tmp_path / "out")
    (tmp_path / "out" / "ageing.json").write_text("{}")
    assert_refused(snowshed_run(scene, "-o", tmp_path / "out", "--resume"), "ages between events")


def test_help_version_and_schema_are_printed():
    assert snowshed_run("--help").stdout.startswith("usage: snowshed-run")
    assert snowshed_run("--version").stdout == f"{_core.version}\n"
    assert json.loads(snowshed_run("--schema").stdout) == json.loads(_core.scene_schema())


def test_other_kernels_do_not_resume_a_run(tmp_path):
    first, scene = tmp_path / "out", tmp_path / "scene.json"
    tiny_scene(**{"events.max_time": 0.05}).resolve().save(scene)
    for kernels, code in (("junk", 2), ("baseline", 0)):
        done = snowshed_run(scene, "-o", first, env={**os.environ, "SNOWSHED_KERNELS": kernels})
        assert done.returncode == code
    assert "note: this processor has no AVX2: runs take two to five times" in done.stderr
    present = {**os.environ, "SNOWSHED_KERNELS": "avx2"}
    done = snowshed_run(scene, "-o", first, "--resume", env=present)
    if "can run" not in done.stderr:  # a machine with AVX2
        assert done.returncode == 2 and 'made with the kernels "baseline"' in done.stderr


def test_a_run_with_a_changed_mesh_is_not_resumed(tmp_path):
    out, scene, mesh = tmp_path / "out", tmp_path / "scene.json", tmp_path / "a.obj"
    mesh.write_text(CLOSED_MESH)
    shape = {"type": "mesh", "file": "a.obj", "scale": 0.1}
    data = tiny_scene(**{"events.max_time": 0.05}).append("obstacles", {"shape": shape}).to_data()
    scene.write_text(json.dumps(data))
    assert snowshed_run(scene, "-o", out).returncode == 0
    assert snowshed_run(scene, "-o", out, "--resume").returncode == 0
    mesh.write_text(CLOSED_MESH.replace("v 0 0 1", "v 0 0 1.2"))
    done = snowshed_run(scene, "-o", out, "--resume")
    assert done.returncode == 2 and "a.obj: has changed since the checkpoint" in done.stderr
