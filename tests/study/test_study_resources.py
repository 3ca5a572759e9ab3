"""Runs at once, by processor cores and graphics cards."""

import pytest
from study_helpers import tiny_scene

from snowshed.study import resources
from snowshed.study.resources import Resources

SCENE = tiny_scene().resolve().json
ON_A_CARD = tiny_scene().set("numerics.device", "auto").resolve().json


@pytest.mark.parametrize(
    ("jobs", "threads", "runs", "cores", "processes", "each"),
    [
        (None, None, 100, 8, 8, 1),
        (None, None, 3, 8, 3, 2),
        (None, None, 1, 8, 1, 8),
        (4, None, 100, 8, 4, 2),
        (1, 1, 100, 8, 1, 1),
        (None, 4, 100, 8, 2, 4),
        (16, None, 100, 8, 16, 1),
    ],
)
def test_processes_and_threads_fill_the_cores(
    monkeypatch, jobs, threads, runs, cores, processes, each
):
    monkeypatch.setattr(resources, "available_cores", lambda: cores)
    workers, at_once = Resources(jobs, threads).workers([SCENE] * runs)
    assert (at_once, workers.capacity, workers.threads(runs)) == (processes, processes, each)


def test_the_last_runs_use_the_free_cores():
    workers, _ = Resources(jobs=4).workers([SCENE] * 100)
    workers._cores = 4
    assert [workers.threads(unfinished) for unfinished in (100, 4, 3, 2, 1)] == [1, 1, 1, 2, 4]


@pytest.mark.parametrize(
    ("scene", "cards", "jobs", "at_once"),
    [
        (ON_A_CARD, 2, None, 2),  # each run has a card
        (ON_A_CARD, 2, 5, 5),  # as asked for
        (ON_A_CARD, 0, None, 8),  # without a card, "auto" computes on the processor
        (SCENE, 2, None, 8),
    ],
)
def test_runs_on_cards_are_as_many_as_there_are_cards(monkeypatch, scene, cards, jobs, at_once):
    monkeypatch.setattr(resources, "available_cores", lambda: 8)
    monkeypatch.setattr(resources, "graphics_cards", lambda: cards)
    workers, runs = Resources(jobs).workers([SCENE, scene] * 20)
    assert runs == workers.capacity == at_once


def test_studies_on_the_processor_look_for_no_card(monkeypatch):
    monkeypatch.setattr(resources, "graphics_cards", lambda: pytest.fail("looked for a card"))
    Resources().workers([SCENE])
