"""Runs in notebooks: the bar, cells that are run again, and interrupted cells."""

import json
import re
import sys
from html.parser import HTMLParser

import pytest

from snowshed import InputError, run
from snowshed.base.progress import Progress
from snowshed.running import ProgressBar

SETUP = """
import os, signal
import snowshed
from snowshed import Scene
from snowshed.running import ProgressBar, sequence
sequence.REPORT_INTERVAL = 0.0
tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02, "numerics.threads": 1})
tiny = tiny.update({"events": {"count": 2, "max_time": 0.3}})
"""
RUN = """
results = snowshed.run(tiny, "out", resume="auto", progress=ProgressBar(), pictures=False)
results
"""
WITH_PICTURES = """
snowshed.run(tiny, "out")
"""
INTERRUPTED = """
bar = ProgressBar()

def interrupt(progress):
    bar(progress)
    if progress.event == 2 and progress.time > 0.05:
        os.kill(os.getpid(), signal.SIGINT)  # as the button of the notebook

snowshed.run(tiny, "interrupted", resume="auto", progress=interrupt, pictures=False)
"""
RESUMED = """
again = snowshed.run(tiny, "interrupted", resume="auto", pictures=False)
same = (again.events.drop(columns="wall_s", errors="ignore")
        .equals(results.events.drop(columns="wall_s", errors="ignore")))
print("same" if same else "different")
"""
SCENE = "tiny"
SHOWN = """
from snowshed.results import InlineView
InlineView(snowshed.Results("out"))
"""


@pytest.fixture(scope="module")
def execute(tmp_path_factory):
    """Return a function that runs cells in one kernel, and returns their outputs."""
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")

    def execute_cells(*sources, fails=()):
        cells = [nbformat.v4.new_code_cell(source) for source in sources]
        for number in fails:
            cells[number].metadata["tags"] = ["raises-exception"]
        notebook = nbformat.v4.new_notebook(cells=cells)
        folder = tmp_path_factory.mktemp("notebook")
        client = nbclient.NotebookClient(
            notebook, timeout=300, resources={"metadata": {"path": str(folder)}},
            kernel_manager_class="jupyter_client.manager.AsyncKernelManager",
        )  # fmt: skip
        client.create_kernel_manager()
        client.km.kernel_spec.argv[0] = sys.executable
        client.execute()
        return [cell.outputs for cell in notebook.cells]

    return execute_cells


def texts(outputs):
    """Return all that a cell has shown, as text."""
    return "\n".join(json.dumps(output) for output in outputs)


def frame_content(html):
    """Return the page within a frame, as a browser reads it."""
    frames = []
    parser = HTMLParser()
    parser.handle_starttag = lambda tag, attributes: frames.append((tag, dict(attributes)))
    parser.feed(html)
    ((tag, attributes),) = frames
    assert tag == "iframe"
    return attributes["srcdoc"]


@pytest.mark.slow
def test_cells_run_twice_and_interrupted_cells_resume(execute):
    _, first, second, stopped, resumed = execute(SETUP, RUN, RUN, INTERRUPTED, RESUMED, fails=[3])
    for outputs in (first, second):
        assert not [output for output in outputs if output["output_type"] == "error"]
        assert "text/html" in outputs[-1]["data"] and "height_m" in texts(outputs)
    assert "application/vnd.jupyter.widget-view+json" in texts(first)  # the bar
    (error,) = [output for output in stopped if output["output_type"] == "error"]
    assert error["ename"] == "Interrupted" and "resume with" in error["evalue"]
    printed = [output["text"] for output in resumed if output.get("name") == "stdout"]
    assert printed == ["same\n"]  # notes on stderr may follow


@pytest.mark.slow
def test_scenes_results_and_the_moving_view_show_themselves(execute):
    _, scene, results, view = execute(SETUP, SCENE, WITH_PICTURES, SHOWN)
    for outputs in (scene, results, view):
        assert (
            outputs[-1]["output_type"] == "execute_result" and "text/plain" in outputs[-1]["data"]
        )
    assert "<svg" in scene[-1]["data"]["text/html"] and "tilt" in texts(scene)
    shown = results[-1]["data"]["text/html"]
    assert "data:image/png;base64" in shown and "height_m" in shown
    page = frame_content(view[-1]["data"]["text/html"])
    assert page.startswith("<!") and "<canvas" in page and "<script" in page
    assert not re.search(r"""(src|href)=["']?(https?:)?//""", page)  # it needs no network


def test_a_run_that_may_resume_begins_resumes_and_returns_what_is_finished(tiny, tmp_path):
    before = run(tiny, tmp_path / "out", resume="auto", pictures=False)
    files = {p: p.stat().st_mtime_ns for p in (tmp_path / "out").glob("particles/*")}
    again = run(tiny, tmp_path / "out", resume="auto", pictures=False)
    assert again.events.equals(before.events) and files
    assert {p: p.stat().st_mtime_ns for p in files} == files
    other = tiny.with_({"panel.tilt": 45})
    with pytest.raises(InputError, match="scene"):
        run(other, tmp_path / "out", resume="auto", pictures=False)


def test_other_words_for_resuming_are_refused(tiny, tmp_path):
    with pytest.raises(InputError, match="resume: 'always'; allowed: True, False, \"auto\""):
        run(tiny, tmp_path / "out", resume="always")
    with pytest.raises(InputError, match="folder: missing"):
        run(tiny, resume="auto")
    assert not (tmp_path / "out").exists()


def test_the_bar_shows_each_run_and_can_be_used_again(capsys):
    pytest.importorskip("tqdm")
    bar = ProgressBar()
    for fraction in (0.5, 1.0, 0.25):
        bar(Progress(fraction, int(fraction), 1, "events", failed=1))
    assert bar.shown
    bar(Progress(0.1, 0, 1, "events"))  # another run
    bar.close()
    assert not bar.shown
    shown = capsys.readouterr().err
    assert "100 %" in shown and "1 failed" in shown and "0/1 events" in shown


def test_a_missing_library_names_the_extra(hide):
    hide("tqdm")
    with pytest.raises(InputError, match=r"snowshed\[notebook\]"):
        ProgressBar()
