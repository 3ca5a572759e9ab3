"""Harness of injected faults: its files, its copy of the sources, its verdicts, its tables."""

import signal
import subprocess
import sys
from dataclasses import replace

import pytest
from helpers.paths import ROOT
from tools.mutants import trial
from tools.mutants.__main__ import PAGES
from tools.mutants.faults import Fault, FaultError, check_places, read_faults
from tools.mutants.results import Results, fault_list, summary, with_table
from tools.mutants.sources import SourceCopy, with_faults
from tools.mutants.trial import BuildError, Workshop

SOUND = """
area = "sums"
tests = ["tests/test_sum.py"]

[[fault]]
name = "minus"
file = "sum.py"
old = "a + b"
new = "a - b"
why = "Sums are differences."
"""


def write(tmp_path, text):
    (tmp_path / "sums.toml").write_text(text, encoding="utf-8")
    return tmp_path


def fault(**values):
    sound = {
        "name": "minus",
        "area": "sums",
        "file": "sum.py",
        "old": "a + b",
        "new": "a - b",
        "why": "Sums are differences.",
        "tests": ("tests/test_sum.py",),
    }
    return Fault(**{**sound, **values})


# --- the files -------------------------------------------------------------------------------


def test_a_sound_file_is_read(tmp_path):
    assert read_faults(write(tmp_path, SOUND)) == [fault()]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('area = "sums"', "", "area is None; a text is needed"),
        ('area = "sums"', 'area = "sums', "sums.toml: "),
        ('area = "sums"', 'area = "sums"\nspeed = 3', "unknown key speed"),
        ('name = "minus"', 'name = "Minus"', "fault 1: name 'Minus'"),
        ('why = "Sums are differences."', "", "why is None"),
        ('why = "Sums', 'hwy = "Sums', "unknown key hwy"),
        ('new = "a - b"', 'new = "a + b"', "old and new are the same"),
        ('tests = ["tests/test_sum.py"]', "", "no tests"),
        ('tests = ["tests/test_sum.py"]', 'tests = ["sum"]', "test 'sum'; allowed: cpp:FILTER"),
        ('tests = ["tests/test_sum.py"]', 'tests = "all"', "a list of texts is needed"),
        ('new = "a - b"', 'new = "a - b"\nswitch = true', "only faults in C"),
        ('new = "a - b"', 'new = "a - b"\nswitch = 1', "switch is 1"),
        ('file = "sum.py"\nold = "a + b"', 'file = "a.cpp"\nswitch = true\nold = "? b"', "no expr"),
        ("[[fault]]", "[fault]", r"lists no \[\[fault\]\]"),
    ],
)
def test_errors_name_file_and_key(tmp_path, old, new, message):
    assert old in SOUND
    with pytest.raises(FaultError, match=message):
        read_faults(write(tmp_path, SOUND.replace(old, new)))


def test_names_are_unique(tmp_path):
    twice = SOUND + SOUND[SOUND.index("[[fault]]") :]
    with pytest.raises(FaultError, match="the same name: minus"):
        read_faults(write(tmp_path, twice))


@pytest.mark.parametrize(
    ("text", "message"),
    [("a - b", "no longer there in sum.py"), ("a + b; a + b", "there 2 times in sum.py")],
)
def test_old_text_must_occur_once(tmp_path, text, message):
    (tmp_path / "sum.py").write_text(text, encoding="utf-8")
    with pytest.raises(FaultError, match=message):
        check_places([fault()], tmp_path)


def test_a_switch_is_a_whole_expression(tmp_path):
    (tmp_path / "sum.cpp").write_text("x = sums::add(a);", encoding="utf-8")
    part = replace(fault(), file="sum.cpp", old="add(a)", new="add(b)", switch=True)
    with pytest.raises(FaultError, match="the text before the old text belongs to it"):
        check_places([part], tmp_path)


def test_the_file_must_exist(tmp_path):
    with pytest.raises(FaultError, match=r"there is no file sum\.py"):
        check_places([fault()], tmp_path)


# --- the copy of the sources -----------------------------------------------------------------


@pytest.fixture
def project(tmp_path):
    (tmp_path / "project").mkdir()
    (tmp_path / "project/sum.py").write_text("a + b\n", encoding="utf-8")
    (tmp_path / "project/sum.cpp").write_text("x = a + b;\ny = b;\n", encoding="utf-8")
    return tmp_path / "project"


def copy_of(project, faults):
    copy = SourceCopy(project, project.parent / "copy", faults)
    copy.update(["sum.py", "sum.cpp"])
    return copy


def test_a_fault_is_injected_only_in_the_copy_and_for_its_trial(project):
    copy = copy_of(project, [fault()])
    with copy.inject(fault()):
        assert (copy.folder / "sum.py").read_text() == "a - b\n"
        assert (project / "sum.py").read_text() == "a + b\n"
    assert (copy.folder / "sum.py").read_text() == "a + b\n"


@pytest.mark.parametrize("interruption", [KeyboardInterrupt, BuildError])
def test_an_interrupted_trial_leaves_the_copy_as_it_was(project, interruption):
    copy = copy_of(project, [fault()])
    with pytest.raises(interruption), copy.inject(fault()):
        raise interruption
    assert (copy.folder / "sum.py").read_text() == "a + b\n"


WAITING = """
import signal, sys, time
from pathlib import Path
from tools.mutants.faults import Fault
from tools.mutants.sources import SourceCopy
signal.signal(signal.SIGINT, signal.default_int_handler)  # also where a shell ignores it
fault = Fault("minus", "sums", "sum.py", "a + b", "a - b", "why", ("tests/test_sum.py",))
copy = SourceCopy(Path(sys.argv[1]), Path(sys.argv[2]), [fault])
copy.update(["sum.py", "sum.cpp"])
with copy.inject(fault):
    print("changed", flush=True)
    time.sleep(60)
"""


@pytest.mark.parametrize("sent_signal", [signal.SIGINT, signal.SIGKILL])
def test_sources_are_restored_after_an_interrupt_or_by_the_next_run(project, sent_signal):
    copy = SourceCopy(project, project.parent / "copy", [fault()])
    command = [sys.executable, "-c", WAITING, str(project), str(copy.folder)]
    with subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as process:
        assert process.stdout.readline() == b"changed\n"
        assert (copy.folder / "sum.py").read_text() == "a - b\n"
        process.send_signal(sent_signal)
        process.wait(timeout=30)
    restored = (copy.folder / "sum.py").read_text() == "a + b\n"
    assert restored == (sent_signal == signal.SIGINT)
    copy.update(["sum.py", "sum.cpp"])
    assert (copy.folder / "sum.py").read_text() == "a + b\n"
    assert (project / "sum.py").read_text() == "a + b\n"


def test_unchanged_files_keep_their_times_and_others_are_removed(project):
    copy = copy_of(project, [])
    before = (copy.folder / "sum.py").stat().st_mtime_ns
    (project / "sum.cpp").write_text("x = 1;\n", encoding="utf-8")
    copy.update(["sum.py", "sum.cpp"])
    assert (copy.folder / "sum.py").stat().st_mtime_ns == before
    assert (copy.folder / "sum.cpp").read_text() == "x = 1;\n"
    copy.update(["sum.py"])
    assert not (copy.folder / "sum.cpp").exists()


def in_cpp(**values):
    return fault(file="sum.cpp", switch=True, **values)


def test_faults_with_a_switch_are_compiled_together(project):
    faults = [in_cpp(), in_cpp(name="twice", new="a + b + b")]
    text = (copy_of(project, faults).folder / "sum.cpp").read_text()
    switch = "snowshed_fault == 1 ? (a - b) : snowshed_fault == 2 ? (a + b + b) : (a + b)"
    assert text == f"x = ({switch});\ny = b;\n"


def test_a_fault_without_a_switch_replaces_those_it_overlaps():
    switched = [(1, in_cpp())]
    overlapping = fault(file="sum.cpp", old="x = a + b;", new="")
    assert with_faults("x = a + b;\ny = b;\n", switched, overlapping) == "\ny = b;\n"
    separate = fault(file="sum.cpp", old="y = b", new="y = 0")
    assert with_faults("x = a + b;\ny = b;\n", switched, separate).endswith("(a + b));\ny = 0;\n")


def test_a_comparison_that_goes_on_after_its_switch_is_refused():
    """`(a >= b) - c` is no comparison of a with b - c."""
    cut = fault(old="time >= limit", new="time >= 2 * limit", switch=True)
    with pytest.raises(FaultError, match="a comparison whose right side goes on"):
        with_faults("if (time >= limit - rounding) stop();", [(1, cut)])
    with_faults("if (time >= limit) stop();", [(1, cut)])


def test_switches_that_overlap_are_refused():
    overlapping = [(1, in_cpp()), (2, in_cpp(name="b", old="b;\ny", new="y"))]
    with pytest.raises(FaultError, match="faults overlap"):
        with_faults("x = a + b;\ny = b;\n", overlapping)


# --- verdicts --------------------------------------------------------------------------------


@pytest.fixture
def workshop(tmp_path):
    """A function that writes the test programs of a workshop; they print given texts."""
    workshop = Workshop(tmp_path, tmp_path)

    def write_programs(cpp="", python="", code=0):
        for path, text in (
            (workshop.tree / "snowshed_tests", cpp),
            (workshop.venv / "bin/python", python),
        ):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"#!/bin/sh\ncat <<'END'\n{text}\nEND\n{SLEEP}exit {code}\n")
            path.chmod(0o755)
        return workshop

    return write_programs


SLEEP = '[ "$SNOWSHED_FAULT" = 9 ] && exec sleep 60\n'


def test_the_first_test_that_fails_is_named(workshop):
    cpp = workshop(cpp="[  FAILED  ] Sum.IsRight (3 ms)\n[  FAILED  ] Sum.Other", code=1)
    assert cpp.first_failure(["cpp:Sum*"]) == "cpp:Sum.IsRight"
    python = workshop(python="FAILED tests/test_sum.py::test_it[3] - assert 1 == 2", code=1)
    assert python.first_failure(["tests/test_sum.py"]) == "tests/test_sum.py::test_it[3]"


def test_no_failure_is_reported_if_all_tests_pass(workshop):
    assert workshop().first_failure(["cpp:Sum*", "tests/test_sum.py"]) == ""


def test_a_crash_and_a_hang_are_failures(workshop, monkeypatch):
    crashed = workshop(code=139)
    assert crashed.first_failure(["cpp:Sum*"]) == "cpp:Sum* (exit code 139)"
    monkeypatch.setattr(trial, "TIME_LIMIT", 0.5)
    assert workshop().first_failure(["tests/a.py"], 9) == "tests/a.py (hangs)"


def test_tests_that_do_not_exist_are_an_error(workshop):
    with pytest.raises(BuildError, match="no test matches cpp:Sum"):
        workshop(cpp="[==========] Running 0 tests from 0 test suites.").first_failure(["cpp:Sum*"])
    with pytest.raises(BuildError, match="no test in tests/a"):
        workshop(code=5).first_failure(["tests/a.py"])


# --- results ---------------------------------------------------------------------------------


def test_results_are_stored_for_existing_faults(tmp_path):
    results = Results()
    results.enter("minus", "cpp:Sum.IsRight")
    results.enter("gone", "")
    results.write(tmp_path / "results.json", [fault()])
    read = Results.read(tmp_path / "results.json")
    assert read.caught_by == {"minus": "cpp:Sum.IsRight"}
    assert read.date["minus"] == results.date["minus"]


def test_tables_count_faults_and_explain_survivors():
    faults = [fault(), fault(name="zero", survives="Nobody adds zero.")]
    caught_by = {"minus": "tests/a/test_sum.py::test_it[3]", "zero": ""}
    text = summary(faults, caught_by)
    assert "2 faults were injected, and 1 (50.0%) were caught." in text
    assert "| sums | 2 | 1 |" in text
    text = fault_list(faults, caught_by)
    assert "| sums | Sums are differences. | `test_sum.py::test_it` |" in text
    assert "| survives. Nobody adds zero. |" in text


def test_a_page_without_marks_is_refused():
    page = "a\n<!-- faults: begin -->\nold\n<!-- faults: end -->\nb\n"
    assert "new" in with_table(page, "new") and "old" not in with_table(page, "new")
    with pytest.raises(ValueError, match="lacks the marks"):
        with_table("a", "new")


# --- the project's own faults ----------------------------------------------------------------

AREAS = {
    *("material", "transfer", "contact", "time step", "sleep", "seeding", "events"),
    *("measures", "post-processing", "scheme", "clearance", "plants", "forces"),
    "laws of one's own",
    *("graphics card", "threads"),
}


def test_every_fault_applies_to_the_sources():
    faults = read_faults()
    check_places(faults, ROOT)
    assert len(faults) >= 60
    assert {fault.area for fault in faults} == AREAS
    for name in {fault.file for fault in faults}:
        switched = [(1, fault) for fault in faults if fault.file == name and fault.switch]
        assert with_faults((ROOT / name).read_text(encoding="utf-8"), switched)


def test_every_fault_has_a_result_and_survivors_a_reason():
    faults, caught_by = read_faults(), Results.read().caught_by
    assert {fault.name for fault in faults} == set(caught_by)
    survivors = [fault for fault in faults if not caught_by[fault.name]]
    assert all(fault.survives for fault in survivors)
    assert len(survivors) <= 0.05 * len(faults)


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_the_pages_show_the_results(path):
    page = path.read_text(encoding="utf-8")
    assert with_table(page, PAGES[path](read_faults(), Results.read().caught_by)) == page
