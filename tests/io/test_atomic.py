"""Files appear complete or not at all, and existing files are never destroyed."""

import errno
import os
import signal
import subprocess
import sys

import pytest

from snowshed import InputError
from snowshed.io.atomic import remove_leftovers, replacing, replacing_folder, write_text


def test_pipes_folders_and_devices_are_refused_and_stay(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    for name in ("pipe", "folder"):
        with pytest.raises(InputError, match=f"{name}: not a file"):
            write_text(tmp_path / name, "x")
    assert (tmp_path / "pipe").is_fifo()
    with pytest.raises(InputError, match="/dev/null: not a file"):
        write_text("/dev/null", "x")


def test_a_link_stays_and_its_target_is_replaced(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "a").write_text("older")
    (tmp_path / "link").symlink_to("elsewhere/a")
    write_text(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "elsewhere" / "a").read_text() == "new"


def test_a_failure_keeps_the_older_file_and_names_it(tmp_path):
    file = tmp_path / "a.txt"
    file.write_text("older")
    with pytest.raises(OSError, match=r"a\.txt") as raised, replacing(file) as beside:
        beside.write_text("half")
        raise OSError(errno.ENOSPC, "No space left on device", str(beside))
    assert raised.value.filename == str(file)
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]
    assert file.read_text() == "older"


def test_leftovers_are_removed_in_the_folder_and_below(tmp_path):
    ours, elsewhere = tmp_path / "ours", tmp_path / "elsewhere"
    leftover = ".partial-0123456789abcdef-a"
    for folder in (ours, ours / "below" / "deeper", elsewhere):
        folder.mkdir(parents=True)
        for name in (leftover, ".partial-of-the-user"):
            (folder / name).touch()
    (ours / "link").symlink_to(elsewhere)
    remove_leftovers(ours)
    assert [path.parent.name for path in tmp_path.rglob(leftover)] == ["elsewhere"]
    assert len([*tmp_path.rglob(".partial-of-the-user")]) == 3
    remove_leftovers(tmp_path / "none")


@pytest.mark.parametrize("kind", ["file", "folder"])
def test_leftovers_of_killed_processes_are_removed_but_not_of_living_ones(kind, tmp_path):
    target, user_folder = tmp_path / "new", tmp_path / ".partial-0123456789abcdef-another"
    user_folder.mkdir()
    writing = replacing_folder if kind == "folder" else replacing
    fill = (
        "import os, signal, sys\n"
        f"from snowshed.io.atomic import {writing.__name__}\n"
        f"with {writing.__name__}(sys.argv[1]) as beside:\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    died = subprocess.run([sys.executable, "-c", fill, target], check=False)
    assert died.returncode == -signal.SIGKILL
    [abandoned] = tmp_path.glob(".partial-*-new")
    with writing(target) as beside:
        assert not abandoned.exists()
        with pytest.raises(ZeroDivisionError), writing(target):
            assert beside.exists()
            raise ZeroDivisionError
        result = beside / "a" if kind == "folder" else beside
        result.write_text("complete")
    assert {path.name for path in tmp_path.iterdir()} == {"new", user_folder.name}
    assert (target / "a" if kind == "folder" else target).read_text() == "complete"


def test_links_and_pipes_with_names_of_leftovers_are_harmless(tmp_path):
    victim = tmp_path / "victim"
    victim.write_text("precious")
    link = tmp_path / ".partial-0123456789abcdef-new"
    link.symlink_to(victim)
    os.mkfifo(tmp_path / ".partial-0123456789abcdee-new")
    write_text(tmp_path / "new", "x")
    assert link.is_symlink()
    assert victim.read_text() == "precious"
    assert (tmp_path / "new").read_text() == "x"


def test_a_file_that_is_removed_before_it_is_locked_is_created_again(tmp_path, monkeypatch):
    def remove_once(descriptor, _):
        monkeypatch.undo()
        [new] = tmp_path.iterdir()
        new.unlink()

    monkeypatch.setattr("snowshed.io.atomic.fcntl.flock", remove_once)
    with replacing(tmp_path / "new") as beside:
        assert beside.exists()


def test_many_processes_that_write_the_same_file_do_not_disturb_each_other(tmp_path):
    write = (
        "import sys\n"
        "from snowshed.io.atomic import write_text\n"
        "for _ in range(300):\n"
        "    write_text(sys.argv[1], 'complete')\n"
    )
    words = [sys.executable, "-c", write, tmp_path / "new"]
    writers = [subprocess.Popen(words, stderr=subprocess.PIPE, text=True) for _ in range(3)]
    assert [writer.communicate()[1] for writer in writers] == ["", "", ""]
    assert [path.name for path in tmp_path.iterdir()] == ["new"]
