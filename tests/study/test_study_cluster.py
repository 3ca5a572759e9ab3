"""The same runs on a Dask cluster, whose workers may die."""

import os
import signal
import time

import distributed
import pytest
import study_helpers
from study_helpers import contents, tiny_scene, tiny_study

from snowshed import InputError
from snowshed.study import Study
from snowshed.study.cluster import DaskWorkers
from snowshed.study.outcome import RunTask

computed_folder = study_helpers.computed_folder  # a fixture

FRICTIONS = (0.1, 0.2, 0.3, 0.25)


@pytest.fixture(scope="module")
def cluster():
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster:
        yield cluster


def test_a_cluster_gives_the_same_table(cluster, computed_folder, tmp_path):
    tiny_study().run(tmp_path / "store", scheduler=cluster.scheduler_address)
    assert contents(tmp_path / "store") == contents(computed_folder)


def test_a_killed_worker_only_delays_the_study(cluster, tmp_path):
    study = Study.product(tiny_scene(max_time=1.0), {"panel.friction": FRICTIONS})
    killed = []

    def kill_when_running(progress):
        folders = list((tmp_path / "store" / "running").glob("*/results/scene.json"))
        if folders and not killed:
            with distributed.Client(cluster) as client:
                killed.extend(client.run(os.getpid).values())
            os.kill(killed[0], signal.SIGKILL)

    table = study.run(tmp_path / "store", scheduler=cluster, progress=kill_when_running)
    assert killed
    assert len(table) == 2 * len(FRICTIONS) and (table.error == "").all()
    study.run(tmp_path / "alone", jobs=1, threads=1)
    assert contents(tmp_path / "store") == contents(tmp_path / "alone")


def test_a_run_that_kills_every_worker_fails(cluster, tmp_path, monkeypatch):
    def die(task):
        os._exit(1)

    monkeypatch.setattr("snowshed.study.cluster.compute", die)
    with distributed.Client(cluster) as client:
        client.run_on_scheduler(_allow_no_failure)
        workers = DaskWorkers(client)
        workers.submit(RunTask("deadly", "{}", str(tmp_path / "x"), 1))
        outcomes, end = [], time.monotonic() + 120
        while not outcomes and time.monotonic() < end:
            outcomes = workers.collect(1)
    assert [(outcome.status, outcome.error) for outcome in outcomes] == [
        ("failed", "every worker that computed the run died")
    ]


def _allow_no_failure(dask_scheduler):
    dask_scheduler.allowed_failures = 0


def test_a_missing_scheduler_is_bad_input(monkeypatch):
    monkeypatch.setattr("snowshed.study.cluster.CONNECT_S", 0.5)
    with pytest.raises(InputError, match=r"no Dask scheduler at tcp://127\.0\.0\.1:9"):
        DaskWorkers("tcp://127.0.0.1:9")
    with pytest.raises(InputError, match=r"no Dask scheduler at none\.json"):
        DaskWorkers("none.json")


def test_without_dask_the_error_says_what_to_install(hide):
    hide("distributed")
    with pytest.raises(InputError, match=r'pip install "snowshed\[cluster\]"'):
        DaskWorkers("tcp://127.0.0.1:9")
